#include "waymark/ekf/recall.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "support/matrix_near.hpp"
#include "waymark/core/random.hpp"

#include "random_observations.hpp"

namespace waymark::ekf {
namespace {

using test::matrix_near;

/// Four landmarks, the last of which is left out of the submap while the others are observed.
class RecallTest : public testing::TestWithParam<int> {
 protected:
  static constexpr int kLandmarks = 4;
  static constexpr int kLeft = 3;

  RecallTest()
      : whole_(GetParam(), kLandmarks, Consistency::kFej, 1, 1),
        active_(GetParam(), kLandmarks, Consistency::kFej, 1, 1),
        since_(whole_.offset(kLandmarks)),
        passive_(GetParam(), whole_.layout().head, kLandmarks, kLandmarks, false),
        recall_(active_, since_, passive_, members_, whole_.offset(kLandmarks)) {
    for (State* state : {&whole_, &active_}) {
      RandomStream same(1, StreamPurpose::kWorld);
      state->propagate_bias(0, 0.0);
      state->predict(test::random_motion(same));
      for (int i = 0; i < kLandmarks; ++i)
        state->add({same.normal(), same.normal(), 0.0}, Eigen::Matrix3d::Identity(),
                   test::random_covariance<3>(same, 0.1));
      (void)state->propagate_cross_covariance();
    }
    for (int slot = 0; slot < kLandmarks; ++slot) passive_.clear(slot);
    passive_.close(members_, active_, nullptr);
    active_.remove(kLeft);
    members_.pop_back();
    since_.restart(active_.size());
    for (int i = 0; i < 5; ++i) step(i % kLeft);
    const Motion last = test::random_motion(random_);  // of which the rows of the landmarks are still due
    for (State* state : {&whole_, &active_}) state->predict(last);
  }

  void step(int landmark) {
    const Motion motion = test::random_motion(random_);
    const std::vector<LinearizedObservation> seen{test::random_observation(random_, landmark, GetParam(), 1)};
    whole_.predict(motion);
    active_.predict(motion);
    since_.carry(active_.propagate_cross_covariance());
    since_.project(seen, active_.layout());
    EXPECT_TRUE(whole_.update(seen) && active_.update(seen));
    since_.absorb(active_.gain());
  }

  RandomStream random_{2, StreamPurpose::kWorld};
  State whole_;
  State active_;
  CompressedTerms since_;
  PassiveSubmap passive_;
  std::vector<int> members_{0, 1, 2, 3};
  Recall recall_;
};

TEST_P(RecallTest, IsWhatTheWholeStateSays) {
  const Recall::Landmark now = recall_.landmark(kLeft);
  EXPECT_TRUE(matrix_near(now.position, whole_.landmark(kLeft), 1e-12));
  EXPECT_TRUE(matrix_near(now.covariance, whole_.landmark_covariance(kLeft), 1e-12));
  const Eigen::MatrixXd P = test::whole_covariance(whole_);
  EXPECT_TRUE(matrix_near(now.cross, P.topRightCorner(P.rows() - GetParam(), GetParam()), 1e-12));
  EXPECT_TRUE(matrix_near(recall_.position(kLeft), whole_.landmark(kLeft), 1e-12));
}

TEST_P(RecallTest, JudgesAnObservationAsTheWholeStateDoes) {
  const LinearizedObservation linearization = test::random_observation(random_, kLeft, GetParam(), 1);
  EXPECT_TRUE(matrix_near(recall_.innovation_covariance(kLeft, linearization),
                          whole_.innovation_covariance(linearization), 1e-12));
  EXPECT_TRUE(matrix_near(recall_.pose_correlation(kLeft, linearization),
                          whole_.pose_correlation(linearization), 1e-12));
}

INSTANTIATE_TEST_SUITE_P(Dimensions, RecallTest, testing::Values(2, 3));

}  // namespace
}  // namespace waymark::ekf
