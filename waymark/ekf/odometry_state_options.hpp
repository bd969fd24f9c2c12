#pragma once

#include "waymark/models/odometry_errors.hpp"

namespace waymark {

/// Calibration of the odometry that is estimated together with path and map.
struct OdometryStateOptions {
  bool estimate = false;
  double speed_scale_sigma = 0.05;
  double turn_scale_sigma = 0.05;
  double turn_bias_sigma_degps = 0.1;

  [[nodiscard]] OdometryErrors sigmas() const;
};

}  // namespace waymark
