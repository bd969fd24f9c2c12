#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "waymark/core/motion.hpp"
#include "waymark/core/observation.hpp"
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

/// What a filter believes at one moment, each landmark with its marginal covariance.
struct Snapshot {
  Stamp stamp;
  PoseEstimate pose;
  std::vector<LandmarkEstimate> landmarks;
};

/// The whole belief with its correlations, as it is saved: mean and covariance of (pose, landmark 1, landmark
/// 2, ...).
struct MapState {
  std::string made_by;         ///< program, version and input
  int landmark_dimension = 2;  ///< 2: (x, y); 3: (x, y, z)
  Stamp stamp;
  Pose2 T_world_robot;
  std::vector<LandmarkId> ids;
  std::vector<int> observations;  ///< sightings per landmark
  Eigen::VectorXd landmarks;      ///< stacked positions, m
  Eigen::MatrixXd covariance;     ///< symmetric, 3 + dimension * landmarks
};

}  // namespace waymark
