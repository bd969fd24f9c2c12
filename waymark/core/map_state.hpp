#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "waymark/core/motion.hpp"
#include "waymark/core/observation.hpp"
#include "waymark/core/result.hpp"
#include "waymark/core/stamp.hpp"

namespace waymark {

/// A landmark of the map with its own covariance, world frame; two-dimensional landmarks have z = 0.
struct LandmarkEstimate {
  LandmarkId id;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  int observations = 0;
  /// Of a particle filter: the mean of what the particles claim each for itself, without the spread between
  /// them.
  std::optional<Eigen::Matrix3d> within;
};

/// Estimate of a filter at one moment; each landmark has its marginal covariance.
struct Snapshot {
  Stamp stamp;
  PoseEstimate pose;
  std::vector<LandmarkEstimate> landmarks;
};

/// Image patch of a landmark.
struct LandmarkPatch {
  LandmarkId id;
  Pose2 T_world_robot;               ///< where the robot was believed to be when the patch was cut
  std::vector<std::uint8_t> pixels;  ///< grey, a square with the landmark in its middle, row by row
};

/// The whole estimate with its correlations, as it is saved: mean and covariance of (pose, landmark 1,
/// landmark 2, ...).
struct MapState {
  std::string made_by;         ///< program, version and input
  int landmark_dimension = 2;  ///< 2: (x, y); 3: (x, y, z)
  Stamp stamp;
  Pose2 T_world_robot;
  std::vector<LandmarkId> ids;
  std::vector<int> observations;       ///< observations per landmark
  Eigen::VectorXd landmarks;           ///< stacked positions, m
  Eigen::MatrixXd covariance;          ///< symmetric, 3 + dimension * landmarks
  std::vector<LandmarkPatch> patches;  ///< of landmarks that a camera looks for
};

/// Whether a filter over landmarks of this dimension, with room for so many, can start from the map; else why
/// not: another dimension, too many landmarks, or parts that do not fit each other.
[[nodiscard]] Result<void> check_fits(const MapState& map, int landmark_dimension, int capacity);

/// (x, y, theta, landmark 1, landmark 2, ...), in the order of the covariance.
inline Eigen::VectorXd mean_of(const MapState& map) {
  Eigen::VectorXd mean(3 + map.landmarks.size());
  mean << map.T_world_robot.x_m, map.T_world_robot.y_m, map.T_world_robot.theta_rad, map.landmarks;
  return mean;
}

}  // namespace waymark
