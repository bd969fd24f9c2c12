#include "waymark/kernels/particle_likelihood.hpp"

#include <cmath>

#include <Eigen/LU>

#include "waymark/core/aligned_array.hpp"
#include "waymark/core/angle.hpp"

#include "kernels/kernel_support.hpp"
#include "kernels/particle_support.hpp"

namespace waymark::kernels {
namespace {

using test::ParticleScene;

constexpr Increment kMoved{0.1F, 0.02F, 0.05F, 2e-3F, 3e-4F, 2e-4F, 1e-3F, 4e-4F, 3e-3F};

ParticleScene likelihood_scene(std::size_t count) {
  return {count, LandmarkForm::kPoint, ObservationKind::kRangeBearing, 1, 3};
}

class ParticleLikelihood : public test::OnEveryInstructionSet {};
WAYMARK_ON_EVERY_INSTRUCTION_SET(ParticleLikelihood);

TEST_P(ParticleLikelihood, AsTheScalarFormula) {
  for (const std::size_t count : {1U, 7U, 16U, 37U}) {
    ParticleScene scene = likelihood_scene(count);
    float* const fast = scene.columns().add();
    float* const plain = scene.columns().add();
    list_log_likelihoods(scene.observation, kMoved, scene.poses, fast, scene.range());
    reference::list_log_likelihoods(scene.observation, kMoved, scene.poses, plain, scene.range());
    for (std::size_t i = 0; i < count; ++i)
      EXPECT_NEAR(fast[i], plain[i], 1e-4F * (1.0F + std::abs(plain[i])));
  }
}

/// Mean and covariance of one particle's innovation are those that compare_observation() sums.
TEST(ListLogLikelihoods, IsTheDensityOfTheInnovation) {
  constexpr std::size_t kCount = 20;
  ParticleScene scene = likelihood_scene(kCount);
  float* const column = scene.columns().add();
  list_log_likelihoods(scene.observation, kMoved, scene.poses, column, scene.range());
  for (std::size_t i = 0; i < kCount; ++i) {
    AlignedArray<double> only(round_up_particles(kCount));
    only[i] = 1.0;
    const InnovationSums sums = reference::compare_observation(scene.observation, kMoved, scene.poses, {},
                                                               only.data(), scene.range());
    const Eigen::Vector2d nu(sums.nu[0], sums.nu[1]);
    const Eigen::Matrix2d L{{sums.L[0], sums.L[1]}, {sums.L[1], sums.L[2]}};
    const double expected =
        -0.5 * (nu.dot(L.inverse() * nu) + std::log(L.determinant())) - std::log(2.0 * kPi);
    EXPECT_NEAR(static_cast<double>(column[i]), expected, 1e-4 * (1.0 + std::abs(expected)));
  }
}

}  // namespace
}  // namespace waymark::kernels
