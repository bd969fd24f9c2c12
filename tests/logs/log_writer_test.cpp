#include "workbench/logs/log_writer.hpp"

#include <map>

#include <gmock/gmock.h>

#include "support/data_dir.hpp"
#include "support/io_support.hpp"
#include "waymark/core/random.hpp"

#include "workbench/logs/image_loader.hpp"
#include "workbench/logs/log_folder.hpp"
#include "workbench/sim/simulation.hpp"

namespace waymark {

// For comparing events; the library itself never needs it.
static bool operator==(const WheelAngles& a, const WheelAngles& b) {
  return a.left_rad == b.left_rad && a.right_rad == b.right_rad;
}
static bool operator==(const Velocity& a, const Velocity& b) {
  return a.v_mps == b.v_mps && a.w_radps == b.w_radps;
}
static bool operator==(const Steering& a, const Steering& b) {
  return a.v_mps == b.v_mps && a.steer_rad == b.steer_rad;
}
static bool operator==(const OdometryPose& a, const OdometryPose& b) {
  return a.T_odom_robot == b.T_odom_robot;
}
static bool operator==(const YawRate& a, const YawRate& b) { return a.w_radps == b.w_radps; }
static bool operator==(const Image& a, const Image& b) {
  const bool same_pixels = a.pixels == b.pixels || (a.pixels && b.pixels && *a.pixels == *b.pixels);
  return same_pixels && (a.file == b.file || a.pixels);
}
static bool operator==(const Truth& a, const Truth& b) {
  return a.x_m == b.x_m && a.y_m == b.y_m && a.theta_rad == b.theta_rad;
}
static bool operator==(const RangeBearing& a, const RangeBearing& b) {
  return a.range_m == b.range_m && a.bearing_rad == b.bearing_rad;
}
static bool operator==(const Range& a, const Range& b) { return a.range_m == b.range_m; }
static bool operator==(const Bearing& a, const Bearing& b) { return a.bearing_rad == b.bearing_rad; }
static bool operator==(const Pixel& a, const Pixel& b) { return a.u_px == b.u_px && a.v_px == b.v_px; }
static bool operator==(const Observation& a, const Observation& b) {
  return a.id == b.id && a.value == b.value;
}
static bool operator==(const Event& a, const Event& b) {
  return a.stamp == b.stamp && a.content == b.content;
}

namespace {

using test::TempFolder;
using testing::HasSubstr;

/// Delivers a list of events, then an error if there is one.
class ListSource : public Source {
 public:
  ListSource(LogInfo info, std::vector<Event> events, std::string error = "")
      : info_(std::move(info)), events_(std::move(events)), error_(std::move(error)) {}

  [[nodiscard]] const LogInfo& info() const override { return info_; }
  Result<std::optional<Event>> next() override {
    if (next_ < events_.size()) return std::optional(events_[next_++]);
    if (!error_.empty()) return Error{error_};
    return std::optional<Event>{};
  }

