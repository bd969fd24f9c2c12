#include "waymark/ekf/depth_particles.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "support/allocation_counter.hpp"

namespace waymark::ekf {
namespace {

using Spacing = DepthPrior::Spacing;

std::vector<double> inverse_depths(DepthParticles& particles) {
  std::vector<double> rhos;
  particles.score([&](double rho) {
    rhos.push_back(rho);
    return 0.0;
  });
  return rhos;
}

/// As a pixel would say of an inverse depth.
auto gaussian(double mean, double sigma) {
  return [=](double rho) { return -0.5 * std::pow((rho - mean) / sigma, 2); };
}

TEST(DepthParticles, SpansThePriorInEqualStepsOfWhatItIsUniformIn) {
  for (const auto spacing : {Spacing::kInverseDepth, Spacing::kDepth}) {
    DepthParticles particles({20, 0.5, 10.0, spacing});
    std::vector<double> values = inverse_depths(particles);
    ASSERT_EQ(values.size(), 20U);
    if (spacing == Spacing::kDepth)
      for (double& value : values) value = 1.0 / value;
    std::ranges::sort(values);
    const double low = spacing == Spacing::kDepth ? 0.5 : 0.1;
    const double high = spacing == Spacing::kDepth ? 10.0 : 2.0;
    const double step = (high - low) / 20.0;
    for (std::size_t i = 0; i < values.size(); ++i)
      EXPECT_NEAR(values[i], low + step * (static_cast<double>(i) + 0.5), 1e-12);
  }
}

TEST(DepthParticles, MomentsOfThePriorAreThoseOfTheUniformDistribution) {
  const DepthParticles by_inverse({10, 0.5, 10.0, Spacing::kInverseDepth});
  EXPECT_NEAR(by_inverse.inverse_depth().mean, 1.05, 1e-9);
  EXPECT_NEAR(by_inverse.inverse_depth().sigma, 1.9 / std::sqrt(12.0), 1e-9);
  const DepthParticles by_depth({10, 0.5, 10.0, Spacing::kDepth});
  EXPECT_NEAR(by_depth.depth().mean, 5.25, 1e-9);
  EXPECT_NEAR(by_depth.depth().sigma, 9.5 / std::sqrt(12.0), 1e-9);
}

TEST(DepthParticles, TakesTheProductOfWhatItWasTold) {
  DepthParticles particles({200, 0.5, 10.0, Spacing::kInverseDepth});
  for (const double mean : {0.8, 1.0}) {
    particles.score(gaussian(mean, 0.1));
    particles.take();
  }
  // Two Gaussians of equal width: their mean, narrower by the square root of two.
  EXPECT_NEAR(particles.inverse_depth().mean, 0.9, 1e-3);
  EXPECT_NEAR(particles.inverse_depth().sigma, 0.1 / std::sqrt(2.0), 2e-3);
}

TEST(DepthParticles, AScoreThatIsNotTakenChangesNothing) {
  DepthParticles particles({100, 0.5, 10.0, Spacing::kInverseDepth});
  const double before = particles.inverse_depth().mean;
  EXPECT_NEAR(particles.score(gaussian(1.05, 0.1)), 0.0, 0.01);
  EXPECT_EQ(particles.inverse_depth().mean, before);
  EXPECT_EQ(particles.score([](double) { return -HUGE_VAL; }), -HUGE_VAL);
  EXPECT_EQ(particles.inverse_depth().mean, before);
}

TEST(DepthParticles, DropsWhatIsImpossibleOrAllButAndTheRestSumsToOne) {
  DepthParticles particles({100, 0.5, 10.0, Spacing::kInverseDepth});
  particles.score([](double rho) { return rho < 1.0 ? -HUGE_VAL : 0.0; });
  particles.take();
  const auto left = inverse_depths(particles);
  EXPECT_EQ(left.size(), 53U);  // 2 - 0.019 (i + 1/2) >= 1
  EXPECT_GE(std::ranges::min(left), 1.0);
  const double mean = (std::ranges::min(left) + std::ranges::max(left)) / 2.0;
  EXPECT_NEAR(particles.inverse_depth().mean, mean, 1e-9);
}

TEST(DepthParticles, ASingleOneThatIsLeftIsAsUnsureAsItsShareOfThePrior) {
  for (const auto spacing : {Spacing::kInverseDepth, Spacing::kDepth}) {
    DepthParticles particles({100, 0.5, 10.0, spacing});
    particles.score(gaussian(0.5, 1e-4));
    particles.take();
    EXPECT_EQ(particles.size(), 1U);
    const auto inverse = particles.inverse_depth();
    const auto depth = particles.depth();
    if (spacing == Spacing::kInverseDepth)
      EXPECT_NEAR(inverse.sigma, 0.019 / std::sqrt(12.0), 1e-9);
    else
      EXPECT_NEAR(depth.sigma, 0.095 / std::sqrt(12.0), 1e-9);
    EXPECT_NEAR(depth.sigma / depth.mean, inverse.sigma / inverse.mean, 1e-9);
  }
}

TEST(DepthParticles, LikelihoodsMayBeSmallerThanNumbersAre) {
  DepthParticles particles({100, 0.5, 10.0, Spacing::kInverseDepth});
  particles.score([](double rho) { return -1e5 + gaussian(1.0, 0.2)(rho); });
  particles.take();
  EXPECT_NEAR(particles.inverse_depth().mean, 1.0, 0.01);
}

TEST(DepthParticles, RestartsWithoutTakingMemory) {
  DepthParticles particles({100, 0.5, 10.0, Spacing::kInverseDepth});
  const auto fresh = particles.inverse_depth();
  const test::AllocationCount count;
  particles.score(gaussian(1.0, 0.05));
  particles.take();
  EXPECT_LT(particles.size(), 100U);
  particles.restart();
  EXPECT_EQ(count.allocations(), 0);
  EXPECT_EQ(particles.size(), 100U);
  EXPECT_EQ(particles.inverse_depth().mean, fresh.mean);
  EXPECT_EQ(particles.inverse_depth().sigma, fresh.sigma);
}

}  // namespace
}  // namespace waymark::ekf
