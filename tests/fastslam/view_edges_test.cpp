#include "waymark/fastslam/view_edges.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "known_map.hpp"

namespace waymark::fastslam {
namespace {

constexpr LandmarkSensor kNarrowView{
    .max_range_m = 10.0, .field_of_view_deg = 90.0, .detection_probability = 0.95};
constexpr int kPatience = 3;  // 0.05^3 < 0.001

/// A robot that turns left by 0.1 rad before each scan, and a landmark that it saw at a range.
class ViewEdgesTest : public testing::Test {
 protected:
  ViewEdgesTest() { test::add_point(belief_, {4.0, 0.0}); }

  std::vector<ViewEdge> scan(ViewEdges& edges, const std::vector<Observation>& observations) {
    history_.move({0.0, 0.0, 0.1});
    history_.scan();
    belief_.landmarks.begin_scan();
    scan_.begin(observations);
    if (!observations.empty()) scan_.match(0, 0, belief_.landmarks);
    const auto found = edges.find(scan_, history_, belief_);
    if (!observations.empty()) belief_.observe(0, observations[0]);
    return {found.begin(), found.end()};
  }

  /// At which scan without it an edge is found; 0: at none of ten.
  int found_after(const LandmarkSensor& sensor, const Observation& last) {
    ViewEdges edges(SensorModel(sensor, 1.0));
    for (int i = 0; i < 8; ++i) (void)scan(edges, {last});
    for (int missed = 1; missed <= 10; ++missed)
      if (!scan(edges, {}).empty()) return missed;
    return 0;
  }

  Belief belief_{{.particles = 10}, {}, 1};
  ViewHistory history_{kNarrowView};
  Scan scan_;
};

TEST_F(ViewEdgesTest, ALandmarkThatStaysAwayHasLeftByAnEdge) {
  EXPECT_EQ(found_after(kNarrowView, test::range_alone(4.0)), kPatience);
}

TEST_F(ViewEdgesTest, NothingIsFoundWhereItMayHaveLeftOtherwise) {
  EXPECT_EQ(found_after(kNarrowView, test::range_alone(9.95)), 0);
  EXPECT_EQ(found_after(kNarrowView, test::range_bearing(4.0, 0.0)), 0);
}

TEST_F(ViewEdgesTest, NoEdgeIsBelievedOfASensorThatMissesOftenOrSeesAllRound) {
  LandmarkSensor blind = kNarrowView;
  blind.detection_probability = 0.7;
  EXPECT_EQ(found_after(blind, test::range_alone(4.0)), 0);
  LandmarkSensor round = kNarrowView;
  round.field_of_view_deg = 360.0;
  EXPECT_EQ(found_after(round, test::range_alone(4.0)), 0);
}

TEST_F(ViewEdgesTest, ALandmarkThatComesBackHasCrossedAnEdgeJustNow) {
  ViewEdges edges(SensorModel(kNarrowView, 1.0));
  for (int i = 0; i < 8; ++i) (void)scan(edges, {});
  const auto found = scan(edges, {test::range_alone(4.0)});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].landmark, 0);
  EXPECT_EQ(found[0].observation.seen.kind, kernels::ObservationKind::kViewEdge);
  // The sensor was half a step back.
  EXPECT_NEAR(found[0].observation.mount.sin_yaw, std::sin(-0.05), 1e-6);
  EXPECT_TRUE(scan(edges, {test::range_alone(4.0)}).empty());
}

}  // namespace
}  // namespace waymark::fastslam
