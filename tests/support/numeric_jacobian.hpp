#pragma once

#include <Eigen/Core>

namespace waymark::test {

/// Jacobian of `function` (vector to vector, both fixed or dynamic size) at `x` by central differences, to
/// hold an analytic Jacobian against. Error is O(step^2) of the third derivative plus rounding of about 1e-16
/// / step.
template <typename Function, typename Vector>
auto numeric_jacobian(const Function& function, const Vector& x, double step = 1e-6) {
  const auto value = function(x).eval();
  Eigen::Matrix<double, decltype(value)::RowsAtCompileTime, Vector::RowsAtCompileTime> jacobian(value.size(),
                                                                                                x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    Vector ahead = x;
    Vector behind = x;
    ahead[i] += step;
    behind[i] -= step;
    jacobian.col(i) = (function(ahead) - function(behind)) / (2.0 * step);
  }
  return jacobian;
}

}  // namespace waymark::test
