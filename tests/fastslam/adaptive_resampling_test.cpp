#include "waymark/fastslam/adaptive_resampling.hpp"

#include <algorithm>
#include <limits>

#include <gtest/gtest.h>

namespace waymark::fastslam {
namespace {

constexpr double kNoWeight = -std::numeric_limits<double>::infinity();

/// A hundred particles of which all the weight lies on the first `heavy`.
class AdaptiveResamplingTest : public testing::Test {
 protected:
  void weigh(int heavy) {
    for (int i = 0; i < 100; ++i) belief_.particles.log_weights()[as_index(i)] = i < heavy ? 0.0 : kNoWeight;
    EXPECT_TRUE(normalise_weights(belief_.particles, belief_.blocks));
    belief_.has_moved = true;
  }

  FastSlamOptions options_{.particles = 100};
  Belief belief_{options_, {}, 1};
  AdaptiveResampling resampling_{options_, belief_.blocks};
};

TEST_F(AdaptiveResamplingTest, ResamplesWhenTooFewParticlesCount) {
  weigh(60);
  resampling_.resample(belief_);
  EXPECT_EQ(resampling_.resamplings(), 0);
  weigh(40);
  resampling_.resample(belief_);
  EXPECT_EQ(resampling_.resamplings(), 1);
  EXPECT_NEAR(effective_particles(belief_.particles.weights()), 100.0, 1e-9);
}

TEST_F(AdaptiveResamplingTest, ARobotThatStandsIsNotResampled) {
  weigh(40);
  belief_.has_moved = false;
  resampling_.resample(belief_);
  EXPECT_EQ(resampling_.resamplings(), 0);
}

TEST_F(AdaptiveResamplingTest, AMotionCountsOnce) {
  weigh(60);
  resampling_.resample(belief_);
  EXPECT_FALSE(belief_.has_moved);
}

TEST_F(AdaptiveResamplingTest, WeightsAreFlattenedToKeepSomeEffective) {
  for (int i = 0; i < 100; ++i) belief_.particles.log_weights()[as_index(i)] = -0.5 * i;
  EXPECT_TRUE(resampling_.normalise(belief_));
  EXPECT_NEAR(effective_particles(belief_.particles.weights()), 10.0, 0.1);
}

TEST_F(AdaptiveResamplingTest, WhereNoParticleWeighsAnythingAllAreEqualAgain) {
  std::ranges::fill(belief_.particles.log_weights(), kNoWeight);
  EXPECT_FALSE(resampling_.normalise(belief_));
  EXPECT_NEAR(effective_particles(belief_.particles.weights()), 100.0, 1e-9);
}

}  // namespace
}  // namespace waymark::fastslam
