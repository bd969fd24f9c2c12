#include "waymark/models/landmark_sensor.hpp"

#include <cmath>
#include <limits>

namespace waymark {
namespace {

std::optional<double> range_of(const Measurement& measurement) {
  if (const auto* z = std::get_if<RangeBearing>(&measurement)) return z->range_m;
  if (const auto* z = std::get_if<Range>(&measurement)) return z->range_m;
  return std::nullopt;
}

std::optional<double> bearing_of(const Measurement& measurement) {
  if (const auto* z = std::get_if<RangeBearing>(&measurement)) return z->bearing_rad;
  if (const auto* z = std::get_if<Bearing>(&measurement)) return z->bearing_rad;
  return std::nullopt;
}

}  // namespace

Measurement rectify(const LandmarkSensor& sensor, const Measurement& reported) {
  const auto range = range_of(reported);
  if (!range) return reported;
  double range_m = (*range - sensor.range_offset_m) / sensor.range_scale;
  if (sensor.range_is_depth) {
    const double cosine = std::cos(bearing_of(reported).value_or(kPi));
    range_m = cosine > 0.0 ? range_m / cosine : std::numeric_limits<double>::quiet_NaN();
  }
  if (const auto bearing = bearing_of(reported)) return RangeBearing{range_m, *bearing};
  return Range{range_m};
}

LandmarkSensor with_white_errors(LandmarkSensor sensor) {
  const SensorErrors& e = sensor.errors;
  sensor.range_sigma_ratio =
      std::hypot(sensor.range_sigma_ratio, e.shared_range_sigma_ratio, e.bias_range_sigma_ratio);
  sensor.bearing_sigma_deg =
      std::hypot(sensor.bearing_sigma_deg, e.shared_bearing_sigma_deg, e.bias_bearing_sigma_deg);
  sensor.errors = {};
  return sensor;
}

Eigen::Matrix2d noise_covariance(const LandmarkSensor& sensor, const Measurement& measurement) {
  const auto range = range_of(measurement);
  const double range_sigma_m = sensor.range_sigma_m + sensor.range_sigma_ratio * range.value_or(0.0);
  const double bearing_sigma_rad = to_radians(sensor.bearing_sigma_deg);
  Eigen::Vector2d variances = Eigen::Vector2d::Zero();
  if (range) variances[0] = range_sigma_m * range_sigma_m;
  if (bearing_of(measurement)) variances[range ? 1 : 0] = bearing_sigma_rad * bearing_sigma_rad;
  return variances.asDiagonal();
}

bool is_in_view(const LandmarkSensor& sensor, const Eigen::Vector2d& p_sensor, const ViewMargin& margin) {
  const double range_m = p_sensor.norm();
  const double half_view_rad = 0.5 * to_radians(sensor.field_of_view_deg);
  const double bearing_rad = std::abs(std::atan2(p_sensor.y(), p_sensor.x()));
  return range_m >= sensor.min_range_m + margin.range_m && range_m <= sensor.max_range_m - margin.range_m &&
         (half_view_rad >= kPi || bearing_rad <= half_view_rad - margin.bearing_rad);
}

bool is_usable(const LandmarkSensor& sensor, const Measurement& measurement) {
  const auto range = range_of(measurement);
  const auto bearing = bearing_of(measurement);
  const bool range_ok =
      !range || (*range > 0.0 && *range >= sensor.min_range_m && *range <= sensor.max_range_m);
  const bool bearing_ok = !bearing || std::isfinite(*bearing);
  return (range || bearing) && range_ok && bearing_ok;
}

}  // namespace waymark
