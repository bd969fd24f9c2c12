#include "workbench/sim/simulation.hpp"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "waymark/core/gaussian.hpp"
#include "waymark/models/landmark_sensor.hpp"
#include "waymark/models/odometry.hpp"

#include "workbench/config/robot_keys.hpp"
#include "workbench/sim/landmark_sensor.hpp"

namespace waymark::sim {
namespace {

struct Log {
  LogInfo info;
  std::vector<Event> events;

  /// The events of one kind, in order.
  template <class Content>
  [[nodiscard]] std::vector<std::pair<Stamp, Content>> all() const {
    std::vector<std::pair<Stamp, Content>> found;
    for (const Event& event : events) {
      if (const auto* content = std::get_if<Content>(&event.content))
        found.emplace_back(event.stamp, *content);
    }
    return found;
  }
};

Log simulate(const SimOptions& options, std::uint64_t seed = 1) {
  auto simulation = Simulation::make("test", options, seed);
  EXPECT_TRUE(simulation.ok());
  Log log{(*simulation)->info(), {}};
  while (auto event = (*simulation)->next()) {
    if (!event->has_value()) break;
    log.events.push_back(**event);
  }
  EXPECT_EQ((*simulation)->progress(), 1.0);
  return log;
}

/// Wheels and sensor without any error.
SimOptions ideal(Shape shape = Shape::kSquare) {
  SimOptions options;
  options.path.shape = shape;
  options.wheels.var_m2_per_m = 0.0;
  options.wheels.slip_forward_var_m2_per_m = options.wheels.slip_lateral_var_m2_per_m = 0.0;
  options.wheels.slip_turn_var_rad2_per_rad = options.wheels.slip_turn_var_rad2_per_m = 0.0;
  options.sensor.range_sigma_m = options.sensor.bearing_sigma_deg = 0.0;
  return options;
}

Pose2 pose_of(const Truth& truth) { return {truth.x_m, truth.y_m, truth.theta_rad.value()}; }

/// What a filter would be configured with.
template <class Options>
Options configured(const Log& log) {
  Options options;
  Schema schema;
  describe(schema, options);
  for (const auto& [key, value] : log.info.settings) {
    if (schema.has(key)) {
      EXPECT_TRUE(schema.set(key, value, "log").ok()) << key;
    }
  }
  return options;
}

WheelAngles increment(const WheelAngles& before, const WheelAngles& after) {
  return {after.left_rad - before.left_rad, after.right_rad - before.right_rad};
}

/// Dead reckoning from encoders, one motion per reading.
std::vector<Motion> motions(const Log& log) {
  const auto options = configured<OdometryOptions>(log);
  const auto wheels = log.all<WheelAngles>();
  std::vector<Motion> all;
  for (std::size_t i = 1; i < wheels.size(); ++i) {
    all.push_back(wheel_motion(increment(wheels[i - 1].second, wheels[i].second), options));
  }
  return all;
}

bool same(const WheelAngles& a, const WheelAngles& b) {
  return a.left_rad == b.left_rad && a.right_rad == b.right_rad;
}

bool same(const Truth& a, const Truth& b) {
  return a.x_m == b.x_m && a.y_m == b.y_m && a.theta_rad == b.theta_rad;
}

bool same(const Observations& a, const Observations& b) {
  return std::ranges::equal(a, b, [](const Observation& p, const Observation& q) {
    const auto& z = std::get<RangeBearing>(p.value);
    const auto& w = std::get<RangeBearing>(q.value);
    return p.id == q.id && z.range_m == w.range_m && z.bearing_rad == w.bearing_rad;
  });
}

bool same(const Event& a, const Event& b) {
  if (a.stamp != b.stamp || a.content.index() != b.content.index()) return false;
  if (const auto* angles = std::get_if<WheelAngles>(&a.content))
    return same(*angles, std::get<WheelAngles>(b.content));
  if (const auto* truth = std::get_if<Truth>(&a.content)) return same(*truth, std::get<Truth>(b.content));
  return same(std::get<Observations>(a.content), std::get<Observations>(b.content));
}

TEST(Simulation, IsInOrderAndBeginsAtRest) {
  const Log log = simulate(*scenario("study"));
  EXPECT_TRUE(std::ranges::is_sorted(log.events, {}, &Event::stamp));
  const auto [stamp, angles] = log.all<WheelAngles>().front();
  EXPECT_EQ(stamp, Stamp{});
  EXPECT_EQ(angles.left_rad, 0.0);
  EXPECT_EQ(angles.right_rad, 0.0);
  EXPECT_EQ(log.all<Truth>().front().first, Stamp{});
}

TEST(Simulation, RatesAreThoseOfTheOptions) {
  const Log log = simulate(ideal());
  EXPECT_EQ(log.all<WheelAngles>().size(), 88u * 50u + 1u);
  EXPECT_EQ(log.all<Truth>().size(), 88u * 10u + 1u);
  for (const auto& [stamp, seen] : log.all<Observations>()) {
    const double scan = to_seconds(stamp) * 15.0 - 0.5;
    EXPECT_NEAR(scan, std::round(scan), 1e-6);
  }
}

TEST(Simulation, SaysWhatItKnowsInTheKeysOfTheModels) {
  SimOptions options;
  options.wheels.track_m = 0.4321;
  options.sensor.x_m = 0.12;
  options.sensor.range_sigma_m = 0.07;
  const Log log = simulate(options);
  EXPECT_EQ(log.info.name, "test");
  EXPECT_EQ(log.info.format, "simulation");
  EXPECT_EQ(log.info.landmarks.size(), 24u);
  const auto odometry = configured<OdometryOptions>(log);
  EXPECT_EQ(odometry.wheels.track_m, 0.4321);
  EXPECT_EQ(odometry.noise.wheel_var_m2_per_m, options.wheels.var_m2_per_m);
  const auto sensor = configured<LandmarkSensor>(log);
  EXPECT_EQ(sensor.x_m, 0.12);
  EXPECT_EQ(sensor.range_sigma_m, 0.07);
  EXPECT_EQ(sensor.field_of_view_deg, 49.56);
}

TEST(Simulation, EverySettingIsAKeyOfAModel) {
  OdometryOptions odometry;
  LandmarkSensor sensor;
  Schema schema;
  describe(schema, odometry);
  describe(schema, sensor);
  for (const auto& [key, value] : simulate(ideal()).info.settings) {
    EXPECT_TRUE(schema.set(key, value, "log").ok()) << key << "=" << value;
  }
}

TEST(Simulation, IdealWheelsReproduceTheTruth) {
  for (const Shape shape : {Shape::kSquare, Shape::kLShape, Shape::kFigureEight, Shape::kRandom}) {
    SimOptions options = ideal(shape);
    options.truth.rate_hz = options.wheels.rate_hz;
    const Log log = simulate(options);
    const auto truth = log.all<Truth>();
    const auto steps = motions(log);
    ASSERT_EQ(truth.size(), steps.size() + 1);
    Pose2 T_world_robot = pose_of(truth.front().second);
    for (std::size_t i = 0; i < steps.size(); ++i) {
      T_world_robot = T_world_robot * steps[i].increment;
      ASSERT_LT(difference(T_world_robot, pose_of(truth[i + 1].second)).cwiseAbs().maxCoeff(), 1e-9);
    }
  }
}

TEST(Simulation, IdealVelocitiesReproduceTheTruth) {
  SimOptions options = ideal(Shape::kFigureEight);
  options.wheels.odometry = SimulatedOdometry::kVelocity;
  options.wheels.rate_hz = 30.0;
  const Log log = simulate(options);
  const auto velocities = log.all<Velocity>();
  Pose2 T_world_robot = pose_of(log.all<Truth>().front().second);
  for (std::size_t i = 1; i < velocities.size(); ++i) {
    const double dt_s = to_seconds(velocities[i].first - velocities[i - 1].first);
    T_world_robot = T_world_robot * velocity_motion(velocities[i - 1].second, dt_s, {}).increment;
  }
  EXPECT_LT(difference(T_world_robot, pose_of(log.all<Truth>().back().second)).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_EQ(velocities.back().second.v_mps, 0.0);
}

TEST(Simulation, IdealOdometryPosesReproduceTheTruthFromAFrameOfTheirOwn) {
  SimOptions options = ideal(Shape::kLShape);
  options.wheels.odometry = SimulatedOdometry::kPose;
  options.truth.rate_hz = options.wheels.rate_hz;
  const Log log = simulate(options);
  const auto poses = log.all<OdometryPose>();
  const auto truth = log.all<Truth>();
  ASSERT_EQ(poses.size(), truth.size());
  EXPECT_EQ(poses.front().second.T_odom_robot, Pose2{});
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Pose2 expected = pose_of(truth.front().second) * poses[i].second.T_odom_robot;
    ASSERT_LT(difference(expected, pose_of(truth[i].second)).cwiseAbs().maxCoeff(), 1e-9);
  }
}

// Ideal wheels tell the pose at every reading; cut at the stamp of a scan they tell where the robot saw from.
TEST(Simulation, IdealObservationsEqualTheGeometryAtTheirStamp) {
  SimOptions options = ideal(Shape::kFigureEight);
  options.sensor.x_m = 0.2;
  options.sensor.yaw_deg = 10.0;
  options.sensor.range_max_m = 3.0;
  const Log log = simulate(options);
  const auto sensor = configured<LandmarkSensor>(log);
  const auto wheels = log.all<WheelAngles>();
  const auto steps = motions(log);
  std::vector<Pose2> poses{pose_of(log.all<Truth>().front().second)};
  for (const Motion& step : steps) poses.push_back(poses.back() * step.increment);
  int between = 0;
  for (const auto& [stamp, seen] : log.all<Observations>()) {
    const auto later = std::ranges::upper_bound(wheels, stamp, {}, &std::pair<Stamp, WheelAngles>::first);
    const auto i = static_cast<std::size_t>(later - wheels.begin()) - 1;
    if (stamp != wheels[i].first) ++between;
    const double fraction = to_seconds(stamp - wheels[i].first) * options.wheels.rate_hz;
    const WheelAngles whole = increment(wheels[i].second, wheels[std::min(i + 1, steps.size())].second);
    const Motion part = wheel_motion({fraction * whole.left_rad, fraction * whole.right_rad},
                                     configured<OdometryOptions>(log));
    const Pose2 T_sensor_world = (poses[i] * part.increment * sensor.T_robot_sensor()).inverse();
    for (const Observation& observation : seen) {
      const TrueLandmark& landmark = log.info.landmarks[static_cast<std::size_t>(observation.id->number)];
      const RangeBearing expected = sight(T_sensor_world, {landmark.x_m, landmark.y_m});
      const auto& value = std::get<RangeBearing>(observation.value);
      ASSERT_NEAR(value.range_m, expected.range_m, 1e-9);
      ASSERT_NEAR(value.bearing_rad, expected.bearing_rad, 1e-9);
      ASSERT_GE(value.range_m, sensor.min_range_m);
      ASSERT_LE(value.range_m, sensor.max_range_m);
      ASSERT_LE(std::abs(value.bearing_rad), to_radians(sensor.field_of_view_deg) / 2.0);
    }
  }
  EXPECT_GT(between, 100);
}

// The covariance that a filter would propagate is that of the real errors: NEES of dead reckoning over two
// sides and a corner, where it is still close to linear. Its mean over 400 seeds has a standard deviation of
// sqrt(6 / 400) = 0.12.
TEST(Simulation, MotionModelOfTheFilterIsHonest) {
  SimOptions options;
  options.path.side_m = 2.0;
  options.world.landmarks = 0;
  options.truth.rate_hz = options.wheels.rate_hz;
  options.wheels.slip_lateral_var_m2_per_m = 1e-4;
  double sum = 0.0;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    const Log log = simulate(options, seed);
    const auto truth = log.all<Truth>();
    const auto steps = motions(log);
    PoseEstimate estimate{pose_of(truth.front().second), Eigen::Matrix3d::Zero()};
    const std::size_t half = steps.size() / 2;
    for (std::size_t i = 0; i < half; ++i) estimate = propagate(estimate, steps[i]);
    const Eigen::Vector3d error = difference(estimate.T_world_robot, pose_of(truth[half].second));
    sum += mahalanobis_squared<3>(error, estimate.covariance).value();
  }
  EXPECT_NEAR(sum / 400.0, 3.0, 0.5);
}

TEST(Simulation, SparseTruthIsAtTheCornersOnly) {
  SimOptions options = ideal();
  options.truth.rate_hz = 0.0;
  options.truth.heading = false;
  const auto truth = simulate(options).all<Truth>();
  ASSERT_EQ(truth.size(), 6u);  // the start, four corners, and the end after the last turn
  for (const auto& [stamp, mark] : truth) {
    EXPECT_NEAR(std::abs(mark.x_m), 3.0, 1e-9);
    EXPECT_NEAR(std::abs(mark.y_m), 3.0, 1e-9);
    EXPECT_FALSE(mark.theta_rad.has_value());
  }
}

/// Median over seeds of the distance between dead reckoning and truth at the end of a drive without landmarks
/// and images.
double median_drift_m(SimOptions options) {
  options.world.landmarks = 0;
  options.room.scene = SceneKind::kNone;
  std::vector<double> errors_m;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    const Log log = simulate(options, seed);
    const auto truth = log.all<Truth>();
    Pose2 T_world_robot = pose_of(truth.front().second);
    for (const Motion& step : motions(log)) T_world_robot = T_world_robot * step.increment;
    errors_m.push_back((T_world_robot.position() - pose_of(truth.back().second).position()).norm());
  }
  std::ranges::nth_element(errors_m, errors_m.begin() + 150);
  return errors_m[150];
}