 private:
  LogInfo info_;
  std::vector<Event> events_;
  std::string error_;
  std::size_t next_ = 0;
};

/// A log with awkward numbers: odometry of one kind, truth with and without heading, observations of every
/// kind.
template <class Odometry>
std::vector<Event> awkward_events() {
  RandomStream random(3, StreamPurpose::kSimulation);
  const LandmarkId id{LandmarkId::Family::kMarker, 12};
  std::vector<Event> events;
  Stamp stamp{Duration{1248444175103000001}};
  const auto add = [&](EventContent content) { events.push_back({stamp, std::move(content)}); };
  for (int i = 0; i < 50; ++i) {
    stamp = stamp + Duration{1 + 7919 * i};
    if constexpr (std::is_same_v<Odometry, OdometryPose>)
      add(OdometryPose{{random.normal(), random.normal() * 1e-300, random.normal() * 1e200}});
    else
      add(Odometry{random.normal() * 1e-9, random.normal() / 3.0});
    add(YawRate{random.normal()});
    add(Truth{random.normal(), random.normal(), i % 2 == 0 ? std::optional(0.1) : std::nullopt});
    add(Observations{{id, RangeBearing{random.uniform(), random.normal()}, std::nullopt},
                     {std::nullopt, Range{random.uniform()}, std::nullopt},
                     {id, Bearing{random.normal()}, std::nullopt},
                     {id, Pixel{random.normal(), -0.0}, std::nullopt}});
    stamp = stamp + Duration{3};
    add(Observations{});
  }
  return events;
}

template <class Odometry>
class LogRoundTrip : public testing::Test {};
using OdometryKinds = testing::Types<WheelAngles, Velocity, Steering, OdometryPose>;
TYPED_TEST_SUITE(LogRoundTrip, OdometryKinds);

TYPED_TEST(LogRoundTrip, GivesTheSameEventsToTheLastBit) {
  const TempFolder folder;
  const auto events = awkward_events<TypeParam>();
  ListSource source({}, events);
  const auto done = write_log(source, folder.path());
  ASSERT_TRUE(done.ok()) << done.error().message;
  const auto log = open_log_folder(folder.path());
  ASSERT_TRUE(log.ok()) << log.error().message;
  const auto delivered = test::read_all(**log);
  EXPECT_EQ(delivered.error, "");
  ASSERT_EQ(delivered.events.size(), events.size());
  for (std::size_t i = 0; i < events.size(); ++i)
    EXPECT_TRUE(delivered.events[i] == events[i]) << "event " << i;
}

TEST(LogWriter, KeepsWhatTheLogSaysAboutItself) {
  LogInfo info;
  info.name = "a: \"name\" # with 'marks'";
  info.settings = {{"sensor.range_sigma_m", "0.7"}, {"wheels.track_m", "0.3"},        {"sensor.x_m", "0.1"},
                   {"motion.turn_scale", "1.1"},    {"sensor.range_sigma_m", "0.25"}, {"input.note", "a: b"}};
  info.truth_sensor_m = Eigen::Vector2d(0.1, -1.0 / 3.0);
  info.landmarks = {{{LandmarkId::Family::kMarker, 3}, 0.1, 1.0 / 3.0, -2.0}};
  const TempFolder folder;
  ListSource source(info, {});
  ASSERT_TRUE(write_log(source, folder.path()).ok());
  const auto log = open_log_folder(folder.path());
  ASSERT_TRUE(log.ok()) << log.error().message;
  const LogInfo& read = (*log)->info();
  EXPECT_EQ(read.name, info.name);
  EXPECT_EQ(read.truth_sensor_m, info.truth_sensor_m);
  const std::map<std::string, std::string> settings(read.settings.begin(), read.settings.end());
  EXPECT_EQ(settings, (std::map<std::string, std::string>{{"sensor.range_sigma_m", "0.25"},
                                                          {"wheels.track_m", "0.3"},
                                                          {"sensor.x_m", "0.1"},
                                                          {"motion.turn_scale", "1.1"},
                                                          {"input.note", "a: b"}}));
  EXPECT_EQ(read.settings.size(), settings.size());
  ASSERT_EQ(read.landmarks.size(), 1U);
  EXPECT_EQ(read.landmarks[0].id, info.landmarks[0].id);
  EXPECT_EQ(read.landmarks[0].y_m, 1.0 / 3.0);
  EXPECT_EQ(read.landmarks[0].z_m, -2.0);
}

TEST(LogWriter, ObservationsHaveTheColumnsThatTheyNeed) {
  const Observation range{std::nullopt, Range{2.0}, std::nullopt};
  const Observation pixel{LandmarkId{LandmarkId::Family::kMarker, 5}, Pixel{3.0, 4.0}, std::nullopt};
  const auto written = [](const Observations& observations) {
    const TempFolder folder;
    ListSource source({}, {{Stamp{}, observations}});
    EXPECT_TRUE(write_log(source, folder.path()).ok());
    return read_file(folder.path() / "observations.csv").value();
  };
  EXPECT_EQ(written({range}), "stamp_s,id,range_m,bearing_rad\n0.000000000,,2,\n");
  EXPECT_EQ(written({pixel}), "stamp_s,id,u_px,v_px\n0.000000000,5,3,4\n");
  EXPECT_EQ(written({}), "stamp_s,id,range_m,bearing_rad\n0.000000000,,,\n");
  EXPECT_EQ(written({range, pixel}),
            "stamp_s,id,range_m,bearing_rad,u_px,v_px\n0.000000000,,2,,,\n0.000000000,5,,,3,4\n");
}

TEST(LogWriter, NamesImagesByTheirPlace) {
  const TempFolder folder;
  const TempFolder elsewhere;
  const std::string inside = folder.write("images/a.png", "x").string();
  const std::string outside = elsewhere.write("b.png", "x").string();
  ListSource source({}, {{Stamp{}, Image{inside}}, {Stamp{Duration{1}}, Image{outside}}});
  ASSERT_TRUE(write_log(source, folder.path()).ok());
  EXPECT_THAT(read_file(folder.path() / "images.csv").value(), HasSubstr(",a.png\n"));
  const auto log = open_log_folder(folder.path());
  ASSERT_TRUE(log.ok());
  const auto images = test::only<Image>(test::read_all(**log).events);
  ASSERT_EQ(images.size(), 2U);
  EXPECT_EQ(images[0].second.file, inside);
  EXPECT_EQ(images[1].second.file, outside);
}

/// A drive of two seconds through a rendered room.
Result<std::unique_ptr<sim::Simulation>> rendered_room() {
  sim::SimOptions options = *sim::scenario("room");
  options.path.side_m = 0.5;
  options.path.corner_radius_m = 0.0;
  options.path.speed_mps = 5.0;
  options.path.turn_rate_max_degps = 500.0;
  options.room.blocks = 2;
  options.camera_simulator.mount.pitch_deg = 2.5;
  return sim::Simulation::make("room", options, 4);
}

using StringMap = std::map<std::string, std::string>;

StringMap map_of(const LogInfo& info) { return {info.settings.begin(), info.settings.end()}; }

TEST(LogWriter, CopyOfARenderedRoomIsTheSameLogImagesIncluded) {
  const TempFolder folder;
  double last_progress = 0.0;
  ASSERT_TRUE(write_log(**rendered_room(), folder.path(), [&](double part) { last_progress = part; }).ok());
  EXPECT_EQ(last_progress, 1.0);
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "camera.yaml"));
  auto log = open_log_folder(folder.path());
  ASSERT_TRUE(log.ok()) << log.error().message;
  ImageLoader copy(*std::move(log));
  const auto simulation = rendered_room();
  EXPECT_EQ(map_of(copy.info()), map_of((*simulation)->info()));
  const auto made = test::read_all(**simulation).events;
  const auto copied = test::read_all(copy).events;
  ASSERT_EQ(copied.size(), made.size());
  EXPECT_GT(test::only<Image>(made).size(), 20U);
  EXPECT_TRUE(std::ranges::equal(copied, made, [](const Event& a, const Event& b) { return a == b; }));
}

