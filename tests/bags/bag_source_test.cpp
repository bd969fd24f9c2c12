#include "workbench/bags/bag_source.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <gmock/gmock.h>

#include "support/io_support.hpp"

#include "bags/wire.hpp"
#include "workbench/bags/message_definition.hpp"

namespace waymark {
namespace {

using bag::Encoding;
using bag::Message;
using bag::Summary;
using bag::test::Wire;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

/// A bag in memory, whose messages are written as in ROS 1.
class MadeBag final : public bag::Reader {
 public:
  /// With the known definition of the type, but headers without the number that ROS 1 gives them.
  std::size_t topic(std::string name, std::string type) {
    std::string definition;
    for (const auto text : bag::known_definitions(type, Encoding::kRos1))
      if (definition.empty())
        definition = std::string(text) + "========\nMSG: std_msgs/Header\ntime stamp\nstring frame_id\n";
    summary_.topics.push_back({.name = std::move(name),
                               .type = std::move(type),
                               .encoding = Encoding::kRos1,
                               .definition = std::move(definition)});
    return summary_.topics.size() - 1;
  }
  void add(std::size_t topic, double recorded_s, std::string bytes) {
    ++summary_.topics[topic].messages;
    include(summary_, stamp_from_seconds(recorded_s));
    messages_.push_back({topic, stamp_from_seconds(recorded_s), std::move(bytes)});
  }

  [[nodiscard]] const Summary& summary() const override { return summary_; }
  void rewind(std::vector<bool> wanted) override {
    wanted_ = std::move(wanted);
    next_ = 0;
  }
  [[nodiscard]] std::optional<Message> next() override {
    while (next_ < messages_.size()) {
      const auto& message = messages_[next_++];
      if (wanted_[message.topic]) return Message{message.topic, message.recorded, message.bytes};
    }
    return std::nullopt;
  }
  [[nodiscard]] std::vector<std::string> notes() const override { return {}; }
  [[nodiscard]] double progress() const override { return 0.0; }

