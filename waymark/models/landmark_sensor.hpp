#pragma once

#include <optional>

#include "waymark/core/observation.hpp"
#include "waymark/core/pose2.hpp"
#include "waymark/core/stamp.hpp"

namespace waymark {

/// Systematic errors of a sensor: those that all observations share, and Gauss-Markov biases per
/// landmark.
struct SensorErrors {
  double shared_range_sigma_ratio = 0.0;  ///< of what all ranges of a log have in common, per metre of range
  double shared_range_sigma_m = 0.0;      ///< of an offset of all ranges
  double shared_bearing_sigma_deg = 0.0;
  double bias_range_sigma_ratio = 0.0;  ///< of what successive ranges to one landmark have in common
  double bias_bearing_sigma_deg = 0.0;
  double bias_distance_m = 0.3;  ///< way after which 37 % of that are left

  [[nodiscard]] bool shares_range() const {
    return shared_range_sigma_ratio > 0.0 || shared_range_sigma_m > 0.0;
  }
  [[nodiscard]] bool shares() const {
    return shared_range_sigma_ratio > 0.0 || shared_bearing_sigma_deg > 0.0;
  }
  [[nodiscard]] bool lasts() const { return bias_range_sigma_ratio > 0.0 || bias_bearing_sigma_deg > 0.0; }
};

/// A sensor that observes landmarks: its position on the robot, its field of view and its errors.
struct LandmarkSensor {
  double x_m = 0.0;  ///< ahead of the robot's origin
  double y_m = 0.0;  ///< left of it
  double yaw_deg = 0.0;
  double range_scale = 1.0;     ///< reported range of a landmark at 1 m, less the offset
  double range_offset_m = 0.0;  ///< by how much more than that is reported
  bool range_is_depth = false;  ///< the range is reported along the sensor's axis, as a camera sees sizes
  double range_sigma_m = 0.05;
  double range_sigma_ratio = 0.0;  ///< further range error per metre of range
  double bearing_sigma_deg = 1.0;
  SensorErrors errors;
  double min_range_m = 0.0;
  double max_range_m = 1000.0;
  double field_of_view_deg = 360.0;
  /// That it reports a landmark within these limits; 0: that it reports none says nothing.
  double detection_probability = 0.0;
  double delay_s = 0.0;  ///< how much later than the observation its stamp is

  [[nodiscard]] Pose2 T_robot_sensor() const { return {x_m, y_m, to_radians(yaw_deg)}; }
};

/// What was reported, freed from the sensor's known errors: range = (reported - offset) / scale, and over
/// cos(bearing) where it is a depth. A depth beside no bearing, or 90 degrees and more off the axis, is
/// nothing that can be used (NaN).
[[nodiscard]] Measurement rectify(const LandmarkSensor& sensor, const Measurement& reported);

/// The same sensor for a filter that knows white noise alone: its noise covers its other errors too.
[[nodiscard]] LandmarkSensor with_white_errors(LandmarkSensor sensor);

/// The configured noise for one measurement, in the layout of Observation::covariance (one-dimensional
/// values use (0, 0)); zero for a kind that this sensor does not measure.
[[nodiscard]] Eigen::Matrix2d noise_covariance(const LandmarkSensor& sensor, const Measurement& measurement);

/// Margins inside the limits of a sensor.
struct ViewMargin {
  double range_m = 0.0;
  double bearing_rad = 0.0;
};

/// Whether the limits of range and field of view take in a point (m, sensor frame) and a margin about it.
[[nodiscard]] bool is_in_view(const LandmarkSensor& sensor, const Eigen::Vector2d& p_sensor,
                              const ViewMargin& margin = {});

/// Finite, and a range within the sensor's limits.
[[nodiscard]] bool is_usable(const LandmarkSensor& sensor, const Measurement& measurement);

}  // namespace waymark
