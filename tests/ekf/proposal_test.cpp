#include "waymark/ekf/proposal.hpp"

#include <utility>

#include <gtest/gtest.h>

#include "support/matrix_near.hpp"
#include "waymark/core/random.hpp"
#include "waymark/ekf/state.hpp"

#include "random_observations.hpp"

namespace waymark::ekf {
namespace {

using test::matrix_near;
using test::random_observation;

/// Two landmarks, a pair of errors, and an update that is proposed.
class ProposalTest : public testing::TestWithParam<Consistency> {
 protected:
  ProposalTest() : state_(2, 2, GetParam(), 1, 1) {
    state_.propagate_bias(0, 0.0);
    state_.predict({{1.0, 0.2, 0.3}, test::random_covariance<3>(random_, 0.1)});
    for (int i = 0; i < 2; ++i)
      state_.add({2.0, 3.0 * i, 0.0}, Eigen::Matrix3d::Identity(), test::random_covariance<3>(random_, 0.1));
    const LinearizedObservation linearization = random_observation(random_, 0, 2, 1);
    EXPECT_TRUE(state_.propose({&linearization, 1}));
  }

  RandomStream random_{1, StreamPurpose::kWorld};
  State state_;
};

TEST_P(ProposalTest, IsWhereTheUpdateLeads) {
  const Proposal proposal = state_.proposal();
  BiasTerms terms;
  terms[0].pair = 0;
  terms[0].J.topRows<2>().setIdentity();
  const Pose2 pose = proposal.pose();
  const Eigen::Vector3d landmark = proposal.landmark(1);
  const Eigen::Vector2d errors = proposal.expected(terms);
  EXPECT_NE(pose, state_.pose().T_world_robot);
  state_.accept();
  EXPECT_EQ(pose, state_.pose().T_world_robot);
  EXPECT_TRUE(matrix_near(landmark, state_.landmark(1), 1e-14));
  EXPECT_TRUE(matrix_near(errors, state_.biases(0), 1e-14));
}

TEST_P(ProposalTest, AddsToAnInnovationWhatItExplains) {
  const LinearizedObservation there = random_observation(random_, 1, 2, 1);
  const LinearizedObservation back = state_.proposal().relinearized_to_prior(there);
  EXPECT_TRUE(matrix_near(back.nu, Eigen::Vector2d(there.nu + state_.proposal().explained(back)), 1e-14));
  EXPECT_EQ(back.H_landmark, there.H_landmark);
  EXPECT_EQ(back.H_pose == there.H_pose, GetParam() != Consistency::kInvariant);
}

TEST_P(ProposalTest, OfACompressedMapGoesByTheIndicesOfTheMap) {
  Slots map(2, 2);
  for (const int slot : {0, 1}) map.append(slot);
  for (const int slot : {1, 0}) map.enter(slot);  // landmark 0 of the map is landmark 1 of the state
  const Proposal local = state_.proposal();
  const Proposal proposal = local.with_indices_of(map);
  EXPECT_EQ(proposal.pose(), local.pose());
  EXPECT_EQ(proposal.landmark(0), local.landmark(1));
  LinearizedObservation there = random_observation(random_, 1, 2, 1);
  there.anchor = 0;
  const LinearizedObservation expected = local.relinearized_to_prior(there);
  std::swap(there.landmark, there.anchor);
  const LinearizedObservation back = proposal.relinearized_to_prior(there);
  EXPECT_EQ(back.landmark, 0);
  EXPECT_EQ(back.anchor, 1);
  EXPECT_EQ(back.nu, expected.nu);
  EXPECT_EQ(back.H_pose, expected.H_pose);
}

INSTANTIATE_TEST_SUITE_P(AllModes, ProposalTest,
                         testing::Values(Consistency::kStandard, Consistency::kFej, Consistency::kInvariant));

using InvariantProposalTest = ProposalTest;

/// An observation where it is proposed to be, which does not see a turn of everything about the origin, does
/// not see it either when it is moved back to where the invariant state still is.
TEST_P(InvariantProposalTest, MovesBackWhatDoesNotSeeTheWorldTurn) {
  const auto seen_of_a_turn = [](const LinearizedObservation& s, const Pose2& robot,
                                 const Eigen::Vector3d& landmark) {
    const Eigen::Vector2d moved = perpendicular(robot.position());
    return Eigen::Vector2d(s.H_pose * Eigen::Vector3d(moved.x(), moved.y(), 1.0) +
                           s.H_landmark.leftCols<2>() * perpendicular(landmark.head<2>()));
  };
  const Proposal proposal = state_.proposal();
  LinearizedObservation there = random_observation(random_, 1, 2);
  there.H_pose.col(2) -= seen_of_a_turn(there, proposal.pose(), proposal.landmark(1));
  const LinearizedObservation back = proposal.relinearized_to_prior(there);
  EXPECT_TRUE(matrix_near(seen_of_a_turn(back, state_.pose().T_world_robot, state_.landmark(1)),
                          Eigen::Vector2d(0.0, 0.0), 1e-13));
}

INSTANTIATE_TEST_SUITE_P(Invariant, InvariantProposalTest, testing::Values(Consistency::kInvariant));

}  // namespace
}  // namespace waymark::ekf