 private:
  struct Stored {
    std::size_t topic;
    Stamp recorded;
    std::string bytes;
  };
  Summary summary_;
  std::vector<Stored> messages_;
  std::vector<bool> wanted_;
  std::size_t next_ = 0;
};

Wire with_header(double stamp_s, std::string_view frame = "base_link") {
  Wire wire(Encoding::kRos1);
  const auto nanos = stamp_from_seconds(stamp_s).since_epoch.count();
  wire.add(static_cast<std::int32_t>(nanos / 1'000'000'000))
      .add(static_cast<std::uint32_t>(nanos % 1'000'000'000));
  return wire.text(frame);
}

std::string twist(double stamp_s, double v_mps, double w_radps = 0.0) {
  Wire wire = with_header(stamp_s);
  for (const double value : {v_mps, 0.0, 0.0, 0.0, 0.0, w_radps}) wire.add(value);
  return wire.bytes();
}

std::string pose(double stamp_s, double x_m, double y_m, double theta_rad) {
  Wire wire = with_header(stamp_s, "odom");
  for (const double value : {x_m, y_m, 0.0, 0.0, 0.0, std::sin(theta_rad / 2.0), std::cos(theta_rad / 2.0)})
    wire.add(value);
  return wire.bytes();
}

std::string mono(double stamp_s, std::string_view frame, std::string_view encoding, int side_px,
                 std::string_view pixels, std::optional<std::uint32_t> step = {}) {
  Wire wire = with_header(stamp_s, frame);
  const auto side = static_cast<std::uint32_t>(side_px);
  wire.add(side).add(side).text(encoding).add<std::uint8_t>(0);
  wire.add(step.value_or(static_cast<std::uint32_t>(pixels.size() / side))).text(pixels, Wire::Text::kBytes);
  return wire.bytes();
}

std::string markers_17(double stamp_s) {
  Wire wire = with_header(stamp_s, "camera");
  wire.add<std::uint32_t>(1).add<std::int64_t>(17).add<std::uint32_t>(1);
  for (const double value : {1.0, -3.0, 2.0, 0.0, 0.0, 0.0, 1.0}) wire.add(value);
  return wire.bytes();
}

std::unique_ptr<Source> source_of(std::unique_ptr<MadeBag> made, const BagOptions& options = {}) {
  auto source = make_bag_source(std::move(made), "made.bag", options);
  EXPECT_TRUE(source.ok()) << source.error().message;
  return source ? *std::move(source) : nullptr;
}

std::vector<double> speeds(Source& source) {
  std::vector<double> values;
  for (const auto& [stamp, velocity] : test::only<Velocity>(test::read_all(source).events))
    values.push_back(velocity.v_mps);
  return values;
}

TEST(BagSource, OrdersByTheStampsOfTheHeaders) {
  auto made = std::make_unique<MadeBag>();
  const auto speed = made->topic("/speed", "geometry_msgs/TwistStamped");
  const auto truth = made->topic("/mocap", "geometry_msgs/PoseStamped");
  made->add(speed, 100.00, twist(10.0, 1.0));
  made->add(speed, 100.10, twist(10.1, 2.0));
  made->add(truth, 101.50, pose(10.05, 3.0, 4.0, 0.5));  // recorded late
  made->add(speed, 101.60, twist(11.6, 3.0));
  const auto source = source_of(std::move(made), {.truth_topic = "/mocap"});
  const auto events = test::read_all(*source).events;
  ASSERT_EQ(events.size(), 4U);
  const auto& seen = std::get<Truth>(events[1].content);
  EXPECT_EQ(events[1].stamp, stamp_from_seconds(10.05));
  EXPECT_EQ(seen.x_m, 3.0);
  EXPECT_NEAR(*seen.theta_rad, 0.5, 1e-15);
}

TEST(BagSource, TakesTheTimeOfRecordingWhereAsked) {
  auto made = std::make_unique<MadeBag>();
  const auto speed = made->topic("/speed", "geometry_msgs/TwistStamped");
  made->add(speed, 100.0, twist(10.0, 1.0));
  const auto source = source_of(std::move(made), {.stamps = BagOptions::Stamps::kRecorded});
  EXPECT_EQ(test::read_all(*source).events.at(0).stamp, stamp_from_seconds(100.0));
}

TEST(BagSource, SkipsStampsThatJumpAndFollowsAClockThatWasSet) {
  auto made = std::make_unique<MadeBag>();
  const auto speed = made->topic("/speed", "geometry_msgs/TwistStamped");
  for (int i = 0; i < 20; ++i) {
    const double recorded_s = 100.0 + 0.1 * i;
    const double jump_s = i == 5 ? 500.0 : i == 6 ? -60.0 : i >= 12 ? 3600.0 : 0.0;
    made->add(speed, recorded_s, twist(recorded_s + jump_s, i));
  }
  const auto source = source_of(std::move(made));
  // 5 and 6 are alone; 12 is the first of many.
  EXPECT_THAT(speeds(*source),
              testing::ElementsAre(0, 1, 2, 3, 4, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19));
  EXPECT_THAT(source->notes(),
              Contains(AllOf(HasSubstr("/speed skipped whose stamp jumps"), HasSubstr(": 2"))));
  EXPECT_THAT(source->notes(), Contains(HasSubstr("its clock was set")));
}

TEST(BagSource, UsesTheTimeOfRecordingWhereTheHeaderHasNone) {
  auto made = std::make_unique<MadeBag>();
  const auto speed = made->topic("/speed", "geometry_msgs/TwistStamped");
  made->add(speed, 100.0, twist(0.0, 1.0));
  const auto source = source_of(std::move(made));
  EXPECT_EQ(test::read_all(*source).events.at(0).stamp, stamp_from_seconds(100.0));
  EXPECT_THAT(source->notes(),
              Contains(HasSubstr("without a stamp in the header, placed at their time of recording: 1")));
}

TEST(BagSource, PutsWhatIsRecordedLateInItsPlace) {
  auto made = std::make_unique<MadeBag>();
  const auto speed = made->topic("/speed", "geometry_msgs/TwistStamped");
  for (int i = 0; i < 10; ++i) made->add(speed, i, twist(100.0 + i, i));
  made->add(speed, 10.0, twist(101.5, 99.0));
  const auto source = source_of(std::move(made));
  EXPECT_THAT(speeds(*source), testing::ElementsAre(0, 1, 99, 2, 3, 4, 5, 6, 7, 8, 9));
}

/// Speeds, detections of marker 17 and images over 20 s, one topic behind the other.
std::unique_ptr<MadeBag> topic_after_topic() {
  auto made = std::make_unique<MadeBag>();
  const auto speed = made->topic("/speed", "geometry_msgs/TwistStamped");
  const auto markers = made->topic("/markers", "ros2_aruco_interfaces/ArucoMarkers");
  const auto images = made->topic("/raw", "sensor_msgs/Image");
  for (int i = 0; i < 200; ++i) made->add(speed, 0.1 * i, twist(100.0 + 0.1 * i, i));
  for (int i = 0; i < 40; ++i) made->add(markers, 0.5 * i, markers_17(100.0 + 0.5 * i));
  for (int i = 0; i < 20; ++i) made->add(images, i, mono(100.0 + i, "camera", "mono8", 2, "abcd"));
  return made;
}

TEST(BagSource, PlaysTopicsThatLieBehindOneAnotherInTheOrderOfTime) {
  int opened = 0;
  const ReopenBag reopen = [&opened]() -> Result<std::unique_ptr<bag::Reader>> {
    ++opened;
    return std::unique_ptr<bag::Reader>(topic_after_topic());
  };
  for (const ReopenBag& open : {ReopenBag{}, reopen}) {
    auto source = make_bag_source(topic_after_topic(), "made.bag", {}, open);
    ASSERT_TRUE(source.ok());
    const auto events = test::read_all(**source).events;
    EXPECT_EQ(events.size(), 260U);
    EXPECT_TRUE(std::ranges::is_sorted(events, {}, &Event::stamp));
    EXPECT_TRUE(std::holds_alternative<Velocity>(events[0].content)) << "odometry is first at equal stamps";
  }
  EXPECT_EQ(opened, 3) << "each topic has a reader of its own";
}

TEST(BagSource, ReadsABagThatIsInOrderAtOnePlace) {
  auto made = std::make_unique<MadeBag>();
  const auto speed = made->topic("/speed", "geometry_msgs/TwistStamped");
  const auto truth = made->topic("/mocap", "geometry_msgs/PoseStamped");
  for (int i = 0; i < 20; ++i) {
    made->add(speed, i, twist(i + 1.0, i));
    made->add(truth, i, pose(i + 0.5, 3.0, 4.0, 0.5));
  }
  const ReopenBag never = []() -> Result<std::unique_ptr<bag::Reader>> {
    ADD_FAILURE() << "opened again";
    return Error{"no"};
  };
  auto source = make_bag_source(std::move(made), "made.bag", {.truth_topic = "/mocap"}, never);
  ASSERT_TRUE(source.ok());
  EXPECT_EQ(test::read_all(**source).events.size(), 40U);
}

TEST(BagSource, TellsOfClocksThatDisagree) {
  auto made = std::make_unique<MadeBag>();
  const auto speed = made->topic("/speed", "geometry_msgs/TwistStamped");
  const auto markers = made->topic("/markers", "ros2_aruco_interfaces/ArucoMarkers");
  for (int i = 0; i < 40; ++i) {
    made->add(speed, 100.0 + i, twist(100.0 + i, i));
    made->add(markers, 100.0 + i, markers_17(10900.0 + i));
  }
  const auto source = source_of(std::move(made));
  const auto scans = test::only<Observations>(test::read_all(*source).events);
  ASSERT_EQ(scans.size(), 40U);
  EXPECT_EQ(scans[0].first, stamp_from_seconds(100.0));
  EXPECT_THAT(source->notes(),
              Contains(AllOf(HasSubstr("the stamps of /markers are 10800.0 s ahead of those of /speed"),
                             HasSubstr("input.stamps=recorded"))));
}

TEST(BagSource, SkipsMessagesThatDoNotFitOrAreNotFinite) {
  auto made = std::make_unique<MadeBag>();
  const auto speed = made->topic("/speed", "geometry_msgs/TwistStamped");
  made->add(speed, 1.0, twist(1.0, 1.0));
  made->add(speed, 2.0, twist(2.0, 2.0).substr(0, 30));
  made->add(speed, 3.0, twist(3.0, NAN));
  made->add(speed, 4.0, twist(4.0, 4.0) + "more");
  made->add(speed, 5.0, twist(5.0, 5.0));
  const auto source = source_of(std::move(made));
  EXPECT_THAT(speeds(*source), testing::ElementsAre(1.0, 5.0));
  EXPECT_THAT(source->notes(),
              Contains(HasSubstr("/speed skipped that do not match their message definition: 2")));
  EXPECT_THAT(source->notes(), Contains(HasSubstr("/speed skipped that cannot be used: 1")));
  EXPECT_THAT(source->notes(), Contains(HasSubstr("/speed: its 30 bytes end or are invalid at byte")));
}

TEST(BagSource, ChoosesTheOdometryThatSaysMostAndNamesTheOthers) {
  auto made = std::make_unique<MadeBag>();
  const auto pose_topic = made->topic("/goal", "geometry_msgs/PoseStamped");
  const auto few = made->topic("/a", "geometry_msgs/TwistStamped");
  const auto many = made->topic("/b", "geometry_msgs/TwistStamped");
  for (int i = 0; i < 9; ++i) made->add(pose_topic, i, pose(i, 1.0, 2.0, 0.0));
  made->add(few, 1.0, twist(1.0, 1.0));
  for (int i = 0; i < 3; ++i) made->add(many, i, twist(1.0 + i, 7.0));
  const auto source = source_of(std::move(made));
  EXPECT_THAT(speeds(*source), testing::ElementsAre(7.0, 7.0, 7.0));
  EXPECT_THAT(
      source->notes(),
      Contains(HasSubstr("odometry: /b is used, not /a, /goal; set input.odometry_topic to change that")));
}

TEST(BagSource, FindsTheWheelsAmongTheJoints) {
  const auto joints = [](double stamp_s, double left_rad, double right_rad) {
    Wire wire = with_header(stamp_s);
    wire.add<std::uint32_t>(3).text("arm").text("wheel_Left_joint").text("wheel_Right_joint");
    wire.add<std::uint32_t>(3).add(9.0).add(left_rad).add(right_rad);
    return wire.add<std::uint32_t>(0).add<std::uint32_t>(0).bytes();
  };
  const auto make = [&] {
    auto made = std::make_unique<MadeBag>();
    const auto topic = made->topic("/joint_states", "sensor_msgs/JointState");
    made->add(topic, 1.0, joints(1.0, 0.5, 0.75));
    return made;
  };
  const auto source = source_of(make());
  const auto wheels = test::only<WheelAngles>(test::read_all(*source).events);
  ASSERT_EQ(wheels.size(), 1U);
  EXPECT_EQ(wheels[0].second.left_rad, 0.5);
  EXPECT_EQ(wheels[0].second.right_rad, 0.75);
  EXPECT_THAT(source->notes(), Contains(HasSubstr("check wheels.left_radius_m")));
  const auto named = source_of(make(), {.left_joint = "arm", .right_joint = "wheel_Left_joint"});
  EXPECT_EQ(test::only<WheelAngles>(test::read_all(*named).events).at(0).second.left_rad, 9.0);
  const auto nobody =
      make_bag_source(make(), "made.bag", {.odometry_topic = "/joint_states", .left_joint = "leg"});
  EXPECT_THAT(nobody.error().message, HasSubstr("has no positions of the joints leg and *right*wheel*"));
}

TEST(BagSource, PassesOverDepthImagesAndMixesTheOthers) {
  auto made = std::make_unique<MadeBag>();
  const auto depth = made->topic("/a_depth", "sensor_msgs/Image");
  const auto colour = made->topic("/colour", "sensor_msgs/Image");
  made->add(depth, 1.0, mono(1.0, "camera", "32FC1", 2, std::string(16, '\1')));
  made->add(depth, 2.0, mono(2.0, "camera", "32FC1", 2, std::string(16, '\1')));
  made->add(colour, 1.0,
            mono(1.0, "camera", "bgr8", 2, std::string("\x64\x32\x0a", 3) + std::string(9, '\0')));
  const auto source = source_of(std::move(made));
  const auto images = test::only<Image>(test::read_all(*source).events);
  ASSERT_EQ(images.size(), 1U);
  EXPECT_EQ((*images[0].second.pixels)(0, 0), (299 * 10 + 587 * 50 + 114 * 100 + 500) / 1000);
  EXPECT_THAT(source->notes(),
              Contains(HasSubstr("/a_depth is not used for images: its image encoding '32FC1'")));
  EXPECT_TRUE(source->info().only_pixels);
  EXPECT_TRUE(source->info().identities) << "what is followed in images has them";
}

TEST(BagSource, AStepOfZeroMeansRowsWithoutGaps) {
  auto made = std::make_unique<MadeBag>();
  const auto topic = made->topic("/raw", "sensor_msgs/Image");
  made->add(topic, 1.0, mono(1.0, "camera", "mono8", 2, "abcd", 0));
  made->add(topic, 2.0, mono(2.0, "camera", "mono8", 2, "abc", 0));
  const auto source = source_of(std::move(made));
  const auto images = test::only<Image>(test::read_all(*source).events);
  ASSERT_EQ(images.size(), 1U);
  EXPECT_EQ((*images[0].second.pixels)(1, 1), 'd');
}

TEST(BagSource, AMosaicOfOneGreyStaysThatGreyWhereItsColoursAgree) {
  auto made = std::make_unique<MadeBag>();
  const auto topic = made->topic("/raw", "sensor_msgs/Image");
  // Red 40, green 80, blue 120 everywhere: (40 + 2 * 80 + 120) / 4 at every pixel, borders too.
  std::string mosaic;
  for (int v = 0; v < 4; ++v)
    for (int u = 0; u < 4; ++u)
      mosaic += static_cast<char>(v % 2 == 0 ? (u % 2 == 0 ? 40 : 80) : (u % 2 == 0 ? 80 : 120));
  made->add(topic, 1.0, mono(1.0, "camera", "bayer_rggb8", 4, mosaic));
  const auto source = source_of(std::move(made));
  const auto images = test::only<Image>(test::read_all(*source).events);
  ASSERT_EQ(images.size(), 1U);
  EXPECT_EQ(*images[0].second.pixels, GreyImage(4, 4, 80));
}

/// tf_static: a mast on base_footprint, and on it a camera that looks left.
std::string transforms() {
  Wire wire(Encoding::kRos1);
  wire.add<std::uint32_t>(2);
  const auto add = [&wire](std::string_view parent, std::string_view frame,
                           std::initializer_list<double> values) {
    wire.add<std::int32_t>(0).add<std::uint32_t>(0).text(parent).text(frame);
    for (const double value : values) wire.add(value);
  };
  add("base_footprint", "mast", {0.25, 0.0, 1.0, 0.0, 0.0, std::sqrt(0.5), std::sqrt(0.5)});
  add("/mast", "camera", {0.1, 0.0, 0.5, -0.5, 0.5, -0.5, 0.5});
  return wire.bytes();
}

TEST(BagSource, FollowsTheFramesFromTheRobotToTheCamera) {
  auto made = std::make_unique<MadeBag>();
  const auto frames = made->topic("/tf_static", "tf2_msgs/TFMessage");
  const auto markers = made->topic("/markers", "ros2_aruco_interfaces/ArucoMarkers");
  made->add(frames, 0.0, transforms());
  made->add(markers, 1.0, markers_17(1.0));
  const auto source = source_of(std::move(made));
  const auto scans = test::only<Observations>(test::read_all(*source).events);
  ASSERT_EQ(scans.size(), 1U);
  EXPECT_EQ(scans[0].second[0].id->number, 17);
  // One metre right of the camera's axis, two ahead; the height does not count.
  const auto& [range_m, bearing_rad] = std::get<RangeBearing>(scans[0].second[0].value);
  EXPECT_NEAR(range_m, std::sqrt(5.0), 1e-12);
  EXPECT_NEAR(bearing_rad, std::atan2(-1.0, 2.0), 1e-12);
  std::map<std::string, double> settings;
  for (const auto& [key, value] : source->info().settings) settings[key] = std::stod(value);
  EXPECT_NEAR(settings.at("sensor.x_m"), 0.25, 1e-12);
  EXPECT_NEAR(settings.at("sensor.y_m"), 0.1, 1e-12);
  EXPECT_NEAR(settings.at("sensor.yaw_deg"), 90.0, 1e-9);
  EXPECT_NEAR(settings.at("camera.mount_z_m"), 1.5, 1e-12);
  EXPECT_NEAR(settings.at("camera.mount_roll_deg"), 0.0, 1e-9);
  EXPECT_NEAR(settings.at("camera.mount_pitch_deg"), 0.0, 1e-9);
  EXPECT_THAT(source->notes(), Not(Contains(HasSubstr("tf_static"))));
}

TEST(BagSource, CountsObservationsWithoutAUsableIdentityOnce) {
  auto made = std::make_unique<MadeBag>();
  const auto markers = made->topic("/markers", "ros2_aruco_interfaces/ArucoMarkers");
  for (int i = 1; i <= 3; ++i) {
    Wire wire = with_header(i, "camera");
    wire.add<std::uint32_t>(1).add<std::int64_t>(-1).add<std::uint32_t>(1);
    for (const double value : {1.0, -3.0, 2.0, 0.0, 0.0, 0.0, 1.0}) wire.add(value);
    made->add(markers, i, wire.bytes());
  }
  const auto source = source_of(std::move(made));
  EXPECT_EQ(test::only<Observations>(test::read_all(*source).events).size(), 3U) << "empty scans";
  EXPECT_THAT(source->notes(),
              Contains(HasSubstr("/markers: 3 observations without a usable identity left out")));
}

std::string imu(double stamp_s, std::string_view frame, double w_radps) {
  Wire wire = with_header(stamp_s, frame);
  for (int i = 0; i < 4 + 9; ++i) wire.add(0.0);
  wire.add(w_radps).add(0.0).add(0.0);  // about its x axis
  for (int i = 0; i < 9 + 3 + 9; ++i) wire.add(0.0);
  return wire.bytes();
}

/// tf_static: an IMU whose x axis points up.
std::string imu_transform() {
  Wire wire(Encoding::kRos1);
  wire.add<std::uint32_t>(1).add<std::int32_t>(0).add<std::uint32_t>(0).text("base_link").text("upright");
  for (const double value : {0.0, 0.0, 0.2, 0.0, -std::sqrt(0.5), 0.0, std::sqrt(0.5)}) wire.add(value);
  return wire.bytes();
}

std::unique_ptr<MadeBag> bag_with_imus() {
  auto made = std::make_unique<MadeBag>();
  const auto frames = made->topic("/tf_static", "tf2_msgs/TFMessage");
  const auto speed = made->topic("/speed", "geometry_msgs/TwistStamped");
  const auto other = made->topic("/a_imu", "sensor_msgs/Imu");
  const auto mounted = made->topic("/imu", "sensor_msgs/Imu");
  made->add(frames, 0.0, imu_transform());
  made->add(speed, 1.0, twist(1.0, 0.5));
  for (int i = 0; i < 5; ++i) made->add(other, 1.0 + i, imu(1.0 + i, "somewhere", 9.0));
  made->add(mounted, 1.0, imu(1.0, "upright", 0.25));
  return made;
}

TEST(BagSource, TakesTheYawRateOfTheImuWhoseMountIsKnown) {
  const auto source = source_of(bag_with_imus());
  const auto rates = test::only<YawRate>(test::read_all(*source).events);
  ASSERT_EQ(rates.size(), 1U);
  EXPECT_NEAR(rates[0].second.w_radps, 0.25, 1e-12);
  EXPECT_THAT(source->notes(),
              Contains(HasSubstr("the gyro: /imu is used, not /a_imu; set input.imu_topic to change that")));
}

TEST(BagSource, TakesTheImuThatIsNamedOrNone) {
  const auto named = source_of(bag_with_imus(), {.imu_topic = "/a_imu"});
  EXPECT_EQ(test::only<YawRate>(test::read_all(*named).events).size(), 5U);
  EXPECT_THAT(named->notes(), Contains(HasSubstr("/a_imu: no tf_static has its frame on the robot")));
  const auto none = source_of(bag_with_imus(), {.imu_topic = "none"});
  EXPECT_TRUE(test::only<YawRate>(test::read_all(*none).events).empty());
}

std::string tag_corners(double stamp_s, std::initializer_list<std::pair<double, double>> corners) {
  Wire wire = with_header(stamp_s, "camera");
  wire.add<std::uint32_t>(1).text("tag25h9").add<std::int32_t>(17).add<std::int32_t>(0);
  wire.add<float>(0.0F).add<float>(50.0F).add(20.0).add(30.0);
  for (const auto& [x, y] : corners) wire.add(x).add(y);
  for (int i = 0; i < 9; ++i) wire.add(0.0);
  return wire.bytes();
}

TEST(BagSource, TakesTheCornersOfTagsWhereThereAreNoImages) {
  for (const bool camera_images : {false, true}) {
    auto made = std::make_unique<MadeBag>();
    const auto tags = made->topic("/detections", "apriltag_msgs/AprilTagDetectionArray");
    if (camera_images) {
      const auto images = made->topic("/image_rect", "sensor_msgs/Image");
      made->add(images, 1.0, mono(1.0, "camera", "mono8", 2, "abcd"));
    }
    // From the lower left, against the clock, as the type has them.
    made->add(tags, 1.0, tag_corners(1.0, {{10.5, 40.5}, {30.5, 41.5}, {31.5, 20.5}, {11.5, 19.5}}));
    const auto source = source_of(std::move(made));
    const auto outlines = test::only<MarkerOutlines>(test::read_all(*source).events);
    ASSERT_EQ(outlines.size(), camera_images ? 0U : 1U);
    if (camera_images) continue;
    EXPECT_EQ(outlines[0].second[0].id, 17);
    EXPECT_EQ(outlines[0].second[0].corners_px[0], Eigen::Vector2d(11.0, 19.0));
    EXPECT_EQ(outlines[0].second[0].corners_px[2], Eigen::Vector2d(30.0, 41.0));
    EXPECT_THAT(source->info().settings, Contains(std::pair<std::string, std::string>("observe", "markers")));
    EXPECT_THAT(source->info().settings,
                Contains(std::pair<std::string, std::string>("markers.dictionary", "apriltag_25h9")));
  }
}

/// Focal lengths of 100 px as the image is, and of 200 px when it is rectified.
std::string camera_info(double stamp_s) {
  Wire wire = with_header(stamp_s, "camera");
  wire.add<std::uint32_t>(480).add<std::uint32_t>(640).text("plumb_bob").add<std::uint32_t>(0);
  for (const double value : {100.0, 0.0, 320.0, 0.0, 100.0, 240.0, 0.0, 0.0, 1.0}) wire.add(value);  // K
  for (const double value : {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}) wire.add(value);          // R
  for (const double value : {200.0, 0.0, 320.0, 0.0, 0.0, 200.0, 240.0, 0.0, 0.0, 0.0, 1.0, 0.0})
    wire.add(value);
  for (int i = 0; i < 6; ++i) wire.add<std::uint32_t>(0);  // binning and region
  return wire.add<std::uint8_t>(0).bytes();
}

TEST(BagSource, TakesTheCornersOfFiducialsAsOfImagesWithDistortion) {
  for (const bool are_tags : {false, true}) {
    auto made = std::make_unique<MadeBag>();
    const auto camera = made->topic("/camera_info", "sensor_msgs/CameraInfo");
    made->add(camera, 1.0, camera_info(1.0));
    if (are_tags) {
      const auto tags = made->topic("/seen", "apriltag_msgs/AprilTagDetectionArray");
      made->add(tags, 1.0, tag_corners(1.0, {{10.5, 40.5}, {30.5, 41.5}, {31.5, 20.5}, {11.5, 19.5}}));
    } else {
      const auto fiducials = made->topic("/seen", "fiducial_msgs/FiducialArray");
      Wire wire = with_header(1.0, "camera");
      wire.add<std::int32_t>(1).add<std::uint32_t>(1).add<std::int32_t>(17).add<std::int32_t>(0);
      for (const double value : {11.0, 19.0, 31.0, 20.0, 30.0, 41.0, 10.0, 40.0}) wire.add(value);
      made->add(fiducials, 1.0, wire.bytes());
    }
    const auto source = source_of(std::move(made));
    EXPECT_THAT(source->info().settings,
                Contains(std::pair<std::string, std::string>("camera.fu_px", are_tags ? "200" : "100")));
    EXPECT_THAT(source->info().settings, Contains(std::pair<std::string, std::string>("observe", "markers")));
    const auto outlines = test::only<MarkerOutlines>(test::read_all(*source).events);
    ASSERT_EQ(outlines.size(), 1U);
    EXPECT_EQ(outlines[0].second[0].corners_px[0], Eigen::Vector2d(11.0, 19.0));
  }
}

TEST(BagSource, RefusesABagWithoutMessages) {
  EXPECT_EQ(make_bag_source(std::make_unique<MadeBag>(), "made.bag", {}).error().message,
            "made.bag: the bag holds no messages");
}

}  // namespace
}  // namespace waymark
