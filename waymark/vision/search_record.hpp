#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "waymark/core/observation.hpp"

namespace waymark::vision {

/// What became of one expectation or corner in the last image, for those who want to draw it.
struct SearchRecord {
  enum class Result : std::uint8_t {
    kNotTried,  ///< no time, no image of it, or no place for it in this image
    kFound,
    kMissed,
    kNew
  };
  LandmarkId id;
  bool candidate = false;
  Result result = Result::kNotTried;
  Eigen::Vector2d predicted_px = Eigen::Vector2d::Zero();
  Eigen::Matrix2d S = Eigen::Matrix2d::Zero();
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  ///< where it was found, or the best place
};

}  // namespace waymark::vision
