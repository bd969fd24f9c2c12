// The pipeline as a robot would run it: odometry and observations arrive as they come, observations late, and
// a pose of now is wanted at any time. No log, no other package than the engine.
//
// The robot drives a circle at 0.5 m/s. Its odometry reports 50 times a second and believes that it turns 5 %
// less than it does. A sensor sees four landmarks 5 times a second, and its scans arrive 0.1 s after they
// were taken.

#include <cmath>
#include <cstdio>
#include <optional>

#include <waymark/waymark.hpp>

namespace {

using namespace waymark;

constexpr double kSpeed_mps = 0.5, kTurnRate_radps = 0.25;
const Eigen::Vector2d kLandmarks[] = {{0.0, 4.0}, {2.5, 2.0}, {-2.5, 2.0}, {0.0, -1.0}};

Pose2 truth_at(double t_s) {
  return arc_increment({kSpeed_mps * t_s, kTurnRate_radps * t_s}, ArcModel::kExact);
}

Observations scan_at(double t_s) {
  Observations scan;
  for (int number = 0; number < 4; ++number) {
    const auto z = RangeBearingModel::linearize(truth_at(t_s), {}, kLandmarks[number]).predicted;
    scan.push_back({LandmarkId{LandmarkId::Family::kMarker, number}, RangeBearing{z[0], z[1]}, {}});
  }
  return scan;  // without covariances: the sensor's noise applies
}

}  // namespace

int main() {
  const StreamId odometry{0, 0}, sensor_stream{0, 1};
  OdometryOptions odometry_options;
  odometry_options.noise.turn_var_rad2_per_rad = 0.01;
  const LandmarkSensor sensor{.range_sigma_m = 0.05, .bearing_sigma_deg = 1.0};

  EkfSlam filter({.capacity = 20}, sensor);
  std::optional<Step> last;
  Pipeline pipeline(filter, {}, odometry_options, sensor, Observe::kRangeBearing,
                    [&](const Step& step) { last = step; });
  pipeline.horizon().expect(odometry, Duration{0});
  pipeline.horizon().expect(sensor_stream, Duration{0});

  for (int tick = 1; tick <= 50 * 60; ++tick) {
    const double now_s = 0.02 * tick;
    pipeline.hold({stamp_from_seconds(now_s), odometry, Velocity{kSpeed_mps, 0.95 * kTurnRate_radps}});
    const double seen_s = now_s - 0.1;
    if (tick % 10 == 0 && seen_s > 0.0)
      pipeline.hold({stamp_from_seconds(seen_s), sensor_stream, scan_at(seen_s)});
    if (const auto horizon = pipeline.horizon().stamp()) pipeline.process_until(*horizon);
    if (tick % 500 != 0 || !last) continue;

    // What the horizon has reached is estimated; from there to now the odometry leads on.
    const double since_s = now_s - to_seconds(last->stamp - Stamp{});
    const Pose2 now =
        last->pose.T_world_robot *
        arc_increment({kSpeed_mps * since_s, 0.95 * kTurnRate_radps * since_s}, ArcModel::kExact);
    std::printf("%5.1f s  (%6.2f, %6.2f) m, %.3f m off, estimated up to %.2f s ago\n", now_s, now.x_m,
                now.y_m, (now.position() - truth_at(now_s).position()).norm(), since_s);
  }
  const double error_m =
      (last->pose.T_world_robot.position() - truth_at(to_seconds(last->stamp - Stamp{})).position()).norm();
  const double odometry_error_m =
      (last->dead_reckoning.position() - truth_at(to_seconds(last->stamp - Stamp{})).position()).norm();
  std::printf("%zu landmarks; off by %.3f m, odometry alone by %.2f m\n", filter.snapshot().landmarks.size(),
              error_m, odometry_error_m);
  return error_m < 0.2 * odometry_error_m ? 0 : 1;
}
