#pragma once

#include <cstddef>
#include <cstdint>

namespace waymark::kernels {

inline constexpr int kBlurRadiusMax = 3;
inline constexpr std::size_t kNoisePixels = 64;

/// From the light that fell on the pixels to their grey values: blur of the lens, exposure, noise.
struct ImageNoiseModel {
  /// Of the middle and of the pixels on either side of it, in both directions.
  float weights[kBlurRadiusMax + 1] = {1.0F};
  float gain = 1.0F;
  float noise_grey = 0.0F;  ///< standard deviation
  std::uint64_t seed = 0;
  std::uint32_t purpose = 0;
  std::uint32_t frame = 0;
};

/// One row of an image. `rows` are the rows of light from kBlurRadiusMax above to kBlurRadiusMax below this
/// one, each with `width` pixels rounded up to kNoisePixels; `scratch` and `noise` have room for that many
/// and 16 more. `out` has room for them too. Beyond the sides the light is that of the last pixel. Same bits
/// on every processor.
void apply_image_noise(const ImageNoiseModel& noise_model, std::uint32_t row, const float* const* rows,
                       std::size_t width, float* scratch, float* noise, std::uint8_t* out);

/// `count` random numbers of one row of an image, rounded up to kNoisePixels: sums of four bytes, so that
/// tails end at 3.4 sigma; mean 0 and standard deviation noise_model.noise_grey. Pixel 64 g + 16 k + j gets
/// word k of philox4x32({16 g + j, purpose << 24, frame, row}, seed).
void draw_pixel_noise(const ImageNoiseModel& noise_model, std::uint32_t row, std::size_t count, float* noise);

namespace reference {
void apply_image_noise(const ImageNoiseModel& noise_model, std::uint32_t row, const float* const* rows,
                       std::size_t width, float* scratch, float* noise, std::uint8_t* out);
void draw_pixel_noise(const ImageNoiseModel& noise_model, std::uint32_t row, std::size_t count, float* noise);
}  // namespace reference
}  // namespace waymark::kernels
