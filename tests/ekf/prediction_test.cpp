#include "waymark/ekf/prediction.hpp"

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "support/matrix_near.hpp"
#include "waymark/core/random.hpp"
#include "waymark/ekf/state.hpp"

#include "random_observations.hpp"

namespace waymark::ekf {
namespace {

using test::matrix_near;

/// F P F^T + G Q G^T as core/motion.hpp has it for a pose alone.
TEST(Prediction, OfAPoseIsItsPropagation) {
  RandomStream random(1, StreamPurpose::kWorld);
  Covariance P(3, 3);
  const Eigen::Matrix3d before = test::random_covariance<3>(random, 0.1);
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = i; j < 3; ++j) P.row(i)[j] = before(static_cast<int>(i), static_cast<int>(j));
  const Pose2 here{1.0, 2.0, 0.5};
  const Motion motion = test::random_motion(random);
  const Prediction prediction(here, here, motion.increment);
  prediction.apply(P, motion.covariance);
  const PoseEstimate expected = propagate({here, before}, motion);
  EXPECT_EQ(prediction.pose(), expected.T_world_robot);
  EXPECT_TRUE(matrix_near(P.block<3>(0), expected.covariance, 1e-15));
}

/// The covariance after a motion that depends on biases is F P F^T + G Q G^T of the whole state, by
/// plain matrices.
TEST(Prediction, SpreadsBiasesAsPlainMatricesDo) {
  RandomStream random(7, StreamPurpose::kWorld);
  State state(2, 4, Consistency::kStandard, 1, 2);
  for (int pair = 0; pair < 2; ++pair) state.propagate_bias(pair, 0.0);
  const auto random_terms = [&random] {
    BiasTerms terms;
    for (int pair = 0; pair < 2; ++pair) {
      terms[static_cast<std::size_t>(pair)].pair = pair;
      for (auto& entry : terms[static_cast<std::size_t>(pair)].J.reshaped()) entry = 0.1 * random.normal();
    }
    return terms;
  };
  for (int step = 0; step < 10; ++step) {
    const Eigen::MatrixXd before = test::whole_covariance(state);
    const Pose2 from = state.pose().T_world_robot;
    const Motion motion{{0.2, 0.01, 0.1 * random.normal()}, 1e-4 * Eigen::Matrix3d::Identity()};
    const BiasTerms terms = random_terms();
    state.predict(motion, terms);
    const auto n = before.rows();
    Eigen::MatrixXd F = Eigen::MatrixXd::Identity(n, n);
    F.topLeftCorner<3, 3>() = compose_jacobian_left(from, motion.increment);
    const Eigen::Matrix3d G = compose_jacobian_right(from);
    for (int pair = 0; pair < 2; ++pair)
      F.block<3, 2>(0, 3 + 2 * pair) = G * terms[static_cast<std::size_t>(pair)].J;
    Eigen::MatrixXd after = F * before * F.transpose();
    after.topLeftCorner<3, 3>() += G * motion.covariance * G.transpose();
    EXPECT_TRUE(matrix_near(test::whole_covariance(state), after, 1e-12)) << step;
    if (step < 3) {
      Eigen::Matrix3d G_pose = Eigen::Matrix3d::Zero();
      G_pose.topLeftCorner<2, 2>().setIdentity();
      state.add({1.0, step * 1.0, 0.0}, G_pose, 0.01 * Eigen::Matrix3d::Identity());
    }
  }
}

}  // namespace
}  // namespace waymark::ekf
