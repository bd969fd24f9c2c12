#include "waymark/kernels/regression.hpp"

#include <limits>

#include "kernels/kernel_support.hpp"

namespace waymark::kernels {
namespace {

class Regression : public test::OnEveryInstructionSet {};

WAYMARK_ON_EVERY_INSTRUCTION_SET(Regression);

TEST_P(Regression, SumsAreTheScalarOnesWhateverThePaddingHolds) {
  for (const std::size_t count : {1U, 15U, 16U, 100U}) {
    const std::size_t padded = round_up_particles(count);
    AlignedArray<float> values(padded), weight(padded), delta(padded);
    for (std::size_t i = 0; i < padded; ++i) {
      const bool alive = i < count && i % 5 != 3;
      values[i] =
          alive ? static_cast<float>(100.0 + random_.normal()) : std::numeric_limits<float>::quiet_NaN();
      weight[i] = alive ? static_cast<float>(random_.uniform(0.1, 1.0)) : 0.0F;
      delta[i] = static_cast<float>(random_.normal());
    }
    const auto fast = sum_regression(values.data(), 100.0F, weight.data(), delta.data(), count);
    const auto plain = reference::sum_regression(values.data(), 100.0F, weight.data(), delta.data(), count);
    EXPECT_NEAR(fast.d, plain.d, 1e-4);
    EXPECT_NEAR(fast.d_delta, plain.d_delta, 1e-4);
    EXPECT_NEAR(fast.d_d, plain.d_d, 1e-4);
  }
}

TEST_P(Regression, AddScaledIsThePlainFormula) {
  AlignedArray<float> step(48), values(48), before(48);
  for (std::size_t i = 0; i < 48; ++i) {
    step[i] = static_cast<float>(random_.normal());
    values[i] = before[i] = static_cast<float>(random_.normal());
  }
  add_scaled(0.3F, step.data(), values.data(), 37);
  for (std::size_t i = 0; i < 37; ++i) EXPECT_NEAR(values[i], before[i] + 0.3F * step[i], 1e-6F);
}

}  // namespace
}  // namespace waymark::kernels
