#include "waymark/fastslam/particle_existence.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "known_map.hpp"

namespace waymark::fastslam {
namespace {

constexpr LandmarkSensor kDetector{
    .max_range_m = 10.0, .field_of_view_deg = 180.0, .detection_probability = 0.9};

TEST(ParticleSupport, IsTheWeightOfThoseThatHaveIt) {
  constexpr int kCloud = 300;
  ParticleBlocks blocks(kCloud, 2);
  const Particles particles(kCloud, {});
  std::vector<float> log_odds;
  for (int i = 0; i < kCloud; ++i) log_odds.push_back(i < 75 ? kernels::kAbsent : i < 150 ? 7.0F : 1.0F);
  const Support held = support(log_odds.data(), 6.0, particles, blocks);
  EXPECT_NEAR(held.present, 0.75, 1e-9);
  EXPECT_NEAR(held.confirmed, 0.25, 1e-9);
  const double mean = (75.0 * 7.0 + 150.0 * 1.0) / 225.0;
  EXPECT_NEAR(held.probability, 0.75 / (1.0 + std::exp(-mean)), 1e-9);
}

/// Landmarks without identity ahead and to the left of particles at the origin; all particles have each with
/// log-odds 1.
class ParticleExistenceTest : public testing::Test {
 protected:
  ParticleExistenceTest() {
    test::add_point(belief_, {4.0, 0.0}, Identity::kUnknown);
    test::add_point(belief_, {0.5, 4.0}, Identity::kUnknown);
  }

  void update(const std::vector<Observation>& observations) {
    belief_.landmarks.begin_scan();
    scan_.begin(observations);
    for (Innovation& innovation : scan_.innovations) innovation.outcome = Outcome::kUnidentified;
    matcher_.match(scan_, gate_, 100, belief_);
    existence_.update(scan_, matcher_, gate_.threshold(2), belief_);
  }
  [[nodiscard]] float log_odds(int landmark) const { return belief_.store.existence(landmark)[7]; }

  Belief belief_{{.particles = 40}, kDetector, 1};
  SensorModel sensor_{kDetector, 1.0};
  AssociationModel model_{{}, kDetector};
  InnovationGate gate_{{}, sensor_};
  Scan scan_;
  ParticleMatcher matcher_{model_, sensor_, belief_.blocks};
  ParticleExistence existence_{model_, sensor_, belief_.blocks};
};

TEST_F(ParticleExistenceTest, WhatIsSeenIsSurerWhatShouldHaveBeenIsLessSo) {
  update({test::range_bearing(4.0, 0.0)});
  EXPECT_NEAR(log_odds(0), 1.0 + model_.seen(), 1e-5);
  EXPECT_NEAR(belief_.records[0].existence_probability, 1.0 / (1.0 + std::exp(-1.0 - model_.seen())), 1e-5);
  EXPECT_LT(log_odds(1), 1.0F);
}

TEST_F(ParticleExistenceTest, WhatIsSeenOftenIsConfirmed) {
  for (int i = 0; i < 3; ++i) update({test::range_bearing(4.0, 0.0)});
  EXPECT_TRUE(belief_.landmarks.is_in_map(0));
  EXPECT_FALSE(belief_.landmarks.is_in_map(1));
}

TEST_F(ParticleExistenceTest, WhatIsMissedTooOftenHasNoSupport) {
  for (int i = 0; i < 3; ++i) update({test::range_bearing(4.0, 0.0)});
  EXPECT_EQ(log_odds(1), kernels::kAbsent);
  EXPECT_EQ(belief_.records[1].existence_probability, 0.0);
}

TEST_F(ParticleExistenceTest, AScanWithIdentitiesAloneMissesLandmarksOfThePresentMap) {
  std::fill_n(belief_.store.existence(0), belief_.particles.count(), 10.0F);
  update({});
  EXPECT_LT(log_odds(0), 10.0F);
  belief_.remove(1);
  const float before = log_odds(0);
  update({});
  EXPECT_LT(log_odds(0), before);
}

TEST_F(ParticleExistenceTest, CertaintyHasALimit) {
  for (int i = 0; i < 30; ++i) update({test::range_bearing(4.0, 0.0)});
  EXPECT_EQ(log_odds(0), 12.0F);
}

}  // namespace
}  // namespace waymark::fastslam
