#include "waymark/core/chi2.hpp"

#include <cmath>
#include <limits>

#include <math.h>  // NOLINT(modernize-deprecated-headers): lgamma_r is not in <cmath>

namespace waymark {
namespace {

/// std::lgamma writes the sign to a variable that all threads share.
double log_gamma(double a) {
  int sign = 0;
  return ::lgamma_r(a, &sign);
}

/// Lower regularised incomplete gamma P(a, x) by its power series; converges quickly for x < a + 1.
double gamma_p_series(double a, double x) {
  double term = 1.0 / a;
  double sum = term;
  for (double n = a + 1.0; std::abs(term) > 1e-17 * std::abs(sum); n += 1.0) {
    term *= x / n;
    sum += term;
  }
  return sum * std::exp(-x + a * std::log(x) - log_gamma(a));
}

/// Upper regularised incomplete gamma Q(a, x) by Lentz's continued fraction; for x >= a + 1.
double gamma_q_fraction(double a, double x) {
  constexpr double kTiny = 1e-300;
  double b = x + 1.0 - a;
  double c = 1.0 / kTiny;
  double d = 1.0 / b;
  double h = d;
  for (int i = 1; i < 10000; ++i) {
    const double an = -i * (i - a);
    b += 2.0;
    d = 1.0 / (std::abs(an * d + b) < kTiny ? kTiny : an * d + b);
    c = std::abs(b + an / c) < kTiny ? kTiny : b + an / c;
    h *= d * c;
    if (std::abs(d * c - 1.0) < 1e-16) break;
  }
  return h * std::exp(-x + a * std::log(x) - log_gamma(a));
}

}  // namespace

double chi2_cdf(double x, double dof) {
  if (!(x > 0.0)) return 0.0;
  const double a = 0.5 * dof;
  const double y = 0.5 * x;
  return y < a + 1.0 ? gamma_p_series(a, y) : 1.0 - gamma_q_fraction(a, y);
}

double chi2_quantile(double probability, double dof) {
  if (!(probability > 0.0)) return 0.0;
  if (probability >= 1.0) return std::numeric_limits<double>::infinity();
  double low = 0.0;
  double high = dof + 10.0;
  while (chi2_cdf(high, dof) < probability && high < 1e12) high *= 2.0;
  for (int i = 0; i < 200 && high - low > 1e-12 * high; ++i) {
    const double middle = 0.5 * (low + high);
    (chi2_cdf(middle, dof) < probability ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace waymark
