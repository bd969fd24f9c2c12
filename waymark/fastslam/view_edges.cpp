#include "waymark/fastslam/view_edges.hpp"

#include <cmath>

namespace waymark::fastslam {
namespace {

// A landmark that leaves the view does so by an edge, not by the limits of range, if it is so many standard
// deviations off those; and it must not cross a wide angle between two scans.
constexpr double kLimitMargin = 3.0;
constexpr double kMaxEdgeTurn_rad = 0.2;
constexpr double kMissedByChance = 1e-3;
constexpr double kMaxMissed = 0.25;

/// In so many scans a landmark in view is seen at least once, but for one time in a thousand; 0 where that
/// would take too many, or there are no edges.
std::size_t scans_to_detect_an_edge(const LandmarkSensor& sensor) {
  const double missed = 1.0 - sensor.detection_probability;
  if (missed > kMaxMissed || sensor.field_of_view_deg >= 360.0) return 0;
  return static_cast<std::size_t>(std::ceil(std::log(kMissedByChance) / std::log(missed)));
}

/// Where the sensor was, as if it sat there on the robot of today.
kernels::SensorMount placed(kernels::SensorMount mount, const Pose2& T_now_sensor) {
  mount.x = static_cast<float>(T_now_sensor.x_m);
  mount.y = static_cast<float>(T_now_sensor.y_m);
  mount.cos_yaw = static_cast<float>(std::cos(T_now_sensor.theta_rad));
  mount.sin_yaw = static_cast<float>(std::sin(T_now_sensor.theta_rad));
  return mount;
}

}  // namespace

ViewEdges::ViewEdges(const SensorModel& model)
    : model_(model), scans_to_tell_(scans_to_detect_an_edge(model.sensor())) {}

std::span<const ViewEdge> ViewEdges::find(const Scan& scan, const ViewHistory& history,
                                          const Belief& belief) {
  edges_.clear();
  if (scans_to_tell_ == 0 || history.earlier() <= scans_to_tell_) return {};
  const std::int64_t now = belief.landmarks.scan();
  const auto patience = static_cast<std::int64_t>(scans_to_tell_);
  for (int k = 0; k < belief.landmarks.size(); ++k) {
    const double range_m = belief.records[as_index(k)].range_alone_m;
    if (range_m > 0.0 && now - belief.landmarks[k].claimed_at_scan == patience)
      add(k, range_m, scans_to_tell_, history);
  }
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const auto* z = std::get_if<Range>(&scan.observations[i].value);
    if (scan.is(i, Outcome::kMatched) && z != nullptr && now - scan.last_claims[i] > patience)
      add(scan.landmarks[i], z->range_m, 1, history);
  }
  return edges_;
}

/// It crossed the edge between the scans `age` and `age` - 1 scans ago.
void ViewEdges::add(int landmark, double range_m, std::size_t age, const ViewHistory& history) {
  const LandmarkSensor& sensor = model_.sensor();
  const Pose2 T_now_before = history.T_now_at(age);
  const Pose2 change = T_now_before.inverse() * history.T_now_at(age - 1);
  const double margin_m = kLimitMargin * sensor.range_sigma_m + change.position().norm();
  if (range_m < sensor.min_range_m + margin_m || range_m > sensor.max_range_m - margin_m) return;
  const double turned_rad = std::abs(change.theta_rad) + change.position().norm() / range_m;
  if (turned_rad > kMaxEdgeTurn_rad) return;
  const Pose2 half{0.5 * change.x_m, 0.5 * change.y_m, 0.5 * change.theta_rad};
  const double sigma_rad = std::hypot(to_radians(sensor.bearing_sigma_deg), turned_rad / std::sqrt(12.0));
  ViewEdge edge{landmark, {}};
  edge.observation.seen.kind = kernels::ObservationKind::kViewEdge;
  edge.observation.seen.R_bb = static_cast<float>(sigma_rad * sigma_rad);
  edge.observation.mount = placed(model_.mount(), T_now_before * half * sensor.T_robot_sensor());
  edges_.push_back(edge);
}

}  // namespace waymark::fastslam
