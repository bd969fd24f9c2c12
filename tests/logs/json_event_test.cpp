#include "workbench/logs/json_event.hpp"

#include <gtest/gtest.h>

namespace waymark {
namespace {

template <class Content>
Content read(const char* text) {
  const auto line = parse_json_event(text);
  EXPECT_TRUE(line.ok()) << text;
  return line ? std::get<Content>(line->content) : Content{};
}

TEST(JsonEvent, TellsEveryKindOfOdometry) {
  EXPECT_EQ(read<WheelAngles>(R"({"stamp_s":1,"left_rad":2,"right_rad":3.5})").right_rad, 3.5);
  EXPECT_EQ(read<Velocity>(R"({"v_mps":0.3,"w_radps":-0.1})").w_radps, -0.1);
  EXPECT_EQ(read<Steering>(R"({"v_mps":0.3,"steer_rad":0.2})").steer_rad, 0.2);
  EXPECT_EQ(read<OdometryPose>(R"({"x_m":1,"y_m":2,"theta_rad":3})").T_odom_robot, (Pose2{1, 2, 3}));
  EXPECT_EQ(read<YawRate>(R"({"w_radps":0.25})").w_radps, 0.25);
}

TEST(JsonEvent, TellsObservations) {
  const auto seen = read<Observations>(
      R"({"observations":[{"id":7,"range_m":2,"bearing_rad":0.5},{"bearing_rad":1},{"id":null,"range_m":3},
          {"id":2,"u_px":10,"v_px":20}]})");
  ASSERT_EQ(seen.size(), 4U);
  EXPECT_EQ(seen[0].id->number, 7);
  EXPECT_EQ(std::get<RangeBearing>(seen[0].value).range_m, 2.0);
  EXPECT_FALSE(seen[1].id);
  EXPECT_EQ(std::get<Bearing>(seen[1].value).bearing_rad, 1.0);
  EXPECT_EQ(std::get<Range>(seen[2].value).range_m, 3.0);
  EXPECT_EQ(std::get<Pixel>(seen[3].value).v_px, 20.0);
}

TEST(JsonEvent, KeepsAllDigitsOfAStamp) {
  const auto line = parse_json_event(R"({"stamp_s":"1700000000.123456789","w_radps":0})");
  ASSERT_TRUE(line.ok());
  EXPECT_EQ(to_string(*line->stamp), "1700000000.123456789");
  EXPECT_FALSE(parse_json_event(R"({"w_radps":0})")->stamp);
}

TEST(JsonEvent, ReadsWhatItWrites) {
  const Stamp stamp = stamp_from_seconds(12.25);
  for (const EventContent& content :
       {EventContent(WheelAngles{0.1, 0.2}), EventContent(Velocity{1.0, 2.0}), EventContent(YawRate{0.5}),
        EventContent(OdometryPose{{1.0, 2.0, 3.0}}),
        EventContent(Observations{{LandmarkId{LandmarkId::Family::kMarker, 4}, RangeBearing{1.5, -0.5}, {}},
                                  {std::nullopt, Bearing{0.5}, Eigen::Matrix2d::Identity()}})}) {
    const std::string text = to_json_event(stamp, content);
    const auto line = parse_json_event(text);
    ASSERT_TRUE(line.ok()) << text;
    EXPECT_EQ(line->stamp, stamp);
    EXPECT_EQ(to_json_event(*line->stamp, line->content), text);
  }
  EXPECT_EQ(to_json_event(stamp, Image{}), "");
}

TEST(JsonEvent, SaysWhatIsWrong) {
  const auto why = [](const std::string& text) {
    const auto line = parse_json_event(text);
    return line ? std::string("none") : line.error().message;
  };
  EXPECT_NE(why("{").find("JSON"), std::string::npos);
  EXPECT_NE(why("[1]").find("JSON"), std::string::npos);
  EXPECT_NE(why(R"({"stamp_s":"x","w_radps":0})").find("stamp_s"), std::string::npos);
  EXPECT_NE(why(R"({"left_rad":1})").find("left_rad and right_rad"), std::string::npos);
  EXPECT_NE(why(R"({"observations":[{"id":-1,"range_m":1}]})").find("id"), std::string::npos);
  EXPECT_NE(why(R"({"observations":[{"id":1}]})").find("range_m"), std::string::npos);
  EXPECT_NE(why(R"({"observations":7})").find("list"), std::string::npos);
  EXPECT_NE(why(std::string(70'000, '[')).find("longer"), std::string::npos);
  EXPECT_NE(why(R"({"observations":[{"range_m":1,"covariance":[1]}]})").find("covariance"),
            std::string::npos);
  EXPECT_NE(why(R"({"v_mps":1e999,"w_radps":0})"), "none");
}

}  // namespace
}  // namespace waymark
