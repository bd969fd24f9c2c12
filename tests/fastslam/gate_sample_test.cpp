#include "waymark/fastslam/gate_sample.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "support/matrix_near.hpp"
#include "waymark/fastslam/landmark_store.hpp"
#include "waymark/fastslam/particle_step.hpp"

namespace waymark::fastslam {
namespace {

using kernels::ObservationKind;
using test::matrix_near;

/// Particles spread about (x_m, y_m), all of which know a point 4 m ahead exactly.
class GateSampleTest : public testing::Test {
 protected:
  static constexpr int kCount = 1000;

  GateSampleTest() {
    store_.add(kernels::LandmarkForm::kPoint, {1e5, 1e5});
    const auto view = store_.view(0, {1e5, 1e5});
    for (int i = 0; i < kCount; ++i) {
      view.modes->gaussian.a[i] = 4.0F;
      particles_.set_pose(i, {1e5 + 1e-3 * i, 1e5, 0.0});
    }
  }

  [[nodiscard]] InnovationMoments compare(ObservationKind kind, float bearing_rad) {
    const kernels::LandmarkObservation observation{
        {kind, 3.0F, std::cos(bearing_rad), std::sin(bearing_rad), 0.01F, 0.0F, 0.04F},
        {},
        store_.view(0, {1e5, 1e5})};
    sample_.load(particles_, {1e5, 1e5});
    return sample_.compare(observation, {});
  }

  ParticleBlocks blocks_{kCount};
  Particles particles_{kCount, {}};
  LandmarkStore store_{blocks_};
  GateSample sample_{kCount};
};

// Ranges are spread evenly over 1 m, from 4 m down.
constexpr double kMeanRange_m = 4.0 - 0.4995;
constexpr double kRangeVariance = (1e6 - 1.0) / 12.0 * 1e-6;

TEST_F(GateSampleTest, AddsTheSpreadOfTheSetToTheNoise) {
  const auto both = compare(ObservationKind::kRangeBearing, 0.1F);
  EXPECT_TRUE(matrix_near(both.mean, Eigen::Vector2d(3.0 - kMeanRange_m, 0.1), 1e-5));
  EXPECT_NEAR(both.covariance()(0, 0), 0.01 + kRangeVariance, 1e-5);
  EXPECT_NEAR(both.covariance()(1, 1), 0.04, 1e-5);
  EXPECT_NEAR(both.spread(0, 0), kRangeVariance, 1e-5);
  EXPECT_NEAR(both.noise(0, 0), 0.01, 1e-6);
  const auto range = compare(ObservationKind::kRange, 0.0F);
  EXPECT_NEAR(range.mean[0], 3.0 - kMeanRange_m, 1e-5);
  EXPECT_NEAR(range.covariance()(0, 0), 0.01 + kRangeVariance, 1e-5);
  const auto bearing = compare(ObservationKind::kBearing, 0.1F);
  EXPECT_NEAR(bearing.mean[0], 0.1, 1e-5);
  EXPECT_NEAR(bearing.covariance()(0, 0), 0.04, 1e-5);
}

TEST_F(GateSampleTest, BearingsJustOnEitherSideOfBackwardsDoNotCancel) {
  for (int i = 0; i < kCount; ++i) particles_.set_pose(i, {1e5, 1e5, i % 2 == 0 ? 0.01 : -0.01});
  const auto moments = compare(ObservationKind::kBearing, static_cast<float>(kPi));
  EXPECT_GT(std::abs(moments.mean[0]), 3.1);
  EXPECT_NEAR(moments.covariance()(0, 0), 0.04 + 1e-4, 1e-5);
}

TEST_F(GateSampleTest, DeadParticlesDoNotCountWhateverTheySee) {
  for (int i = 1; i < kCount; ++i) {
    particles_.weights()[static_cast<std::size_t>(i)] = 0.0;
    particles_.set_pose(i, {std::nan(""), 0.0, 0.0});
  }
  const auto moments = compare(ObservationKind::kRange, 0.0F);
  EXPECT_NEAR(moments.mean[0], 3.0 - 4.0, 1e-5);
  EXPECT_NEAR(moments.covariance()(0, 0), 0.01, 1e-5);
}

TEST_F(GateSampleTest, IsNotFiniteWhereALivingParticleIsNot) {
  particles_.set_pose(500, {std::nan(""), 0.0, 0.0});
  EXPECT_FALSE(compare(ObservationKind::kRange, 0.0F).covariance().allFinite());
}

}  // namespace
}  // namespace waymark::fastslam