TEST(LogWriter, RefusesToMixWithAnotherLogButReplacesItsOwn) {
  const TempFolder folder;
  ListSource velocities({}, {{Stamp{}, Velocity{}}});
  ASSERT_TRUE(write_log(velocities, folder.path()).ok());
  ListSource again({}, {{Stamp{}, Velocity{}}});
  EXPECT_TRUE(write_log(again, folder.path()).ok());
  ListSource wheels({}, {{Stamp{}, WheelAngles{}}});
  EXPECT_THAT(write_log(wheels, folder.path()).error().message, HasSubstr("velocity.csv is of another log"));
}

TEST(LogWriter, PassesOnWhatTheSourceCannotRead) {
  const TempFolder folder;
  ListSource source({}, {{Stamp{}, Velocity{}}}, "velocity.csv:7: bad");
  EXPECT_EQ(write_log(source, folder.path()).error().message, "velocity.csv:7: bad");
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(LogWriter, RefusesWhatTheFormatCannotHold) {
  const TempFolder folder;
  ListSource covariance({},
                        {{Stamp{}, Observations{{std::nullopt, Range{1.0}, Eigen::Matrix2d::Identity()}}}});
  EXPECT_THAT(write_log(covariance, folder.path()).error().message, HasSubstr("covariance"));
  ListSource comma({}, {{Stamp{}, Image{"a,b.png"}}});
  EXPECT_THAT(write_log(comma, folder.path()).error().message, HasSubstr("comma"));
  const auto file = folder.write("x", "");
  ListSource nothing({}, {});
  EXPECT_FALSE(write_log(nothing, file / "below").ok());
}

TEST(LogWriter, CopyOfTheMbotRecordingIsTheSameLog) {
  WAYMARK_REQUIRE_DATA("mbot-apriltag/log-folder");
  const auto original = test::data_path("mbot-apriltag/log-folder");
  const TempFolder folder;
  ASSERT_TRUE(write_log(*open_log_folder(original).value(), folder.path()).ok());
  const auto read = test::read_all(*open_log_folder(original).value()).events;
  const auto copied = test::read_all(*open_log_folder(folder.path()).value()).events;
  ASSERT_EQ(copied.size(), read.size());
  EXPECT_TRUE(std::ranges::equal(copied, read, [](const Event& a, const Event& b) { return a == b; }));
}

}  // namespace
}  // namespace waymark
