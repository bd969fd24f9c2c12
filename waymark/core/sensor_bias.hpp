#pragma once

#include <Eigen/Core>

namespace waymark {

/// What may always be wrong with the sensors of a robot, each as a deviation from what the config says.
enum CalibrationIndex : Eigen::Index {
  kSpeedScale,     ///< true distance = (1 + c) measured
  kTurnScale,      ///< true turn = (1 + c) measured + bias dt
  kTurnBias,       ///< rad/s while the robot moves
  kRangeScale,     ///< range = (1 + c) distance + offset
  kRangeOffset,    ///< m
  kBearingOffset,  ///< rad
  kTurnPerMetre,   ///< rad/m that the odometry turns too little: one wheel is larger than the other
  kMountX,         ///< m that the landmark sensor sits further ahead
  kMountY,         ///< m that it sits further left
  kDelay,          ///< s by which its stamps are later; the last
  kCalibrationSize
};

using Calibration = Eigen::Matrix<double, kCalibrationSize, 1>;
using CalibrationCovariance = Eigen::Matrix<double, kCalibrationSize, kCalibrationSize>;

/// What is not known better than by this part of the standard deviation that was assumed rests on that
/// assumption more than on what was measured: the square root of a half.
inline constexpr double kObservableRatio = 0.7071;

/// What was learnt of them.
struct CalibrationEstimate {
  Calibration mean = Calibration::Zero();
  Calibration sigmas = Calibration::Zero();        ///< 0: was not estimated
  Calibration prior_sigmas = Calibration::Zero();  ///< before anything was learnt

  [[nodiscard]] bool is_estimated(CalibrationIndex index) const { return sigmas[index] > 0.0; }
  /// Estimated, but what was measured depends on it so little that it is what it was assumed to be.
  [[nodiscard]] bool is_unobservable(CalibrationIndex index) const {
    return is_estimated(index) && sigmas[index] > kObservableRatio * prior_sigmas[index];
  }
};

}  // namespace waymark
