#include "waymark/fastslam/scan_update.hpp"

#include <gtest/gtest.h>

#include "waymark/fastslam/sensor_model.hpp"

#include "known_map.hpp"

namespace waymark::fastslam {
namespace {

/// Particles spread along x that all know a landmark 4 m ahead.
class ScanUpdateTest : public testing::Test {
 protected:
  ScanUpdateTest() {
    test::add_point(belief_, {4.0, 0.0});
    for (int i = 0; i < belief_.particles.count(); ++i)
      belief_.particles.set_pose(i, {0.01 * (i - 50), 0.0, 0.0});
  }

  void accept(double power) {
    belief_.load_sample();
    const kernels::LandmarkObservation observation =
        model_.landmark_observation(test::range_bearing(3.8, 0.0), 0, belief_);
    update_.accept(observation, 0, power, belief_.compare(observation), belief_);
  }

  Belief belief_{{.particles = 101}, {}, 1};
  SensorModel model_{{}, 1.0};
  ScanUpdate update_{{}, belief_.blocks};
};

TEST_F(ScanUpdateTest, WhatParticlesDisagreeOnMovesThemAndDoesNotWeighThem) {
  belief_.landmarks.travel(1.0);
  accept(0.6);
  EXPECT_EQ(update_.enkf_updates(), 1);
  EXPECT_GT(belief_.particles.pose(50).x_m, 0.1);
  ASSERT_EQ(update_.accepted().size(), 1U);
  EXPECT_EQ(update_.accepted()[0].exponent, 0.0);
}

TEST_F(ScanUpdateTest, ARobotThatHasStoodIsNotMoved) {
  accept(0.6);
  EXPECT_EQ(update_.enkf_updates(), 0);
  EXPECT_EQ(update_.accepted()[0].exponent, 0.6);
}

TEST_F(ScanUpdateTest, WhatBringsHardlyAnyNewsMovesNothing) {
  belief_.landmarks.travel(1.0);
  accept(0.05);
  EXPECT_EQ(update_.enkf_updates(), 0);
  EXPECT_EQ(update_.accepted()[0].exponent, 0.05);
}

TEST_F(ScanUpdateTest, WhatSomeParticlesTakeMovesNone) {
  belief_.landmarks.travel(1.0);
  const float takers[101] = {};
  update_.accept_by(takers, model_.landmark_observation(test::range_bearing(3.8, 0.0), 0, belief_), 0.6);
  EXPECT_EQ(update_.enkf_updates(), 0);
  EXPECT_EQ(update_.accepted()[0].takers, takers);
  update_.begin();
  EXPECT_TRUE(update_.accepted().empty());
}

TEST_F(ScanUpdateTest, AnObservationShapesTheMotionInFastSlam2Alone) {
  accept(0.6);
  EXPECT_TRUE(update_.accepted()[0].shapes_motion);
  ScanUpdate first({.proposal = ProposalKind::kMotion}, belief_.blocks);
  first.accept_by(nullptr, model_.landmark_observation(test::range_bearing(3.8, 0.0), 0, belief_), 0.6);
  EXPECT_FALSE(first.accepted()[0].shapes_motion);
}

}  // namespace
}  // namespace waymark::fastslam