// After one lap of 24 m, the 1.6 m that Vincke et al. (2012) report of their robot. The median of 300 seeds
// has a standard deviation of about 0.07 m.
TEST(Simulation, StudyDriftsByOnePointSixMetresPerLap) {
  SimOptions options = *scenario("study");
  options.path.laps = 1;
  const double drift_m = median_drift_m(options);
  EXPECT_GT(drift_m, 1.3);
  EXPECT_LT(drift_m, 1.9);
}

TEST(Simulation, RoomDriftsByOnePointSixMetresPerLap) {
  const double drift_m = median_drift_m(*scenario("room"));
  EXPECT_GT(drift_m, 1.3);
  EXPECT_LT(drift_m, 1.9);
}

TEST(Simulation, StudyIsTheStudy) {
  const Log log = simulate(*scenario("study"));
  EXPECT_EQ(log.info.landmarks.size(), 24u);
  EXPECT_NEAR(to_seconds(log.events.back().stamp), 176.0, 1e-9);
  EXPECT_GT(log.all<Observations>().size(), 1000u);
}

TEST(Simulation, ForestHidesIdentitiesAndIsTheSameWithThem) {
  SimOptions options = *scenario("forest");
  const Log hidden = simulate(options);
  options.sensor.identities = true;
  const Log told = simulate(options);
  EXPECT_FALSE(hidden.info.identities);
  EXPECT_TRUE(told.info.identities);
  EXPECT_EQ(hidden.info.landmarks.size(), 100u);
  const auto hidden_scans = hidden.all<Observations>();
  const auto told_scans = told.all<Observations>();
  ASSERT_EQ(hidden_scans.size(), told_scans.size());
  int named = 0;
  int clutter = 0;
  for (std::size_t i = 0; i < told_scans.size(); ++i) {
    ASSERT_EQ(hidden_scans[i].second.size(), told_scans[i].second.size());
    for (std::size_t k = 0; k < told_scans[i].second.size(); ++k) {
      const auto& seen = std::get<RangeBearing>(hidden_scans[i].second[k].value);
      EXPECT_EQ(seen.range_m, std::get<RangeBearing>(told_scans[i].second[k].value).range_m);
      EXPECT_FALSE(hidden_scans[i].second[k].id);
      ++(told_scans[i].second[k].id ? named : clutter);
    }
  }
  EXPECT_NEAR(clutter, 0.05 * named, 5.0 * std::sqrt(0.05 * named));
}

