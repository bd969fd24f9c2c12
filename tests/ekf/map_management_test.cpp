#include "waymark/ekf/map_management.hpp"

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "support/poses.hpp"

namespace waymark::ekf {
namespace {

/// An observation of a landmark that is known to `landmark_sigma_m`, from a pose known to about `pose_scale`.
PoseObservation make_observation(RandomStream& random, double pose_scale = 0.1,
                                 double landmark_sigma_m = 0.1) {
  PoseObservation observation;
  observation.P_pose = test::random_covariance<3>(random, pose_scale);
  Eigen::Matrix<double, 2, 3> H_pose;
  for (auto& entry : H_pose.reshaped()) entry = random.normal();
  observation.C_pose = observation.P_pose * H_pose.transpose();
  observation.S = H_pose * observation.C_pose +
                  (0.01 + landmark_sigma_m * landmark_sigma_m) * Eigen::Matrix2d::Identity();
  return observation;
}

TEST(InformationGain, IsTheLogRatioOfTheDeterminantsOfThePoseCovariance) {
  RandomStream random(1, StreamPurpose::kWorld);
  for (int i = 0; i < 100; ++i) {
    const PoseObservation s = make_observation(random);
    const Eigen::Matrix3d after = s.P_pose - s.C_pose * s.S.inverse() * s.C_pose.transpose();
    EXPECT_NEAR(information_gain(s), 0.5 * std::log(s.P_pose.determinant() / after.determinant()), 1e-6);
  }
}

TEST(InformationGain, IsZeroWhereNothingCanBeLearned) {
  RandomStream random(2, StreamPurpose::kWorld);
  PoseObservation s = make_observation(random);
  s.C_pose.setZero();
  EXPECT_EQ(information_gain(s), 0.0);
  s = make_observation(random);
  s.P_pose.setZero();
  s.C_pose.setZero();
  EXPECT_EQ(information_gain(s), 0.0);
  s.S.setConstant(std::nan(""));
  EXPECT_EQ(information_gain(s), 0.0);
}

TEST(InformationGain, GrowsWithHowWellTheLandmarkIsKnown) {
  RandomStream random(3, StreamPurpose::kWorld);
  RandomStream same(3, StreamPurpose::kWorld);
  EXPECT_GT(information_gain(make_observation(random, 0.1, 0.01)),
            information_gain(make_observation(same, 0.1, 1.0)));
}

TEST(MapManagement, EvictsTheLandmarkThatTellsLeast) {
  RandomStream random(5, StreamPurpose::kWorld);
  MapManagement management(3);
  management.begin_scan();
  for (int i = 0; i < 3; ++i) management.added();
  for (int i = 0; i < 3; ++i) {
    RandomStream same = random;
    management.matched(i, make_observation(same, 0.1, i == 1 ? 3.0 : 0.05));
  }
  EXPECT_FALSE(management.least_useful()) << "all were seen in this scan";
  management.begin_scan();
  EXPECT_EQ(management.least_useful(), 1);
}

TEST(MapManagement, ALandmarkThatIsOftenOutsideItsGateCountsLess) {
  RandomStream random(6, StreamPurpose::kWorld);
  const PoseObservation observation = make_observation(random);
  MapManagement management(2);
  for (int i = 0; i < 2; ++i) management.added();
  for (int i = 0; i < 2; ++i) management.matched(i, observation);
  management.missed(1);
  management.begin_scan();
  EXPECT_EQ(management.least_useful(), 1);
}

TEST(MapManagement, FollowsTheIndicesOfTheState) {
  RandomStream random(7, StreamPurpose::kWorld);
  MapManagement management(3);
  for (int i = 0; i < 3; ++i) management.added();
  management.matched(1, make_observation(random));
  management.removed(0);  // landmark 2, never matched again, is now 0
  management.begin_scan();
  EXPECT_EQ(management.least_useful(), 0);
}

}  // namespace
}  // namespace waymark::ekf
