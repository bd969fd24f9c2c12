#pragma once

#include <Eigen/Core>

#include "waymark/core/observation.hpp"

namespace waymark {

/// Where a filter expects to see something in the image that is about to be looked at.
struct Expectation {
  LandmarkId id;
  bool candidate = false;  ///< its distance is still being found out: S spans the image of its ray
  Eigen::Vector2d predicted_px = Eigen::Vector2d::Zero();
  Eigen::Matrix2d S = Eigen::Matrix2d::Identity();      ///< innovation covariance, px^2
  Eigen::Vector3d p_world_m = Eigen::Vector3d::Zero();  ///< where it is believed to be
  double information_nats = 0.0;  ///< what an observation would tell the state: 1/2 log(|S|/|R|)
};

}  // namespace waymark