TEST(Simulation, SameSeedGivesTheSameBits) {
  SimOptions options = *scenario("study");
  options.sensor.drop_probability = options.sensor.false_probability = options.sensor.misread_probability =
      0.1;
  const Log a = simulate(options, 42);
  const Log b = simulate(options, 42);
  ASSERT_EQ(a.events.size(), b.events.size());
  for (std::size_t i = 0; i < a.events.size(); ++i) ASSERT_TRUE(same(a.events[i], b.events[i])) << i;
}

TEST(Simulation, AnotherSeedGivesAnotherWorldAndOtherErrors) {
  const Log a = simulate(*scenario("study"), 1);
  const Log b = simulate(*scenario("study"), 2);
  EXPECT_NE(a.info.landmarks[0].x_m, b.info.landmarks[0].x_m);
  EXPECT_NE(a.all<WheelAngles>().back().second.left_rad, b.all<WheelAngles>().back().second.left_rad);
}

// Studies compare sensors on the same drive and wheels in front of the same sensor.
TEST(Simulation, SensorAndWheelsErrIndependently) {
  SimOptions options = *scenario("study");
  const Log a = simulate(options);
  options.sensor.drop_probability = 0.5;
  const Log b = simulate(options);
  EXPECT_EQ(a.all<WheelAngles>().back().second.left_rad, b.all<WheelAngles>().back().second.left_rad);
}

