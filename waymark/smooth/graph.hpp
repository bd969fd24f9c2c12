#pragma once

#include <vector>

#include <Eigen/Core>

#include "waymark/core/motion.hpp"
#include "waymark/core/observation.hpp"
#include "waymark/smooth/calibration.hpp"

namespace waymark::smooth {

/// A step of the odometry.
struct OdometryStep {
  Pose2 increment;
  double dt_s = 0.0;
};

/// What leads from one pose to the next: steps of the odometry, and the covariance of their sum.
struct KeyframeInterval {
  std::vector<OdometryStep> steps;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  /// Of its variances in x, y and theta what is errors of the measurement, and not a robot that strays from
  /// what was measured or commanded.
  Eigen::Vector3d measured_part = Eigen::Vector3d::Ones();
};

/// One observation of a landmark; its covariance in the layout of Observation::covariance.
struct ObservationEdge {
  int pose = 0;
  int landmark = 0;
  Measurement value;
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity();
  /// Of the robot, in its frame, by its odometry: x and y in m/s, turning in rad/s. Tells a sensor that is
  /// late.
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
};

/// Poses, landmarks and what the sensors were like.
struct Estimate {
  std::vector<Pose2> poses;
  std::vector<Eigen::Vector2d> landmarks;
  Calibration calibration = Calibration::Zero();
};

/// Everything that one log says: intervals that join poses (one fewer than these), and observations of
/// landmarks.
struct Graph {
  Pose2 T_robot_sensor;
  std::vector<KeyframeInterval> intervals;
  std::vector<ObservationEdge> observations;
  Calibration calibration_mean = Calibration::Zero();    ///< what it is taken to be before the log
  Calibration calibration_sigmas = Calibration::Zero();  ///< how surely; 0: is not estimated
  /// How far, as a standard deviation, landmarks may be from where they start: what few bearings or ranges do
  /// not fix would go far.
  double landmark_sigma_m = 1e3;
};

/// The motion of an interval by a calibration.
[[nodiscard]] CalibratedMotion motion_of(const KeyframeInterval& interval, const Calibration& calibration);

}  // namespace waymark::smooth
