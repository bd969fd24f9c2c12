#include "waymark/fastslam/sensor_model.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "waymark/models/observation_models.hpp"

namespace waymark::fastslam {
namespace {

using kernels::LandmarkMeasurement;
using kernels::ObservationKind;

// What a float can tell: a sensor is not believed to be sharper than that, as a part of its range and in rad.
constexpr double kSharpestSigma = 1e-6;

/// The numbers of a measurement, 0 for what was not measured.
RangeBearing numbers_of(const Measurement& value) {
  if (const auto* z = std::get_if<Range>(&value)) return {z->range_m, 0.0};
  if (const auto* z = std::get_if<Bearing>(&value)) return {0.0, z->bearing_rad};
  return std::get<RangeBearing>(value);
}

bool is_positive_definite(const Eigen::Matrix2d& R, ObservationKind kind) {
  if (!R.allFinite() || !(R(0, 0) > 0.0)) return false;
  return dimension(kind) == 1 || R.determinant() > 0.0;
}

kernels::SensorMount mount_of(const LandmarkSensor& sensor) {
  const double yaw_rad = to_radians(sensor.yaw_deg);
  return {static_cast<float>(sensor.x_m),
          static_cast<float>(sensor.y_m),
          static_cast<float>(std::cos(yaw_rad)),
          static_cast<float>(std::sin(yaw_rad)),
          static_cast<float>(0.5 * to_radians(sensor.field_of_view_deg)),
          static_cast<float>(1.0 / std::max(sensor.max_range_m, kMinDistance_m)),
          static_cast<float>(sensor.min_range_m)};
}

}  // namespace

std::optional<ObservationKind> kind_of(const Measurement& value) {
  if (std::holds_alternative<RangeBearing>(value)) return ObservationKind::kRangeBearing;
  if (std::holds_alternative<Range>(value)) return ObservationKind::kRange;
  if (std::holds_alternative<Bearing>(value)) return ObservationKind::kBearing;
  return std::nullopt;
}

int dimension(ObservationKind kind) { return kind == ObservationKind::kRangeBearing ? 2 : 1; }

bool is_usable(const Observation& observation) {
  const auto kind = kind_of(observation.value);
  if (!kind || !observation.covariance) return false;
  const RangeBearing z = numbers_of(observation.value);
  const bool has_range = *kind != ObservationKind::kBearing;
  return std::isfinite(static_cast<float>(z.range_m)) && std::isfinite(z.bearing_rad) &&
         (!has_range || z.range_m > kMinDistance_m) && is_positive_definite(*observation.covariance, *kind);
}

double bias_variance_factor(double travelled_since_m, double bias_distance_m) {
  return 1.0 / std::tanh(std::max(travelled_since_m, kMinTravelled_m) / (2.0 * bias_distance_m));
}

SensorModel::SensorModel(const LandmarkSensor& sensor, double noise_inflation)
    : sensor_(sensor), inflation_(noise_inflation * noise_inflation), mount_(mount_of(sensor)) {}

kernels::SensorView SensorModel::view() const {
  const Eigen::Matrix2d R = noise_covariance(sensor_, RangeBearing{sensor_.max_range_m, 0.0});
  return {mount_, static_cast<float>(sensor_.min_range_m), static_cast<float>(sensor_.max_range_m),
          static_cast<float>(R(0, 0)), static_cast<float>(R(1, 1))};
}

LandmarkMeasurement SensorModel::seen(const Observation& observation, double travelled_since_m,
                                      const kernels::RangeErrors& range_errors) const {
  const ObservationKind kind = *kind_of(observation.value);
  const RangeBearing z = numbers_of(observation.value);
  const SensorErrors& e = sensor_.errors;
  const double repeated = bias_variance_factor(travelled_since_m, e.bias_distance_m);
  const auto variance = [&](int i, double shared, double bias, double sharpest) {
    const double R = inflation_ * (*observation.covariance)(i, i) + shared * shared + repeated * bias * bias;
    return static_cast<float>(std::max(R, sharpest * sharpest));
  };
  const double direction_rad = z.bearing_rad + to_radians(sensor_.yaw_deg);
  LandmarkMeasurement seen{kind, static_cast<float>(z.range_m), static_cast<float>(std::cos(direction_rad)),
                           static_cast<float>(std::sin(direction_rad))};
  if (kind != ObservationKind::kBearing)
    seen.R_rr =
        variance(0, 0.0, e.bias_range_sigma_ratio * z.range_m, kSharpestSigma * std::max(1.0, z.range_m));
  seen.range_errors = range_errors;
  if (kind != ObservationKind::kRange)
    seen.R_bb = variance(kind == ObservationKind::kBearing ? 0 : 1, to_radians(e.shared_bearing_sigma_deg),
                         to_radians(e.bias_bearing_sigma_deg), kSharpestSigma);
  if (kind == ObservationKind::kRangeBearing)
    seen.R_rb = static_cast<float>(inflation_ * (*observation.covariance)(0, 1));
  return seen;
}

kernels::LandmarkObservation SensorModel::landmark_observation(const Observation& observation, int landmark,
                                                               const Belief& belief) const {
  return {seen(observation, belief.landmarks.travelled_since_m(landmark), belief.calibration.columns()),
          mount_, belief.view(landmark)};
}

}  // namespace waymark::fastslam
