#pragma once

namespace waymark {

/// P(X <= x) for a chi-square variable with `dof` >= 1 degrees of freedom.
[[nodiscard]] double chi2_cdf(double x, double dof);

/// The x below which a chi-square variable falls with `probability` in [0, 1): chi2_quantile(0.99, 2) = 9.21.
/// Accurate to 1e-10 relative up to 1 - 1e-6; several microseconds, so compute gates once.
[[nodiscard]] double chi2_quantile(double probability, double dof);

}  // namespace waymark
