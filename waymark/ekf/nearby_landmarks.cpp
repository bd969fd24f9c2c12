#include "waymark/ekf/nearby_landmarks.hpp"

#include <algorithm>

namespace waymark::ekf {
namespace {

// A few landmarks per cell where they are as dense as trunks.
constexpr double kCell_m = 2.0;

bool is_due(const PointMap& map, int landmark, const Eigen::Vector2d& p_world_sensor, double sensor_range_m) {
  constexpr int kTurns = 16;
  constexpr double kMargin_m = 10.0;
  if (map.state().is_active(landmark) || (landmark + map.table().scan()) % kTurns == 0) return true;
  return (map.place(landmark) - p_world_sensor).norm() < sensor_range_m + kMargin_m;
}

}  // namespace

NearbyLandmarks::NearbyLandmarks(double sensor_range_m) : sensor_range_m_(sensor_range_m), grid_(kCell_m) {}

void NearbyLandmarks::refresh(PointMap& map, const Eigen::Vector2d& p_world_sensor) {
  places_.clear();
  sigma_m_ = 0.0;
  for (int k = 0; k < map.table().size(); ++k) {
    if (is_due(map, k, p_world_sensor, sensor_range_m_)) map.refresh_place(k);
    places_.push_back(map.place(k));
    sigma_m_ = std::max(sigma_m_, map.sigma_m(k));
  }
  grid_.build(places_);
}

}  // namespace waymark::ekf
