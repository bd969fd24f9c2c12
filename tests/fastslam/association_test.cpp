#include "waymark/fastslam/association.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "waymark/kernels/particle_existence.hpp"

namespace waymark::fastslam {
namespace {

constexpr int kNothing = GreedyMatch::kNothing;
constexpr int kCloud = 300;
constexpr LandmarkSensor kHalfPlane{.max_range_m = 10.0, .field_of_view_deg = 180.0};

class AssociationTest : public testing::Test {
 protected:
  AssociationTest() {
    for (int k = 0; k < 2; ++k) {
      store_.add(kernels::LandmarkForm::kPoint, {0.0, 0.0}, 1, true);
      std::fill_n(store_.existence(k), kCloud, 1.0F);
    }
    association_.begin_split();
  }

  /// log N of the choice such that it scores this much.
  static float log_likelihood(const Association::Choice& choice, double score) {
    return static_cast<float>(score - choice.log_odds + choice.log_others);
  }
  void offer(int observation, int landmark, double even_score, double odd_score) {
    Association::Choice* const choice = association_.offer(observation, landmark, 3.0, 0.9);
    for (int i = 0; i < kCloud; ++i)
      choice->column[i] = log_likelihood(*choice, i % 2 == 0 ? even_score : odd_score);
  }
  [[nodiscard]] int chosen(int observation, int particle) const {
    for (const Association::Choice& choice : association_.choices())
      if (choice.observation == observation && choice.column[particle] == 1.0F) return choice.landmark;
    return -2;
  }

  ParticleBlocks blocks_{kCloud, 2};
  LandmarkStore store_{blocks_};
  Association association_{AssociationModel({}, kHalfPlane), blocks_};
};

TEST_F(AssociationTest, EveryParticleTakesWhatIsBestForIt) {
  association_.offer_none(0, 3.0);
  offer(0, 0, 5.0, 2.0);
  offer(0, 1, 4.0, 3.0);
  association_.split(store_);
  for (int i = 0; i < kCloud; ++i) EXPECT_EQ(chosen(0, i), i % 2);
}

TEST_F(AssociationTest, ALandmarkIsSeenOncePerScan) {
  association_.offer_none(0, 3.0);
  association_.offer_none(1, 3.0);
  offer(0, 0, 5.0, 2.0);
  offer(1, 0, 4.0, 3.0);
  association_.split(store_);
  for (int i = 0; i < kCloud; ++i) {
    EXPECT_EQ(chosen(0, i), i % 2 == 0 ? 0 : kNothing);
    EXPECT_EQ(chosen(1, i), i % 2 == 0 ? kNothing : 0);
  }
}

TEST_F(AssociationTest, WhatFitsNothingKnownIsNew) {
  association_.offer_none(0, 3.0);
  offer(0, 0, -0.1, 0.1);
  association_.split(store_);
  for (int i = 0; i < kCloud; ++i) EXPECT_EQ(chosen(0, i), i % 2 == 0 ? kNothing : 0);
}

TEST_F(AssociationTest, AParticleCannotTakeALandmarkThatItDoesNotHave) {
  for (int i = 0; i < kCloud; i += 3) store_.existence(0)[i] = kernels::kAbsent;
  association_.offer_none(0, 3.0);
  offer(0, 0, 5.0, 5.0);
  association_.split(store_);
  for (int i = 0; i < kCloud; ++i) EXPECT_EQ(chosen(0, i), i % 3 == 0 ? kNothing : 0);
}

TEST_F(AssociationTest, WeightsDifferByTheScore) {
  association_.offer_none(0, 3.0);
  offer(0, 0, 2.5, 2.5);
  const auto choices = association_.choices();
  // log N counts without its constant log(2 pi) where landmarks are updated.
  const double log_n = static_cast<double>(choices[1].column[0]) + std::log(2.0 * kPi);
  EXPECT_NEAR(log_n + Association::log_weight(choices[1]) - Association::log_weight(choices[0]), 2.5, 1e-6);
}

TEST_F(AssociationTest, RoomForChoicesEnds) {
  int offered = 0;
  while (offered < 1000 && association_.offer(offered, 0, 3.0, 0.9) != nullptr) ++offered;
  EXPECT_GT(offered, 10);
  EXPECT_LT(offered, 1000);
}

}  // namespace
}  // namespace waymark::fastslam
