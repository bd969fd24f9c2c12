#include "waymark/ekf/belief.hpp"

#include <gtest/gtest.h>

#include "support/matrix_near.hpp"
#include "waymark/core/random.hpp"

#include "random_observations.hpp"

namespace waymark::ekf {
namespace {

using test::matrix_near;
using test::random_motion;
using test::random_observation;
using test::small_map;

TEST(Belief, MarginalsAreBlocksOfTheWholeCovariance) {
  RandomStream random(3, StreamPurpose::kWorld);
  const auto made = small_map(random, 5);
  State& state = *made;
  state.predict(random_motion(random));  // leaves a pending prediction of the robot's rows
  const Eigen::MatrixXd P = state.covariance();
  EXPECT_TRUE(matrix_near(state.pose().covariance, P.topLeftCorner<3, 3>(), 0.0));
  for (int i = 0; i < 5; ++i)
    EXPECT_TRUE(matrix_near(state.landmark_covariance(i).topLeftCorner<2, 2>(),
                            P.block(3 + 2 * i, 3 + 2 * i, 2, 2), 0.0));
}

TEST(Belief, InnovationCovarianceOfOneObservationIsTheDenseFormula) {
  RandomStream random(4, StreamPurpose::kWorld);
  const auto made = small_map(random, 5);
  State& state = *made;
  state.predict(random_motion(random));
  const LinearizedObservation s = random_observation(random, 3, 2);
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(2, 13);
  H.leftCols<3>() = s.H_pose;
  H.middleCols<2>(9) = s.H_landmark.leftCols<2>();
  const Eigen::Matrix2d S = H * state.covariance() * H.transpose() + s.R;
  EXPECT_TRUE(matrix_near(state.innovation_covariance(s), S, 1e-14));
  const Eigen::MatrixXd C = state.covariance().topRows<3>() * H.transpose();
  EXPECT_TRUE(matrix_near(state.pose_correlation(s), C, 1e-14));
}

TEST(Belief, ObservationsHaveInCommonWhatTheDenseFormulaSays) {
  RandomStream random(5, StreamPurpose::kWorld);
  const auto made = small_map(random, 5);
  made->predict(random_motion(random));
  const LinearizedObservation a = random_observation(random, 3, 2);
  const LinearizedObservation b = random_observation(random, 1, 2);
  const StateLayout& layout = made->layout();
  const Eigen::MatrixXd expected = test::dense(layout.jacobian(a, 2), made->size()) * made->covariance() *
                                   test::dense(layout.jacobian(b, 2), made->size()).transpose();
  EXPECT_TRUE(matrix_near(made->common_covariance(a, b), expected, 1e-14));
}

TEST(Belief, LinearizesAtTheFirstEstimatesOnlyWhereAsked) {
  for (const Consistency mode : {Consistency::kStandard, Consistency::kInvariant, Consistency::kFej}) {
    RandomStream random(2, StreamPurpose::kWorld);
    State state(2, 1, mode);
    state.predict({{1.0, 0.0, 0.1}, 0.1 * Eigen::Matrix3d::Identity()});
    const Pose2 predicted = state.pose().T_world_robot;
    const Eigen::Vector3d first(3.0, 4.0, 0.0);
    state.add(first, Eigen::Matrix3d::Identity(), Eigen::Matrix3d::Identity());
    const LinearizedObservation linearized = random_observation(random, 0, 2);
    ASSERT_TRUE(state.update({&linearized, 1}));
    ASSERT_NE(state.pose().T_world_robot, predicted);
    const bool at_first = mode == Consistency::kFej;
    EXPECT_EQ(state.linearization_pose(), at_first ? predicted : state.pose().T_world_robot);
    EXPECT_EQ(state.linearization_landmark(0), at_first ? first : state.landmark(0));
    EXPECT_EQ(state.first_estimate(0), first);
  }
}

}  // namespace
}  // namespace waymark::ekf
