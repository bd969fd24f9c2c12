#include "waymark/kernels/particle_weights.hpp"

#include <limits>

#include "waymark/core/angle.hpp"

#include "kernels/kernel_support.hpp"

namespace waymark::kernels {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kWeightCounts[]{1, 5, 16, 41};

class ParticleWeights : public test::OnEveryInstructionSet {
 protected:
  /// Log weights over many orders of magnitude, some of them not numbers; the padding would spoil any sum.
  AlignedArray<double> log_weights(std::size_t count) {
    AlignedArray<double> values(round_up_particles(count));
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = i < count ? 100.0 * random_.normal() : kNan;
    for (std::size_t i = 3; i < count; i += 7) values[i] = i % 2 == 0 ? kNan : -kInfinity;
    return values;
  }
};

WAYMARK_ON_EVERY_INSTRUCTION_SET(ParticleWeights);

TEST_P(ParticleWeights, TheLargestIsFoundAmongNumbers) {
  AlignedArray<double> values(16);
  const double entries[]{kNan, -3.0, kInfinity, -7.0, -kInfinity};
  std::copy(std::begin(entries), std::end(entries), values.data());
  EXPECT_EQ(largest_finite(values.data(), 5), -3.0);
  EXPECT_EQ(largest_finite(values.data(), 1), -kInfinity);
}

TEST_P(ParticleWeights, ExponentiateAsTheScalarFormulaDoes) {
  for (const std::size_t count : kWeightCounts) {
    AlignedArray<double> fast = log_weights(count);
    AlignedArray<double> plain(fast.size()), weight(fast.size()), plain_weight(fast.size());
    std::copy_n(fast.data(), fast.size(), plain.data());
    const double largest = largest_finite(fast.data(), count);
    const double sum = exponentiate(largest, fast.data(), weight.data(), count);
    const double plain_sum = reference::exponentiate(largest, plain.data(), plain_weight.data(), count);
    EXPECT_NEAR(sum, plain_sum, 1e-14 * plain_sum);
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_EQ(fast[i], plain[i]);
      EXPECT_NEAR(weight[i], plain_weight[i], 1e-14 * plain_weight[i]);
    }
  }
}

TEST_P(ParticleWeights, SumsOfPowersAreTheScalarOnes) {
  for (const std::size_t count : kWeightCounts) {
    const AlignedArray<double> values = log_weights(count);
    for (const double power : {1.0, 0.01, 1e-9}) {
      const auto fast = sum_powers(values.data(), power, count);
      const auto plain = reference::sum_powers(values.data(), power, count);
      EXPECT_NEAR(fast[0], plain[0], 1e-12 * plain[0]);
      EXPECT_NEAR(fast[1], plain[1], 1e-12 * plain[1]);
    }
  }
}

TEST_P(ParticleWeights, SumsOfPosesAreTheScalarOnes) {
  for (const std::size_t count : kWeightCounts) {
    const std::size_t padded = round_up_particles(count);
    AlignedArray<double> x(padded), y(padded), theta(padded), weight(padded);
    for (std::size_t i = 0; i < padded; ++i) {
      x[i] = 100.0 + random_.normal();
      y[i] = random_.normal();
      theta[i] = random_.uniform(-kPi, kPi);
      weight[i] = i < count ? random_.uniform() : 5.0;
    }
    const WorldPoses world{x.data(), y.data(), theta.data()};
    const auto fast = sum_poses(world, weight.data(), {100.0, 0.0, 3.0}, count);
    const auto plain = reference::sum_poses(world, weight.data(), {100.0, 0.0, 3.0}, count);
    for (std::size_t k = 0; k < fast.size(); ++k)
      EXPECT_NEAR(fast[k], plain[k], 1e-12 * static_cast<double>(count) * 10.0);
  }
}

}  // namespace
}  // namespace waymark::kernels
