#include "waymark/fastslam/belief.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "support/matrix_near.hpp"

#include "known_map.hpp"

namespace waymark::fastslam {
namespace {

FastSlamOptions few() {
  FastSlamOptions options;
  options.particles = 20;
  return options;
}

const Motion kAhead{{1.0, 0.0, 0.1}, Eigen::Matrix3d(1e-4 * Eigen::Matrix3d::Identity())};

TEST(Belief, TheEstimateFollowsThePendingMotionUntilTheParticlesMakeIt) {
  Belief belief(few(), {}, 1);
  belief.predict(kAhead);
  EXPECT_EQ(belief.pose().T_world_robot, kAhead.increment);
  EXPECT_EQ(belief.particles.pose(3), Pose2{});
  belief.step({});
  EXPECT_TRUE(is_still(belief.pending));
  EXPECT_EQ(belief.pose().T_world_robot, kAhead.increment);
  EXPECT_NEAR(belief.particles.pose(3).x_m, 1.0, 0.1);
  belief.update_estimate();
  EXPECT_NE(belief.pose().T_world_robot, kAhead.increment);
}

TEST(Belief, EveryStepDrawsOtherNumbers) {
  Belief belief(few(), {}, 1);
  belief.predict(kAhead);
  belief.step({});
  const Pose2 first = belief.particles.pose(0);
  belief.predict(kAhead);
  belief.step({});
  EXPECT_GT(std::abs((first.inverse() * belief.particles.pose(0)).x_m - first.x_m), 1e-6);
}

TEST(Belief, AlsoTheRecordsOfTheLastLandmarkTakeThePlaceOfARemovedOne) {
  Belief belief(few(), {}, 1);
  for (int k = 0; k < 3; ++k) test::add_point(belief, {1.0 * k, 0.0});
  belief.records[2].existence_probability = 0.7;
  belief.remove(0);
  ASSERT_EQ(belief.store.size(), 2);
  ASSERT_EQ(belief.landmarks.size(), 2);
  ASSERT_EQ(belief.records.size(), 2U);
  EXPECT_EQ(belief.landmarks[0].id, test::marker(2));
  EXPECT_EQ(belief.records[0].existence_probability, 0.7);
  EXPECT_NEAR(belief.store.at(0, 5).mean.x(), 2.0, 1e-6);
}

TEST(Belief, RemembersARangeOnlyIfItWasAllThatWasMeasured) {
  Belief belief(few(), {}, 1);
  const int landmark = test::add_point(belief, {3.0, 0.0});
  belief.observe(landmark, test::range_alone(3.0));
  EXPECT_EQ(belief.records[0].range_alone_m, 3.0);
  belief.observe(landmark, test::range_bearing(3.0, 0.0));
  EXPECT_EQ(belief.records[0].range_alone_m, 0.0);
  EXPECT_EQ(belief.landmarks[0].observations, 3);
}

TEST(Belief, DoubtsOnlyWhatWasMetWithoutIdentity) {
  Belief belief(few(), {}, 1);
  test::add_point(belief, {3.0, 0.0});
  test::add_point(belief, {4.0, 0.0}, Identity::kUnknown);
  EXPECT_EQ(belief.records[0].existence_probability, 1.0);
  EXPECT_EQ(belief.records[1].existence_probability, 0.5);
  EXPECT_EQ(belief.store.existence(0), nullptr);
  EXPECT_NE(belief.store.existence(1), nullptr);
}

}  // namespace
}  // namespace waymark::fastslam
