#include "waymark/ekf/iterated_update.hpp"

#include <cmath>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "support/allocation_counter.hpp"
#include "waymark/ekf/compressed_state.hpp"

namespace waymark::ekf {
namespace {

constexpr double kRange_m = 2.0;
constexpr double kSigma_m = 0.01;

const State& active(const State& state) { return state; }
const State& active(const CompressedState& state) { return state.active(); }

/// The distance of a robot, which only its x is unsure of, from a landmark abeam: z = sqrt(x^2 + 1).
template <class FilterState>
class AbeamOfALandmark {
 public:
  template <class... Further>
  explicit AbeamOfALandmark(Consistency consistency, const Further&... further)
      : state_(2, 4, consistency, further...) {
    state_.place_robot({{1.0, 0.0, 0.0}, Eigen::Vector3d(1.0, 1e-12, 1e-12).asDiagonal()});
    Eigen::Matrix3d noise = Eigen::Matrix3d::Zero();
    noise.topLeftCorner<2, 2>() = 1e-12 * Eigen::Matrix2d::Identity();
    state_.add({0.0, 1.0, 0.0}, Eigen::Matrix3d::Zero(), noise);
  }

  [[nodiscard]] static LinearizedObservation linearize(double x_m, double z_m) {
    LinearizedObservation linearization;
    const double h = std::hypot(x_m, 1.0);
    linearization.rows = 1;
    linearization.nu[0] = z_m - h;
    linearization.H_pose(0, 0) = x_m / h;
    linearization.H_pose(0, 1) = -1.0 / h;
    linearization.H_landmark.row(0) = -linearization.H_pose.row(0).leftCols<3>();
    linearization.R = Eigen::Vector2d(kSigma_m * kSigma_m, 1.0).asDiagonal();
    return linearization;
  }

  /// Whether the distance z was used.
  [[nodiscard]] bool update(IteratedUpdate& iterated, double z_m = kRange_m) {
    const std::vector<LinearizedObservation> block{linearize(x_m(), z_m)};
    return iterated.apply(
        state_, block,
        [&](std::size_t, const LinearizedObservation&) -> std::optional<LinearizedObservation> {
          ++linearised_;
          return linearize(state_.proposal().pose().x_m, z_m);
        });
  }
  [[nodiscard]] double x_m() const { return active(state_).pose().T_world_robot.x_m; }
  /// How often the distance was linearised anew.
  [[nodiscard]] int linearised() const { return linearised_; }
  [[nodiscard]] FilterState& state() { return state_; }

