#include "workbench/sim/options.hpp"

#include <functional>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/io_support.hpp"

namespace waymark::sim {
namespace {

using testing::HasSubstr;

TEST(SimOptions, EveryScenarioIsValidAndFoundByName) {
  for (const std::string& name : scenario_names()) {
    const auto options = scenario(name);
    ASSERT_TRUE(options.ok()) << name;
    EXPECT_TRUE(validate(*options).ok()) << name;
  }
}

TEST(SimOptions, ScenariosDriveDifferentPaths) {
  EXPECT_EQ(scenario("l-shape")->path.shape, Shape::kLShape);
  EXPECT_EQ(scenario("figure-eight")->path.shape, Shape::kFigureEight);
  EXPECT_EQ(scenario("random")->path.shape, Shape::kRandom);
  EXPECT_EQ(scenario("study")->path.laps, 2);
  EXPECT_EQ(scenario("report-l-shape")->path.shape, Shape::kLShape);
  EXPECT_EQ(scenario("report-square")->wheels.odometry, SimulatedOdometry::kVelocity);
}

/// All keys with their values.
std::string text_of(SimOptions options) {
  Schema schema;
  describe(schema, options);
  return schema.to_yaml();
}

TEST(SimOptions, TheSquareIsTheDefaultAndOtherPathsDifferByTheirShapeAlone) {
  EXPECT_EQ(text_of(scenario("square").value()), text_of({}));
  for (const std::string name : {"l-shape", "figure-eight", "random"}) {
    SimOptions options = scenario(name).value();
    EXPECT_NE(options.path.shape, Shape::kSquare) << name;
    options.path.shape = Shape::kSquare;
    EXPECT_EQ(text_of(options), text_of({})) << name;
  }
}

TEST(SimOptions, AFileIsAScenarioToo) {
  const test::TempFolder folder;
  const auto file = folder.write("mine.yaml", "sim:\n  path: loop\n  landmarks: 5\n");
  const auto mine = scenario(file.string());
  ASSERT_TRUE(mine.ok()) << mine.error().message;
  EXPECT_EQ(mine->path.shape, Shape::kLoop);
  EXPECT_EQ(mine->world.landmarks, 5);
  EXPECT_EQ(mine->world.max_offset_m, SimOptions{}.world.max_offset_m);
  EXPECT_THAT(scenario(folder.write("bad.yaml", "sim:\n  lap: 5\n").string()).error().message,
              HasSubstr("bad.yaml:2: unknown key sim.lap; did you mean sim.laps?"));
  EXPECT_THAT(scenario(folder.write("other.yaml", "sim:\n  laps: 5\nfilter: ekf\n").string()).error().message,
              HasSubstr("other.yaml:3: a world has only keys `sim.*`; give filter by --config"));
  EXPECT_THAT(scenario("nowhere.yaml").error().message, HasSubstr("nowhere.yaml"));
}

TEST(SimOptions, EveryScenarioIsThatOfItsFile) {
  EXPECT_EQ(scenario("study")->wheels.var_m2_per_m, 2.9e-4);
  EXPECT_EQ(scenario("report-square")->wheels.slip_turn_var_rad2_per_m, 0.05 * 0.05 * 0.1 / 0.3);
  EXPECT_FALSE(scenario("forest")->sensor.identities);
  EXPECT_EQ(scenario("marker-room")->room.markers, 12);
  EXPECT_EQ(scenario("corridor")->room.scene, SceneKind::kCorridor);
}

TEST(SimOptions, UnknownScenarioNamesTheNearest) {
  const auto options = scenario("sqare");
  ASSERT_FALSE(options.ok());
  EXPECT_EQ(options.error().kind, Error::Kind::kBadInput);
  EXPECT_THAT(options.error().message, HasSubstr("did you mean 'square'?"));
  EXPECT_THAT(options.error().message, HasSubstr("figure-eight"));
}

TEST(SimOptions, KeysSetTheirFields) {
  SimOptions options;
  Schema schema;
  describe(schema, options);
  ASSERT_TRUE(schema.set("sim.path", "figure-eight", "test").ok());
  ASSERT_TRUE(schema.set("sim.landmarks", "7", "test").ok());
  ASSERT_TRUE(schema.set("sim.odometry", "pose", "test").ok());
  ASSERT_TRUE(schema.set("sim.observe", "bearing", "test").ok());
  ASSERT_TRUE(schema.set("sim.identities", "false", "test").ok());
  ASSERT_TRUE(schema.set("sim.truth_rate_hz", "0", "test").ok());
  EXPECT_EQ(options.path.shape, Shape::kFigureEight);
  EXPECT_EQ(options.world.landmarks, 7);
  EXPECT_EQ(options.wheels.odometry, SimulatedOdometry::kPose);
  EXPECT_EQ(options.sensor.observe, SensorKind::kBearing);
  EXPECT_FALSE(options.sensor.identities);
  EXPECT_EQ(options.truth.rate_hz, 0.0);
}

struct BadOptions {
  const char* key;
  std::function<void(SimOptions&)> spoil;
};

class RefusedOptions : public testing::TestWithParam<BadOptions> {};

TEST_P(RefusedOptions, AreNamedByTheirKey) {
  SimOptions options;
  GetParam().spoil(options);
  const auto valid = validate(options);
  ASSERT_FALSE(valid.ok());
  EXPECT_THAT(valid.error().message, HasSubstr(GetParam().key));
}

INSTANTIATE_TEST_SUITE_P(
    All, RefusedOptions,
    testing::Values(
        BadOptions{"sim.side_m", [](SimOptions& o) { o.path.side_m = -6.0; }},
        BadOptions{"sim.side_m",
                   [](SimOptions& o) { o.path.side_m = std::numeric_limits<double>::quiet_NaN(); }},
        BadOptions{"sim.speed_mps", [](SimOptions& o) { o.path.speed_mps = 0.0; }},
        BadOptions{"sim.laps", [](SimOptions& o) { o.path.laps = 0; }},
        BadOptions{"sim.landmarks", [](SimOptions& o) { o.world.landmarks = -1; }},
        BadOptions{"sim.landmark_max_offset_m",
                   [](SimOptions& o) { o.world.min_offset_m = o.world.max_offset_m; }},
        BadOptions{"sim.odometry_rate_hz", [](SimOptions& o) { o.wheels.rate_hz = 0.0; }},
        BadOptions{"sim.wheel_var_m2_per_m", [](SimOptions& o) { o.wheels.var_m2_per_m = -1e-4; }},
        BadOptions{"sim.sensor_rate_hz", [](SimOptions& o) { o.sensor.rate_hz = 0.0; }},
        BadOptions{"sim.field_of_view_deg", [](SimOptions& o) { o.sensor.field_of_view_deg = 361.0; }},
        BadOptions{"sim.range_max_m", [](SimOptions& o) { o.sensor.range_max_m = o.sensor.range_min_m; }},
        BadOptions{"sim.drop_probability", [](SimOptions& o) { o.sensor.drop_probability = 1.5; }}));

}  // namespace
}  // namespace waymark::sim
