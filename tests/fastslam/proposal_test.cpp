#include "waymark/fastslam/proposal.hpp"

#include <cmath>
#include <vector>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "support/matrix_near.hpp"
#include "support/poses.hpp"
#include "waymark/models/observation_models.hpp"

namespace waymark::fastslam {
namespace {

using test::matrix_near;

/// One landmark as a few particles see it.
struct OwnedColumns {
  OwnedColumns(int count, RandomStream& random)
      : rows(5, std::vector<double>(static_cast<std::size_t>(count))) {
    for (std::size_t i = 0; i < rows[0].size(); ++i) {
      const Eigen::Matrix2d P = test::random_covariance<2>(random, 0.01);
      rows[0][i] = random.uniform(2.0, 4.0);
      rows[1][i] = random.uniform(-1.0, 1.0);
      rows[2][i] = P(0, 0);
      rows[3][i] = P(0, 1);
      rows[4][i] = P(1, 1);
    }
  }
  [[nodiscard]] LandmarkColumns columns() {
    return {rows[0].data(), rows[1].data(), rows[2].data(), rows[3].data(), rows[4].data()};
  }
  std::vector<std::vector<double>> rows;
};

constexpr int kParticles = 5;

class ProposalTest : public testing::Test {
 protected:
  RandomStream random_{5, StreamPurpose::kWorld};
  ParticleBlocks blocks_{kParticles};
  Particles particles_{kParticles, Pose2{0.1, 0.2, 0.3}};
  Proposal proposal_{kParticles};
  OwnedColumns landmark_{kParticles, random_};
  Eigen::Matrix2d R_ = test::random_covariance<2>(random_, 1e-3);
  RangeBearing z_{2.8, -0.2};
  Pose2 T_robot_sensor_{0.1, -0.05, 0.2};
};

/// What one particle's proposal shows of itself: the mean, when it is drawn without spread, is the pose it is
/// drawn at.
TEST_F(ProposalTest, WithoutASightingItIsTheMotionModel) {
  const Motion exact{{0.5, 0.1, 0.2}, Eigen::Matrix3d::Zero()};
  proposal_.start(particles_, exact, blocks_);
  proposal_.sample(particles_, {1, StreamPurpose::kMotion, 0}, blocks_);
  const Pose2 expected = Pose2{0.1, 0.2, 0.3} * exact.increment;
  for (int i = 0; i < kParticles; ++i)
    EXPECT_TRUE(matrix_near(test::to_vector(particles_.pose(i)), test::to_vector(expected), 1e-12));
}

TEST_F(ProposalTest, ARobotThatStandsStillIsNotMovedAndWeighsAsIn1_0) {
  proposal_.start(particles_, Motion{}, blocks_);
  proposal_.condition(z_, R_, T_robot_sensor_, particles_, landmark_.columns(), blocks_);
  proposal_.accept(particles_, 1.0);
  proposal_.sample(particles_, {1, StreamPurpose::kMotion, 0}, blocks_);
  for (int i = 0; i < kParticles; ++i) {
    const auto m = landmark_.columns().at(static_cast<std::size_t>(i));
    const auto [predicted, Hx, Hm] =
        RangeBearingModel::linearize(Pose2{0.1, 0.2, 0.3}, T_robot_sensor_, {m.x, m.y});
    const Eigen::Matrix2d Z = Hm * Eigen::Matrix2d{{m.xx, m.xy}, {m.xy, m.yy}} * Hm.transpose() + R_;
    const Eigen::Vector2d nu = RangeBearingModel::innovation(z_, predicted);
    const double log_likelihood = -0.5 * (nu.dot(Z.inverse() * nu) + std::log(Z.determinant()));
    EXPECT_NEAR(particles_.log_weight[static_cast<std::size_t>(i)], log_likelihood,
                1e-10 * std::abs(log_likelihood));
    EXPECT_TRUE(matrix_near(test::to_vector(particles_.pose(i)), Eigen::Vector3d(0.1, 0.2, 0.3), 1e-12));
  }
}

/// Draws many times from one proposal; its moments must be those of the information form
/// P = (Hx^T Z^-1 Hx + P0^-1)^-1, mu = mu0 + P Hx^T Z^-1 nu.
TEST(Proposal, HasTheMomentsOfTheInformationForm) {
  constexpr int kDraws = 40000;
  RandomStream random(6, StreamPurpose::kWorld);
  ParticleBlocks blocks(kDraws);
  const Pose2 start{0.1, 0.2, 0.3};
  Particles particles(kDraws, start);
  Proposal proposal(kDraws);
  OwnedColumns landmark(kDraws, random);
  for (auto& row : landmark.rows) std::fill(row.begin(), row.end(), row[0]);
  const Motion motion{{0.5, 0.0, 0.1}, test::random_covariance<3>(random, 1e-3)};
  const Eigen::Matrix2d R = test::random_covariance<2>(random, 1e-3);
  const RangeBearing z{2.4, -0.15};

  proposal.start(particles, motion, blocks);
  proposal.condition(z, R, Pose2{}, particles, landmark.columns(), blocks);
  proposal.accept(particles, 1.0);
  proposal.sample(particles, {9, StreamPurpose::kMotion, 4}, blocks);

  const PoseEstimate prior = propagate({start, Eigen::Matrix3d::Zero()}, motion);
  const auto m = landmark.columns().at(0);
  const auto [predicted, Hx, Hm] = RangeBearingModel::linearize(prior.T_world_robot, Pose2{}, {m.x, m.y});
  const Eigen::Matrix2d Z = Hm * Eigen::Matrix2d{{m.xx, m.xy}, {m.xy, m.yy}} * Hm.transpose() + R;
  const Eigen::Matrix3d P = (Hx.transpose() * Z.inverse() * Hx + prior.covariance.inverse()).inverse();
  const Eigen::Vector3d mu = test::to_vector(prior.T_world_robot) +
                             P * Hx.transpose() * Z.inverse() * RangeBearingModel::innovation(z, predicted);

  make_weights_equal(particles);
  const PoseEstimate drawn = estimate(particles, blocks);
  // Five standard errors of a mean and of a variance over so many draws.
  const double scale = std::sqrt(P.diagonal().maxCoeff());
  EXPECT_TRUE(matrix_near(test::to_vector(drawn.T_world_robot), mu, 5.0 * scale / std::sqrt(1.0 * kDraws)));
  EXPECT_TRUE(matrix_near(drawn.covariance, P, 5.0 * std::sqrt(2.0 / kDraws) * P.diagonal().maxCoeff()));
}

TEST_F(ProposalTest, ASightingThatIsNotAcceptedLeavesNoTrace) {
  const Motion motion{{0.5, 0.1, 0.2}, 1e-3 * Eigen::Matrix3d::Identity()};
  Particles untouched(kParticles, Pose2{0.1, 0.2, 0.3});
  Proposal other(kParticles);
  other.start(untouched, motion, blocks_);
  other.sample(untouched, {1, StreamPurpose::kMotion, 0}, blocks_);
  proposal_.start(particles_, motion, blocks_);
  proposal_.condition(z_, R_, T_robot_sensor_, particles_, landmark_.columns(), blocks_);
  proposal_.sample(particles_, {1, StreamPurpose::kMotion, 0}, blocks_);
  for (int i = 0; i < kParticles; ++i) EXPECT_EQ(particles_.pose(i), untouched.pose(i));
}

}  // namespace
}  // namespace waymark::fastslam
