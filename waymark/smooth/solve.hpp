#pragma once

#include <optional>
#include <vector>

#include "waymark/smooth/graph.hpp"

namespace waymark::smooth {

struct SolveOptions {
  double robust_dof = 4.0;           ///< of the Student-t distribution of all errors
  double max_covariance_work = 1e9;  ///< beyond that many multiplications no covariances are computed
};

/// The residual of something measured after the fit, predicted - measured, and how much of its variance the
/// estimate followed: the noise of the measurement is what both make up together.
template <int Size>
struct PostfitResidual {
  using Vector = Eigen::Matrix<double, Size, 1>;
  Vector residual = Vector::Zero();
  Vector followed = Vector::Zero();  ///< diagonal of H P H^T
  Vector stated = Vector::Ones();    ///< variances by which it was weighed
};
using ObservationResidual = PostfitResidual<2>;  ///< range and bearing, or the one number of an observation
using IntervalResidual = PostfitResidual<3>;     ///< x, y and theta

/// The best estimate, how it was found, and how sure it is.
struct Solution {
  Estimate estimate;
  int iterations = 0;
  bool converged = false;
  double cost_before = 0.0;  ///< minus twice the logarithm of the likelihood, but for a constant
  double cost = 0.0;
  /// Of each pose given the first and of each landmark; empty where that would have taken too long.
  std::vector<Eigen::Matrix3d> pose_covariances;
  std::vector<Eigen::Matrix2d> landmark_covariances;
  /// Of each observation, and of each interval in the frame of its first pose; empty with the covariances.
  std::vector<ObservationResidual> observation_residuals;
  std::vector<IntervalResidual> interval_residuals;
  Calibration calibration_sigmas = Calibration::Zero();
  CalibrationCovariance calibration_covariance = CalibrationCovariance::Zero();
};

/// Poses, landmarks and calibration by which all that the log says is likeliest (Dellaert and Kaess
/// 2006): Levenberg's steps by sparse Cholesky factors in an order of least fill (Amestoy, Davis and Duff
/// 1996), with errors of a Student-t distribution by weights (Lange, Little and Taylor 1989). The first
/// pose stays where it is. About O(poses) per iteration.
[[nodiscard]] Solution solve(const Graph& graph, Estimate start, const SolveOptions& options = {});

}  // namespace waymark::smooth
