#include "workbench/eval/associate.hpp"

#include <gtest/gtest.h>

#include "eval/eval_support.hpp"

namespace waymark::eval {
namespace {

using test::straight_path;
using test::truth_at;

TEST(Associate, PairsEveryTruthStampInsideTheRun) {
  const TruthTrack truth({truth_at(-0.5, 0, 0), truth_at(0, 0, 0), truth_at(2.25, 0, 0), truth_at(9, 0, 0),
                          truth_at(9.5, 0, 0)});
  const auto pairs = associate(straight_path(10), truth);
  ASSERT_EQ(pairs.size(), 3u);
  EXPECT_DOUBLE_EQ(pairs[0].estimate.x_m, 0.0);
  EXPECT_DOUBLE_EQ(pairs[1].estimate.x_m, 2.25);
  EXPECT_DOUBLE_EQ(pairs[2].estimate.x_m, 9.0);
}

TEST(Associate, InterpolatesHeadingThroughPi) {
  const Trajectory estimate{{stamp_from_seconds(0), {0, 0, 3.0}, {}},
                            {stamp_from_seconds(1), {0, 0, -3.0}, {}}};
  const auto pairs = associate(estimate, TruthTrack({truth_at(0.5, 0, 0)}));
  ASSERT_EQ(pairs.size(), 1u);
  EXPECT_NEAR(std::abs(pairs[0].estimate.theta_rad), kPi, 1e-12);
}

TEST(Associate, RefusesHolesOfTheEstimate) {
  const Trajectory estimate{{stamp_from_seconds(0), {}, {}}, {stamp_from_seconds(3), {}, {}}};
  const TruthTrack truth({truth_at(0, 0, 0), truth_at(1, 0, 0), truth_at(3, 0, 0)});
  EXPECT_EQ(associate(estimate, truth).size(), 2u);
  EXPECT_EQ(associate(estimate, truth, {.max_gap = std::chrono::seconds(3)}).size(), 3u);
}

TEST(Associate, TakesTheLastOfEqualStampsAndTheEarlierCovariance) {
  const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
  const Trajectory estimate{{stamp_from_seconds(0), {1, 0, 0}, I},
                            {stamp_from_seconds(0), {2, 0, 0}, 2.0 * I},
                            {stamp_from_seconds(1), {4, 0, 0}, 3.0 * I}};
  const auto pairs = associate(estimate, TruthTrack({truth_at(0, 0, 0), truth_at(0.5, 0, 0)}));
  ASSERT_EQ(pairs.size(), 2u);
  EXPECT_DOUBLE_EQ(pairs[0].estimate.x_m, 2.0);
  EXPECT_DOUBLE_EQ(pairs[1].estimate.x_m, 3.0);
  EXPECT_EQ(*pairs[1].covariance, 2.0 * I);
}

TEST(Associate, MovesPoseAndCovarianceToTheTruthSensor) {
  const Eigen::Matrix3d P = Eigen::Vector3d(0.0, 0.0, 0.01).asDiagonal();
  const Trajectory estimate{{stamp_from_seconds(0), {1, 1, kPi / 2}, P}};
  const auto pairs = associate(estimate, TruthTrack({truth_at(0, 0, 0)}), {.truth_sensor_m = {2.0, 0.0}});
  ASSERT_EQ(pairs.size(), 1u);
  EXPECT_NEAR(pairs[0].estimate.x_m, 1.0, 1e-12);
  EXPECT_NEAR(pairs[0].estimate.y_m, 3.0, 1e-12);
  // A turn moves a point two metres ahead of a robot that faces y by -2 m per radian in x.
  const Eigen::Vector3d arm(-2.0, 0.0, 1.0);
  EXPECT_TRUE(pairs[0].covariance->isApprox(0.01 * arm * arm.transpose(), 1e-12));
}

TEST(Associate, EmptyInputsGiveNoPairs) {
  EXPECT_TRUE(associate({}, TruthTrack({truth_at(0, 0, 0)})).empty());
  EXPECT_TRUE(associate(straight_path(3), TruthTrack()).empty());
}

}  // namespace
}  // namespace waymark::eval
