#include "waymark/kernels/particle_existence.hpp"

#include <cmath>

#include "kernels/kernel_support.hpp"
#include "kernels/particle_support.hpp"

namespace waymark::kernels {
namespace {

using test::ParticleScene;

ParticleScene existence_scene(std::size_t count) {
  return {count, LandmarkForm::kPoint, ObservationKind::kRangeBearing, 1, 5};
}

class ParticleExistence : public test::OnEveryInstructionSet {};
WAYMARK_ON_EVERY_INSTRUCTION_SET(ParticleExistence);

TEST_P(ParticleExistence, MissesAsTheScalarFormula) {
  for (const std::size_t count : {1U, 7U, 16U, 37U}) {
    ParticleScene scene = existence_scene(count);
    float* const fast = scene.columns().add();
    float* const plain = scene.columns().add();
    for (std::size_t i = 0; i < count; ++i) fast[i] = plain[i] = static_cast<float>(i % 4);
    // The middle of the scene's landmarks lies on the edge.
    SensorView view{scene.observation.mount, 0.0F, 6.0F, 0.01F, 0.001F};
    view.mount.half_view = 0.3F;
    miss_landmark(scene.observation.landmark, scene.poses, view, -1.5F, fast, scene.range());
    reference::miss_landmark(scene.observation.landmark, scene.poses, view, -1.5F, plain, scene.range());
    for (std::size_t i = 0; i < count; ++i) EXPECT_EQ(fast[i], plain[i]) << i;
  }
}

/// One particle in the origin, looking along x, and a landmark at a place of little doubt.
class OneParticle {
 public:
  OneParticle(double range_m, double bearing_rad) : columns_(1) {
    poses_.cos[0] = 1.0F;
    gaussian_.a[0] = static_cast<float>(range_m * std::cos(bearing_rad));
    gaussian_.b[0] = static_cast<float>(range_m * std::sin(bearing_rad));
    gaussian_.aa[0] = gaussian_.bb[0] = 1e-4F;
  }

  /// What is left of log-odds of 2 after a miss that costs 0.5.
  [[nodiscard]] float after_miss(const SensorView& view, float change = -0.5F) {
    log_odds_[0] = 2.0F;
    const LandmarkMode mode{gaussian_};
    const LandmarkView landmark{LandmarkForm::kPoint, 0.0F, 0.0F, nullptr, nullptr, &mode, 1};
    miss_landmark(landmark, poses_, view, change, log_odds_, {0, 1});
    return log_odds_[0];
  }

 private:
  test::Columns columns_;
  PoseColumns poses_ = columns_.add_poses();
  GaussianColumns gaussian_ = columns_.add_gaussian();
  float* log_odds_ = columns_.add();
};

/// Three standard deviations are 0.3 m and 0.03 rad, nearly.
SensorView small_view() {
  SensorView view{{}, 1.0F, 5.0F, 0.0099F, 0.00009F};
  view.mount.half_view = 0.5F;
  return view;
}

TEST(MissLandmark, CountsWhatIsWellInView) {
  EXPECT_EQ(OneParticle(3.0, 0.0).after_miss(small_view()), 1.5F);
  EXPECT_EQ(OneParticle(4.65, 0.4).after_miss(small_view()), 1.5F);
  EXPECT_EQ(OneParticle(1.35, -0.4).after_miss(small_view()), 1.5F);
}

TEST(MissLandmark, DoesNotCountWhatMayBeOutside) {
  EXPECT_EQ(OneParticle(4.75, 0.0).after_miss(small_view()), 2.0F);
  EXPECT_EQ(OneParticle(1.2, 0.0).after_miss(small_view()), 2.0F);
  EXPECT_EQ(OneParticle(3.0, 0.48).after_miss(small_view()), 2.0F);
  EXPECT_EQ(OneParticle(3.0, -0.48).after_miss(small_view()), 2.0F);
  EXPECT_EQ(OneParticle(3.0, 3.0).after_miss(small_view()), 2.0F);
}

TEST(MissLandmark, ASensorThatSeesAllRoundSeesBehindItself) {
  SensorView view = small_view();
  view.mount.half_view = 3.2F;
  EXPECT_EQ(OneParticle(3.0, 3.0).after_miss(view), 1.5F);
}

TEST(MissLandmark, WhatFallsBelowNothingIsAbsent) {
  EXPECT_EQ(OneParticle(3.0, 0.0).after_miss(small_view(), -2.5F), kAbsent);
}

}  // namespace
}  // namespace waymark::kernels
