#include "workbench/eval/associate.hpp"

namespace waymark::eval {
namespace {

/// The estimate at `stamp`, given its last entry not after `stamp`.
std::optional<TrajectoryPoint> estimate_at(const Trajectory& estimate, std::size_t before, Stamp stamp,
                                           Duration max_gap) {
  const TrajectoryPoint& a = estimate[before];
  if (a.stamp == stamp) return a;
  if (before + 1 == estimate.size()) return std::nullopt;
  const TrajectoryPoint& b = estimate[before + 1];
  if (b.stamp - a.stamp > max_gap) return std::nullopt;
  const double fraction = to_seconds(stamp - a.stamp) / to_seconds(b.stamp - a.stamp);
  return TrajectoryPoint{stamp, interpolate(a.pose, b.pose, fraction), a.covariance};
}

PosePair pair_at_sensor(const TrajectoryPoint& point, const Pose2& T_robot_sensor, const Truth& truth) {
  PosePair pair{point.stamp, point.pose, point.covariance, truth};
  if (T_robot_sensor == Pose2{}) return pair;
  pair.estimate = point.pose * T_robot_sensor;
  if (pair.covariance) {
    const Eigen::Matrix3d F = compose_jacobian_left(point.pose, T_robot_sensor);
    pair.covariance = F * *point.covariance * F.transpose();
  }
  return pair;
}

}  // namespace

std::vector<PosePair> associate(const Trajectory& estimate, const TruthTrack& truth,
                                const AssociateOptions& options) {
  const Pose2 T_robot_sensor{options.truth_sensor_m.x(), options.truth_sensor_m.y(), 0.0};
  std::vector<PosePair> pairs;
  pairs.reserve(truth.samples().size());
  std::size_t next = 0;  // the first estimate after the truth sample
  for (const TruthSample& sample : truth.samples()) {
    while (next < estimate.size() && estimate[next].stamp <= sample.stamp) ++next;
    if (next == 0) continue;
    const auto point = estimate_at(estimate, next - 1, sample.stamp, options.max_gap);
    if (point) pairs.push_back(pair_at_sensor(*point, T_robot_sensor, sample.truth));
  }
  return pairs;
}

}  // namespace waymark::eval
