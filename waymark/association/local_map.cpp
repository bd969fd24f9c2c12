#include "waymark/association/local_map.hpp"

#include <algorithm>
#include <cmath>

#include "waymark/core/gaussian.hpp"
#include "waymark/models/observation_models.hpp"

namespace waymark {
namespace {

bool can_be_placed(const Observation& observation) {
  const auto* z = std::get_if<RangeBearing>(&observation.value);
  return z != nullptr && observation.covariance && observation.covariance->allFinite() &&
         std::isfinite(z->range_m) && std::isfinite(z->bearing_rad) && z->range_m > kMinDistance_m;
}

/// Of the errors that outlive an observation: two that are weeks apart have none in common.
Eigen::Matrix2d bias_covariance(const SensorErrors& errors, double range_m) {
  const double range_ratio = std::hypot(errors.shared_range_sigma_ratio, errors.bias_range_sigma_ratio);
  const double bearing_deg = std::hypot(errors.shared_bearing_sigma_deg, errors.bias_bearing_sigma_deg);
  const Eigen::Vector2d sigma(range_ratio * range_m, to_radians(bearing_deg));
  return sigma.cwiseAbs2().asDiagonal();
}

/// To the robot's frame after a motion, to first order.
void move(ObservedLandmark& seen, const Motion& motion) {
  const Eigen::Matrix2d R = motion.increment.rotation().transpose();
  Eigen::Matrix<double, 2, 3> J = Eigen::Matrix<double, 2, 3>::Zero();
  seen.p_robot = motion.increment.inverse() * seen.p_robot;
  J.leftCols<2>() = -R;
  J.col(2) = -perpendicular(seen.p_robot);
  seen.covariance = (R * seen.covariance * R.transpose() + J * motion.covariance * J.transpose()).eval();
}

}  // namespace

LocalMap::LocalMap(const LandmarkSensor& sensor)
    : T_robot_sensor_(sensor.T_robot_sensor()), errors_(sensor.errors) {
  landmarks_.reserve(kCapacity);
}

void LocalMap::predict(const Motion& motion) {
  for (ObservedLandmark& seen : landmarks_) move(seen, motion);
}

std::optional<ObservedLandmark> LocalMap::locate(const Observation& observation) const {
  if (!can_be_placed(observation)) return std::nullopt;
  const auto& z = std::get<RangeBearing>(observation.value);
  const auto place = RangeBearingModel::locate({}, T_robot_sensor_, z);
  const Eigen::Matrix2d R = *observation.covariance + bias_covariance(errors_, z.range_m);
  return ObservedLandmark{observation.id, place.p_world,
                          place.G_measurement * R * place.G_measurement.transpose()};
}

const ObservedLandmark* LocalMap::observe(const ObservedLandmark& seen) {
  const auto at = same_as(seen);
  if (at != landmarks_.end()) {
    const int times = at->times + 1;
    *at = seen;
    at->times = times;
    return &*at;
  }
  return landmarks_.size() < kCapacity ? &landmarks_.emplace_back(seen) : nullptr;
}

const ObservedLandmark* LocalMap::find(LandmarkId id) const {
  const auto at = std::ranges::find(landmarks_, std::optional(id), &ObservedLandmark::id);
  return at != landmarks_.end() ? &*at : nullptr;
}

bool LocalMap::agree(const ObservedLandmark& first, const ObservedLandmark& second) {
  const auto d2 =
      mahalanobis_squared<2>(second.p_robot - first.p_robot, second.covariance + first.covariance);
  return d2 && *d2 < kPlaceGate;
}

void LocalMap::erase(LandmarkId id) {
  std::erase_if(landmarks_, [id](const ObservedLandmark& each) { return each.id == id; });
}

std::vector<ObservedLandmark>::iterator LocalMap::same_as(const ObservedLandmark& seen) {
  return std::ranges::find_if(landmarks_, [&](const ObservedLandmark& before) {
    return seen.id || before.id ? seen.id == before.id : agree(before, seen);
  });
}

}  // namespace waymark