/// A short drive through a small room.
SimOptions short_camera_run() {
  SimOptions options = *scenario("room");
  options.path.side_m = 1.0;
  options.path.corner_radius_m = 0.0;
  options.path.speed_mps = 2.0;
  options.path.turn_rate_max_degps = 300.0;
  options.room.blocks = 3;
  return options;
}

TEST(Simulation, RoomHasAnImageAndATruePoseThirtyTimesASecond) {
  const Log log = simulate(short_camera_run());
  const auto images = log.all<Image>();
  const auto truth = log.all<Truth>();
  ASSERT_GT(images.size(), 60u);
  EXPECT_NEAR(static_cast<double>(images.size()), to_seconds(log.events.back().stamp) * 30.0 + 1.0, 1.0);
  for (std::size_t i = 0; i < images.size(); ++i) {
    ASSERT_EQ(images[i].first, truth[i].first);
    ASSERT_EQ(images[i].second.pixels->width_px(), 320);
    ASSERT_EQ(images[i].second.pixels->height_px(), 240);
  }
}

TEST(Simulation, ImagesAreTheSameBitsForASeedOnAnyNumberOfThreads) {
  SimOptions options = short_camera_run();
  options.camera_simulator.rate_hz = 5.0;
  const auto images_of = [&](std::uint64_t seed, int threads) {
    std::vector<GreyImage> images;
    auto simulation = Simulation::make("test", options, seed, threads);
    EXPECT_TRUE(simulation.ok());
    for (auto event = (*simulation)->next(); event->has_value(); event = (*simulation)->next())
      if (const auto* image = std::get_if<Image>(&(**event).content)) images.push_back(*image->pixels);
    return images;
  };
  const auto images = images_of(7, 1);
  EXPECT_GT(images.size(), 10u);
  EXPECT_EQ(images, images_of(7, 1));
  EXPECT_EQ(images, images_of(7, 3));
  EXPECT_NE(images, images_of(8, 1));
}