 private:
  FilterState state_;
  int linearised_ = 0;
};

const double kTruth_m = std::sqrt(kRange_m * kRange_m - 1.0);

AbeamOfALandmark<State> abeam() { return AbeamOfALandmark<State>(Consistency::kStandard); }

TEST(IteratedUpdate, WithoutIterationsItIsTheUpdateOfTheState) {
  auto robot = abeam();
  auto plain = abeam();
  IteratedUpdate once(0, Likelihood::kGaussian, Consistency::kStandard);
  ASSERT_TRUE(robot.update(once));
  const std::vector<LinearizedObservation> block{plain.linearize(plain.x_m(), kRange_m)};
  ASSERT_TRUE(plain.state().update(block));
  EXPECT_EQ(robot.linearised(), 0);
  EXPECT_EQ(robot.state().mean(), plain.state().mean());
  EXPECT_EQ(robot.state().covariance(), plain.state().covariance());
}

TEST(IteratedUpdate, FollowsACurvedModelToTheEnd) {
  auto once = abeam();
  auto often = abeam();
  IteratedUpdate plain(0, Likelihood::kGaussian, Consistency::kStandard);
  IteratedUpdate iterated(20, Likelihood::kGaussian, Consistency::kStandard);
  ASSERT_TRUE(once.update(plain));
  ASSERT_TRUE(often.update(iterated));
  EXPECT_GT(std::abs(once.x_m() - kTruth_m), 5.0 * kSigma_m);
  EXPECT_NEAR(often.x_m(), kTruth_m, kSigma_m);
  EXPECT_LT(often.linearised(), 20) << "it ends when that no longer matters";
}

TEST(IteratedUpdate, ACompressedStateIsTheSame) {
  auto whole = abeam();
  AbeamOfALandmark<CompressedState> compressed(Consistency::kStandard, Compression{4, 4});
  IteratedUpdate iterated(20, Likelihood::kGaussian, Consistency::kStandard);
  ASSERT_TRUE(whole.update(iterated));
  ASSERT_TRUE(compressed.update(iterated));
  EXPECT_EQ(whole.x_m(), compressed.x_m());
}

TEST(IteratedUpdate, FirstEstimatesAreNotMoved) {
  AbeamOfALandmark<State> robot(Consistency::kFej);
  IteratedUpdate iterated(20, Likelihood::kStudent, Consistency::kFej);
  ASSERT_TRUE(robot.update(iterated));
  EXPECT_EQ(robot.linearised(), 0);
}

TEST(IteratedUpdate, HeavyTailsPullLessTheFartherOffAnObservationIs) {
  // The prior is as sure as the observation, so that a good part of a large innovation is left.
  const auto pull = [](Likelihood likelihood, double sigmas) {
    AbeamOfALandmark<State> robot(Consistency::kStandard);
    robot.state().place_robot({{1.0, 0.0, 0.0}, Eigen::Vector3d(1e-4, 1e-12, 1e-12).asDiagonal()});
    IteratedUpdate iterated(0, likelihood, Consistency::kStandard);
    EXPECT_TRUE(robot.update(iterated, std::sqrt(2.0) + sigmas * kSigma_m));
    return robot.x_m() - 1.0;
  };
  EXPECT_LT(pull(Likelihood::kStudent, 20.0), 0.5 * pull(Likelihood::kGaussian, 20.0));
  EXPECT_NEAR(pull(Likelihood::kStudent, 0.1), pull(Likelihood::kGaussian, 0.1),
              0.3 * pull(Likelihood::kGaussian, 0.1));
}

TEST(IteratedUpdate, WhereNothingCanBeSeenTheLastStepCounts) {
  auto robot = abeam();
  auto once = abeam();
  IteratedUpdate iterated(20, Likelihood::kGaussian, Consistency::kStandard);
  const std::vector<LinearizedObservation> block{robot.linearize(robot.x_m(), kRange_m)};
  ASSERT_TRUE(iterated.apply(
      robot.state(), block,
      [](std::size_t, const LinearizedObservation&) -> std::optional<LinearizedObservation> { return {}; }));
  ASSERT_TRUE(once.state().update(block));
  EXPECT_EQ(robot.x_m(), once.x_m());
}

TEST(IteratedUpdate, AnImpossibleCovarianceChangesNothing) {
  auto robot = abeam();
  IteratedUpdate iterated(3, Likelihood::kGaussian, Consistency::kStandard);
  std::vector<LinearizedObservation> block{robot.linearize(robot.x_m(), kRange_m)};
  block[0].R(0, 0) = -10.0;
  const Eigen::MatrixXd before = robot.state().covariance();
  EXPECT_FALSE(iterated.apply(
      robot.state(), block,
      [](std::size_t, const LinearizedObservation& linearization) { return std::optional(linearization); }));
  EXPECT_EQ(robot.state().covariance(), before);
}

TEST(IteratedUpdate, AllocatesNothing) {
  auto robot = abeam();
  IteratedUpdate iterated(20, Likelihood::kStudent, Consistency::kStandard);
  const std::vector<LinearizedObservation> block{robot.linearize(robot.x_m(), kRange_m)};
  const test::AllocationCount count;
  EXPECT_TRUE(iterated.apply(robot.state(), block, [&](std::size_t, const LinearizedObservation&) {
    return std::optional(robot.linearize(robot.state().proposal().pose().x_m, kRange_m));
  }));
  EXPECT_EQ(count.allocations(), 0);
}

}  // namespace
}  // namespace waymark::ekf
