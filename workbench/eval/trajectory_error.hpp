#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "workbench/eval/associate.hpp"

namespace waymark::eval {

/// The error at one moment, estimate minus truth, in the frame of the truth.
struct ErrorSample {
  Stamp stamp;
  Eigen::Vector2d position_m = Eigen::Vector2d::Zero();  ///< x, y
  std::optional<double> heading_rad;
  std::optional<Eigen::Vector3d> sigma;  ///< what the estimate claims of x (m), y (m) and heading (rad)
  std::optional<double> nees;            ///< of the pose (x, y, heading), 3 degrees of freedom; see nees.hpp
};

/// The error of every pair after `T_truth_estimate`, which turns the covariances with it. O(n).
[[nodiscard]] std::vector<ErrorSample> errors(std::span<const PosePair> pairs, const Pose2& T_truth_estimate);

/// Root mean square of the distance to the truth (absolute trajectory error); nothing for no samples.
[[nodiscard]] std::optional<double> position_rmse_m(std::span<const ErrorSample> samples);

/// The same under another motion, without the rest of the series.
[[nodiscard]] std::optional<double> position_rmse_m(std::span<const PosePair> pairs,
                                                    const Pose2& T_truth_estimate);

/// Over the samples that have a heading; nothing when none has.
[[nodiscard]] std::optional<double> heading_rmse_rad(std::span<const ErrorSample> samples);

/// The pose NEES of a run.
struct NeesSummary {
  std::optional<double> mean;       ///< ideal 3
  std::optional<double> median;     ///< ideal 2.37
  std::optional<double> inside_95;  ///< fraction of samples below the 95 % quantile of chi-square; ideal 0.95
  std::size_t scored = 0;
  std::size_t skipped =
      0;  ///< with covariance and true heading, but a covariance that is not positive definite
};

[[nodiscard]] NeesSummary summarise_nees(std::span<const ErrorSample> samples);

/// How far the truth has travelled up to each pair, m. Steps below 2 cm are gathered first: the jitter of a
/// motion capture that sees a standing robot a hundred times a second is not a path. O(n).
[[nodiscard]] std::vector<double> travelled_m(std::span<const PosePair> pairs);

/// Relative pose error over sub-paths of one length (Zhang & Scaramuzza 2018): drift, whatever the alignment.
struct RelativeError {
  double distance_m = 0.0;
  std::size_t count = 0;  ///< sub-paths
  std::optional<double> position_rmse_m;
  std::optional<double> heading_rmse_rad;
};

/// Every pair with a true heading starts a sub-path, which ends at the first pair `distance_m` further along
/// the truth; it counts if that pair has a heading too and lies at most a fifth of the distance too far.
/// O(n).
[[nodiscard]] RelativeError relative_error(std::span<const PosePair> pairs,
                                           std::span<const double> travelled_m, double distance_m);

}  // namespace waymark::eval
