#include "workbench/live/monitor_state.hpp"

#include <numbers>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace waymark::live {
namespace {

TEST(MonitorState, TellsEllipsesByTheirAxes) {
  MonitorState state;
  Eigen::Matrix3d P = Eigen::Matrix3d::Zero();
  P.topLeftCorner<2, 2>() << 0.05, 0.03, 0.03, 0.05;  // 0.08 along 45 degrees, 0.02 across
  P(2, 2) = 1e-4;
  state.pose = StampedPose{stamp_from_seconds(1.0), {{1.0004, 2.0, 0.5}, P}};
  const std::vector<LandmarkEstimate> landmarks{
      {{LandmarkId::Family::kMarker, 7}, {3.0, 4.0, 0.0}, P, 5, std::nullopt}};
  state.landmarks = &landmarks;
  const auto json = nlohmann::json::parse(to_json(state));
  EXPECT_EQ(json["light"], "good");
  EXPECT_NEAR(json["pose"]["x_m"].get<double>(), 1.0, 1e-12);
  EXPECT_NEAR(json["pose"]["ellipse"][0].get<double>(), std::sqrt(0.08), 1e-3);
  EXPECT_NEAR(json["pose"]["ellipse"][1].get<double>(), std::sqrt(0.02), 1e-3);
  EXPECT_NEAR(json["pose"]["ellipse"][2].get<double>(), std::numbers::pi / 4.0, 1e-3);
  EXPECT_NEAR(json["pose"]["heading_sigma_deg"].get<double>(), 0.57, 1e-9);
  EXPECT_EQ(json["landmarks"][0][0], 7);
  EXPECT_NEAR(json["landmarks"][0][3].get<double>(), std::sqrt(0.08), 1e-3);
}

TEST(MonitorState, LeavesOutWhatIsNotKnown) {
  const auto json = nlohmann::json::parse(to_json(MonitorState{}));
  EXPECT_FALSE(json.contains("pose"));
  EXPECT_FALSE(json.contains("landmarks"));
  EXPECT_FALSE(json.contains("free_mb"));
}

TEST(Trail, KeepsTheWholeWayInFewPoints) {
  Trail trail;
  for (int i = 0; i < 100'000; ++i) trail.add({0.01 * i, 0.0, 0.0});
  const auto points = nlohmann::json::parse(trail.to_json());
  EXPECT_LE(points.size(), Trail::kMost);
  EXPECT_GE(points.size(), Trail::kMost / 2);
  EXPECT_EQ(points.front()[0], 0.0);
  EXPECT_GT(points.back()[0].get<double>(), 990.0);
}

}  // namespace
}  // namespace waymark::live
