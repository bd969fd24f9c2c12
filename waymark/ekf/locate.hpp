#pragma once

#include <functional>
#include <optional>
#include <span>

#include <Eigen/Core>

namespace waymark::ekf {

/// Ranges or bearings of one landmark from m places, linearised at a position of it: nu = z - h (m), H =
/// dh/dp (m x 2), S the covariance of nu when the position is given (m x m).
struct LinearizedViews {
  Eigen::VectorXd nu;
  Eigen::Matrix<double, Eigen::Dynamic, 2> H;
  Eigen::MatrixXd S;
};
/// Nothing at a position that cannot be seen from one of the places.
using LinearizeViews = std::function<std::optional<LinearizedViews>(const Eigen::Vector2d& p_world)>;

/// Where a landmark is by what several views of it say together.
struct Located {
  Eigen::Vector2d p_world = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< (H^T S^-1 H)^-1
  double nis = 0.0;                                      ///< nu^T S^-1 nu
  double cost = 0.0;                                     ///< -2 log-likelihood, but for a constant
  int dof = 0;                                           ///< of the NIS: m - 2
};

/// The nearest minimum of the cost by Levenberg and Marquardt's steps from `start`; nothing if the views
/// leave a direction open there.
[[nodiscard]] std::optional<Located> descend(const Eigen::Vector2d& start, const LinearizeViews& views);

/// The likeliest of the minima that are found from the starts, if it alone is likely: ranges from places on
/// one line cannot tell a landmark from its mirror image, and nothing is returned until one of the two is 1e5
/// times likelier (asked again and again, less would be wrong now and then), and as likely as one in a
/// thousand true landmarks. Cost: a handful of
/// linearisations per start.
[[nodiscard]] std::optional<Located> locate(std::span<const Eigen::Vector2d> starts,
                                            const LinearizeViews& views);

}  // namespace waymark::ekf
