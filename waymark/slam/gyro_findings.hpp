#pragma once

#include <cstdint>
#include <optional>

#include "waymark/slam/odometry_jumps.hpp"

namespace waymark {

/// What a gyro is like, by the odometry beside it.
struct GyroFindings {
  std::int64_t readings = 0;
  bool is_constant = true;  ///< all readings are equal
  bool is_believed = false;
  bool odometry_turns = true;  ///< false: it is believed because the odometry tells no turns at all
  /// Its turn per turn of the odometry, as told; empty: they never turned far enough to tell.
  std::optional<double> ratio;
  double factor =
      1.0;  ///< makes readings rad/s, counter-clockwise: below 0 z points down, pi / 180 of degrees
  bool has_stood = false;
  double bias_radps = 0.0;
  double bias_sigma_radps = 0.0;
  Occurrences slips;  ///< the odometry turned otherwise: its wheels slip, the gyro is believed
  Occurrences stuck;  ///< one reading again and again while the odometry turned: that is believed
};

}  // namespace waymark
