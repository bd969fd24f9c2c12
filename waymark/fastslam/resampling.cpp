#include "waymark/fastslam/resampling.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

namespace waymark::fastslam {
namespace {

// offspring_i = O_i - O_(i-1) with O_i = floor(N C_i + u), C_i the prefix sum divided by the whole sum. Both
// are added up in the same order, so C reaches exactly 1 at the last particle of positive weight: O_N is N,
// and no particle without weight is revived by rounding.
void count_offspring(std::span<const double> weights, double u, std::span<std::int32_t> offspring) {
  const auto count = static_cast<double>(weights.size());
  const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
  double prefix = 0.0;
  double taken = 0.0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    prefix += weights[i];
    const double next = std::min(std::floor(count * (prefix / total) + u), count);
    offspring[i] = static_cast<std::int32_t>(next - taken);
    taken = next;
  }
}

// Settled places hold their ancestor as a negative number until all are settled.
constexpr std::int32_t settled(std::size_t ancestor) { return -1 - static_cast<std::int32_t>(ancestor); }

}  // namespace

double effective_particles(std::span<const double> weights) {
  return 1.0 / std::transform_reduce(weights.begin(), weights.end(), 0.0, std::plus<>(),
                                     [](double w) { return w * w; });
}

void choose_ancestors(std::span<const double> weights, double u, std::span<std::int32_t> ancestors) {
  count_offspring(weights, u, ancestors);
  std::size_t vacant = 0;
  for (std::size_t i = 0; i < ancestors.size(); ++i) {
    for (std::int32_t further = ancestors[i] - 1; further > 0; --further) {
      while (ancestors[vacant] != 0) ++vacant;
      ancestors[vacant] = settled(i);
    }
    if (ancestors[i] > 0) ancestors[i] = settled(i);
  }
  for (auto& ancestor : ancestors) ancestor = -1 - ancestor;
}

}  // namespace waymark::fastslam
