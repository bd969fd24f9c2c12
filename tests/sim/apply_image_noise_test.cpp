#include "workbench/sim/apply_image_noise.hpp"

#include <cmath>
#include <vector>

#include "kernels/kernel_support.hpp"

namespace waymark::kernels {
namespace {

constexpr std::size_t kWidth = 100;
constexpr std::size_t kPadded = 128;
constexpr int kRows = 2 * kBlurRadiusMax + 1;

/// Rows of light with room for what a row needs.
struct Light {
  explicit Light(RandomStream& random) : values(kRows * kPadded), scratch(kPadded + 32), noise(kPadded) {
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] = static_cast<float>(random.uniform(0.0, 300.0));
    for (std::size_t v = 0; v < kRows; ++v) rows[v] = values.data() + v * kPadded;
  }

  AlignedArray<float> values, scratch, noise;
  const float* rows[kRows]{};
};

ImageNoiseModel some_noise_model() {
  return {.weights = {0.4F, 0.2F, 0.07F, 0.03F},
          .gain = 0.9F,
          .noise_grey = 3.0F,
          .seed = 0x123456789ABCDEFULL,
          .purpose = 6,
          .frame = 77};
}

class ApplyImageNoise : public test::OnEveryInstructionSet {};

WAYMARK_ON_EVERY_INSTRUCTION_SET(ApplyImageNoise);

TEST_P(ApplyImageNoise, EqualsThePlainFormulaToTheLastBit) {
  Light light(random_);
  std::vector<std::uint8_t> fast(kPadded), plain(kPadded);
  apply_image_noise(some_noise_model(), 12, light.rows, kWidth, light.scratch.data(), light.noise.data(),
                    fast.data());
  reference::apply_image_noise(some_noise_model(), 12, light.rows, kWidth, light.scratch.data(),
                               light.noise.data(), plain.data());
  for (std::size_t i = 0; i < kWidth; ++i) ASSERT_EQ(fast[i], plain[i]) << i;
}

TEST_P(ApplyImageNoise, NoiseIsThatOfTheWordsOfPhilox) {
  const ImageNoiseModel model = some_noise_model();
  AlignedArray<float> noise(kPadded);
  draw_pixel_noise(model, 5, kWidth, noise.data());
  for (std::uint32_t i = 0; i < kPadded; ++i) {
    const auto words =
        philox4x32({i / 64 * 16 + i % 16, model.purpose << 24, model.frame, 5},
                   {static_cast<std::uint32_t>(model.seed), static_cast<std::uint32_t>(model.seed >> 32)});
    const std::uint32_t word = words[i % 64 / 16];
    const std::uint32_t sum = (word & 255) + (word >> 8 & 255) + (word >> 16 & 255) + (word >> 24);
    ASSERT_NEAR(noise[i], (static_cast<float>(sum) - 510.0F) / 147.80054F * 3.0F, 1e-5F) << i;
  }
}

// 64000 numbers: the mean has a standard deviation of 0.004 sigma, the standard deviation one of 0.003 sigma,
// and the correlation of neighbours one of 0.004.
TEST_P(ApplyImageNoise, NoiseHasItsMomentsAndNoMemory) {
  ImageNoiseModel model = some_noise_model();
  AlignedArray<float> noise(64);
  double sum = 0.0, squares = 0.0, neighbours = 0.0;
  for (model.frame = 0; model.frame < 10; ++model.frame) {
    for (std::uint32_t row = 0; row < 100; ++row) {
      draw_pixel_noise(model, row, 64, noise.data());
      for (std::size_t i = 0; i < 64; ++i) {
        const double n = static_cast<double>(noise[i]) / 3.0;
        sum += n;
        squares += n * n;
        neighbours += n * static_cast<double>(noise[(i + 1) % 64]) / 3.0;
      }
    }
  }
  EXPECT_NEAR(sum / 64000.0, 0.0, 0.02);
  EXPECT_NEAR(std::sqrt(squares / 64000.0), 1.0, 0.015);
  EXPECT_NEAR(neighbours / 64000.0, 0.0, 0.02);
}

TEST(ApplyImageNoiseReference, ABlurKeepsWhatIsEvenAndSpreadsAPointByItsWeights) {
  RandomStream random(1, StreamPurpose::kWorld);
  Light light(random);
  for (std::size_t i = 0; i < light.values.size(); ++i) light.values[i] = 0.0F;
  light.values[kBlurRadiusMax * kPadded + 50] = 200.0F;
  ImageNoiseModel model{.weights = {0.5F, 0.2F, 0.04F, 0.01F}};
  std::vector<std::uint8_t> out(kPadded);
  reference::apply_image_noise(model, 0, light.rows, kWidth, light.scratch.data(), light.noise.data(),
                               out.data());
  EXPECT_EQ(out[50], 50);
  EXPECT_EQ(out[49], 20);
  EXPECT_EQ(out[52], 4);
  EXPECT_EQ(out[54], 0);
  for (std::size_t i = 0; i < light.values.size(); ++i) light.values[i] = 90.0F;
  reference::apply_image_noise(model, 0, light.rows, kWidth, light.scratch.data(), light.noise.data(),
                               out.data());
  for (std::size_t i = 0; i < kWidth; ++i) ASSERT_EQ(out[i], 90) << i;
}

}  // namespace
}  // namespace waymark::kernels
