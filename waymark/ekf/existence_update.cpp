#include "waymark/ekf/existence_update.hpp"

#include <cmath>

namespace waymark::ekf {
namespace {

bool should_be_seen(const PointMap& map, int landmark, const Eigen::Vector2d& p_sensor,
                    const PointObservation& observation, const LandmarkSensor& sensor) {
  if (!is_in_view(sensor, p_sensor)) return false;
  const RangeBearing expected{p_sensor.norm(), std::atan2(p_sensor.y(), p_sensor.x())};
  const auto linearization = observation.linearize(landmark, map.table()[landmark].id,
                                                   {{}, expected, noise_covariance(sensor, expected)});
  if (!linearization) return false;
  const Eigen::Vector2d sigma = map.state().innovation_covariance(*linearization).diagonal().cwiseSqrt();
  return is_in_view(sensor, p_sensor, {3.0 * sigma[0], 3.0 * sigma[1]});
}

}  // namespace

void update_existence(PointMap& map, const NearbyLandmarks& nearby, const PointObservation& observation,
                      const AssociationModel& model, const LandmarkSensor& sensor) {
  LandmarkTable& table = map.table();
  for (int k = 0; k < table.size(); ++k) {
    if (!table.is_observed(k)) continue;
    table.existence(k).see(model);
    map.note_sigma(k);
  }
  const Pose2 T_world_sensor = observation.T_world_sensor();
  const Pose2 T_sensor_world = T_world_sensor.inverse();
  const Eigen::Matrix2d R = T_sensor_world.rotation();
  nearby.visit(T_world_sensor.position(), sensor.max_range_m, [&](int k) {
    if (!table[k].existence.is_certain() && !table.is_observed(k) &&
        should_be_seen(map, k, R * nearby.place(k) + T_sensor_world.position(), observation, sensor))
      table.existence(k).miss(model);
  });
}

void remove_false_tracks(PointMap& map) {
  const LandmarkTable& table = map.table();
  for (int k = table.size() - 1; k >= 0; --k)
    if (table[k].existence.is_false_track() || table.is_stale(k)) map.remove(k);
}

}  // namespace waymark::ekf