TEST(Simulation, LostImagesLeaveTheOthersAsTheyWere) {
  SimOptions options = short_camera_run();
  options.camera_simulator.rate_hz = 10.0;
  const auto all = simulate(options).all<Image>();
  options.camera_simulator.drop_probability = 0.5;
  const auto some = simulate(options).all<Image>();
  EXPECT_LT(some.size(), all.size() - 5);
  EXPECT_GT(some.size(), 5u);
  for (const auto& [stamp, image] : some) {
    const auto same = std::ranges::find(all, stamp, &std::pair<Stamp, Image>::first);
    ASSERT_NE(same, all.end());
    EXPECT_EQ(*image.pixels, *same->second.pixels);
  }
}

TEST(Simulation, TellsTheCameraInTheKeysOfItsModel) {
  SimOptions options = short_camera_run();
  options.camera_simulator.mount.pitch_deg = 3.0;
  auto simulation = Simulation::make("test", options, 1);
  ASSERT_TRUE(simulation.ok());
  const auto camera = configured<CameraOptions>({(*simulation)->info(), {}});
  EXPECT_EQ(camera.width_px, 320);
  EXPECT_NEAR(camera.fu_px, 160.0 / std::tan(to_radians(30.0)), 1e-9);
  EXPECT_EQ(camera.distortion.k1, options.camera_simulator.distortion.k1);
  EXPECT_EQ(camera.mount.z_m, options.camera_simulator.mount.z_m);
  EXPECT_EQ(camera.mount.pitch_deg, 3.0);
}

TEST(Simulation, RefusesBadOptions) {
  SimOptions options;
  options.sensor.field_of_view_deg = 400.0;
  const auto simulation = Simulation::make("test", options, 1);
  ASSERT_FALSE(simulation.ok());
  EXPECT_THAT(simulation.error().message, testing::HasSubstr("sim.field_of_view_deg"));
}

TEST(Simulation, RefusesToFillTheMemory) {
  SimOptions options;
  options.path.side_m = 1000.0;
  options.path.laps = 1000;
  const auto simulation = Simulation::make("test", options, 1);
  ASSERT_FALSE(simulation.ok());
  EXPECT_THAT(simulation.error().message, testing::HasSubstr("sim.laps"));
}

}  // namespace
}  // namespace waymark::sim
