#include "workbench/sim/apply_image_noise.hpp"

#include <algorithm>
#include <cmath>

#include "waymark/kernels/highway_targets.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "workbench/sim/apply_image_noise.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "waymark/kernels/philox-inl.h"

#ifndef WAYMARK_KERNELS_APPLY_IMAGE_NOISE_ONCE
#define WAYMARK_KERNELS_APPLY_IMAGE_NOISE_ONCE
namespace waymark::kernels {

constexpr std::size_t kCounters = kNoisePixels / 4;
// Of the sum of four bytes.
constexpr int kSumMean = 510;
constexpr float kSumSigma = 147.80054F;
// Room for the pixels beyond the left side; a multiple of the lanes.
constexpr std::size_t kMargin = 16;

inline std::size_t round_up_pixels(std::size_t count) {
  return (count + kNoisePixels - 1) / kNoisePixels * kNoisePixels;
}

inline void extend_sides(float* pixels, std::size_t width) {
  for (std::ptrdiff_t i = 1; i <= kBlurRadiusMax; ++i) pixels[-i] = pixels[0];
  for (std::size_t i = 0; i < static_cast<std::size_t>(kBlurRadiusMax); ++i)
    pixels[width + i] = pixels[width - 1];
}

}  // namespace waymark::kernels
#endif

HWY_BEFORE_NAMESPACE();
namespace waymark::kernels::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using FloatTag = hn::ScalableTag<float>;
using IntTag = hn::RebindToSigned<FloatTag>;
using Floats = hn::Vec<FloatTag>;

constexpr FloatTag kFloats;

HWY_INLINE Floats all(float value) { return hn::Set(kFloats, value); }

HWY_INLINE Floats normal_from(Words word, Floats scale) {
  const WordTag words;
  const auto mask = hn::Set(words, 0x00FF00FFU);
  const auto pairs = hn::Add(hn::And(word, mask), hn::And(hn::ShiftRight<8>(word), mask));
  const auto sum = hn::Add(hn::And(pairs, hn::Set(words, 0xFFFFU)), hn::ShiftRight<16>(pairs));
  const auto centred = hn::Sub(hn::BitCast(IntTag(), sum), hn::Set(IntTag(), kSumMean));
  return hn::Mul(hn::ConvertTo(kFloats, centred), scale);
}

void noise_lanes(const ImageNoiseModel& model, std::uint32_t row, std::size_t count, float* noise) {
  const WordTag words;
  const std::size_t lanes = hn::Lanes(words);
  const auto scale = all(model.noise_grey / kSumSigma);
  for (std::size_t group = 0; group < round_up_pixels(count); group += kNoisePixels) {
    for (std::size_t j = 0; j < kCounters; j += lanes) {
      const auto counter = hn::Iota(words, static_cast<std::uint32_t>(group / 4 + j));
      const PhiloxWords random = philox(
          {counter, hn::Set(words, model.purpose << 24), hn::Set(words, model.frame), hn::Set(words, row)},
          model.seed);
      float* out = noise + group + j;
      hn::Store(normal_from(random.w0, scale), kFloats, out);
      hn::Store(normal_from(random.w1, scale), kFloats, out + kCounters);
      hn::Store(normal_from(random.w2, scale), kFloats, out + 2 * kCounters);
      hn::Store(normal_from(random.w3, scale), kFloats, out + 3 * kCounters);
    }
  }
}

// No fused multiply-add: every processor is to see the same image.
template <class PairAt>
HWY_INLINE Floats weigh(const ImageNoiseModel& model, Floats middle, PairAt pair_at) {
  auto sum = hn::Mul(all(model.weights[0]), middle);
  for (int k = 1; k <= kBlurRadiusMax; ++k) sum = hn::Add(sum, hn::Mul(all(model.weights[k]), pair_at(k)));
  return sum;
}

HWY_INLINE void blur_down(const ImageNoiseModel& model, const float* const* rows, std::size_t count,
                          float* out) {
  const float* const* middle = rows + kBlurRadiusMax;
  for (std::size_t i = 0; i < count; i += hn::Lanes(kFloats)) {
    const auto pair_at = [&](int k) {
      return hn::Add(hn::Load(kFloats, middle[-k] + i), hn::Load(kFloats, middle[k] + i));
    };
    hn::Store(weigh(model, hn::Load(kFloats, *middle + i), pair_at), kFloats, out + i);
  }
}

HWY_INLINE void blur_across_and_expose(const ImageNoiseModel& model, const float* light, const float* noise,
                                       std::size_t count, std::uint8_t* out) {
  const hn::Rebind<std::uint8_t, FloatTag> bytes;
  for (std::size_t i = 0; i < count; i += hn::Lanes(kFloats)) {
    const float* middle = light + i;
    const auto pair_at = [&](int k) {
      return hn::Add(hn::LoadU(kFloats, middle - k), hn::LoadU(kFloats, middle + k));
    };
    const auto blurred = weigh(model, hn::Load(kFloats, middle), pair_at);
    const auto grey = hn::Add(hn::Mul(all(model.gain), blurred), hn::Load(kFloats, noise + i));
    const auto clamped = hn::Min(hn::Max(grey, hn::Zero(kFloats)), all(255.0F));
    hn::StoreU(hn::DemoteTo(bytes, hn::NearestInt(clamped)), bytes, out + i);
  }
}

void apply_image_noise_lanes(const ImageNoiseModel& model, std::uint32_t row, const float* const* rows,
                             std::size_t width, float* scratch, float* noise, std::uint8_t* out) {
  const std::size_t count = round_up_pixels(width);
  float* light = scratch + kMargin;
  noise_lanes(model, row, width, noise);
  blur_down(model, rows, count, light);
  extend_sides(light, width);
  blur_across_and_expose(model, light, noise, count, out);
}

}  // namespace waymark::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace waymark::kernels {

HWY_EXPORT(noise_lanes);
HWY_EXPORT(apply_image_noise_lanes);

void draw_pixel_noise(const ImageNoiseModel& noise_model, std::uint32_t row, std::size_t count,
                      float* noise) {
  HWY_DYNAMIC_DISPATCH(noise_lanes)(noise_model, row, count, noise);
}

void apply_image_noise(const ImageNoiseModel& noise_model, std::uint32_t row, const float* const* rows,
                       std::size_t width, float* scratch, float* noise, std::uint8_t* out) {
  HWY_DYNAMIC_DISPATCH(apply_image_noise_lanes)(noise_model, row, rows, width, scratch, noise, out);
}

namespace reference {
namespace {

std::uint32_t philox_word(std::uint32_t counter, std::uint32_t row, const ImageNoiseModel& model,
                          std::size_t word) {
  std::uint32_t c[4] = {counter, model.purpose << 24, model.frame, row};
  auto key0 = static_cast<std::uint32_t>(model.seed);
  auto key1 = static_cast<std::uint32_t>(model.seed >> 32);
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t p0 = std::uint64_t{0xD2511F53} * c[0];
    const std::uint64_t p1 = std::uint64_t{0xCD9E8D57} * c[2];
    const std::uint32_t next[4] = {
        static_cast<std::uint32_t>(p1 >> 32) ^ c[1] ^ key0, static_cast<std::uint32_t>(p1),
        static_cast<std::uint32_t>(p0 >> 32) ^ c[3] ^ key1, static_cast<std::uint32_t>(p0)};
    std::copy_n(next, 4, c);
    key0 += 0x9E3779B9U;
    key1 += 0xBB67AE85U;
  }
  return c[word];
}

}  // namespace

void draw_pixel_noise(const ImageNoiseModel& noise_model, std::uint32_t row, std::size_t count,
                      float* noise) {
  for (std::size_t i = 0; i < round_up_pixels(count); ++i) {
    const std::size_t counter = i / kNoisePixels * kCounters + i % kCounters;
    const std::uint32_t word =
        philox_word(static_cast<std::uint32_t>(counter), row, noise_model, i % kNoisePixels / kCounters);
    const std::uint32_t sum = (word & 255) + (word >> 8 & 255) + (word >> 16 & 255) + (word >> 24);
    noise[i] = static_cast<float>(static_cast<int>(sum) - kSumMean) * (noise_model.noise_grey / kSumSigma);
  }
}

void apply_image_noise(const ImageNoiseModel& noise_model, std::uint32_t row, const float* const* rows,
                       std::size_t width, float* scratch, float* noise, std::uint8_t* out) {
  const float* weights = noise_model.weights;
  float* light = scratch + kMargin;
  for (std::size_t i = 0; i < width; ++i) {
    light[i] = weights[0] * rows[kBlurRadiusMax][i];
    for (int k = 1; k <= kBlurRadiusMax; ++k)
      light[i] += weights[k] * (rows[kBlurRadiusMax - k][i] + rows[kBlurRadiusMax + k][i]);
  }
  extend_sides(light, width);
  reference::draw_pixel_noise(noise_model, row, width, noise);
  for (std::size_t i = 0; i < width; ++i) {
    float sum = weights[0] * light[i];
    const float* middle = light + i;
    for (int k = 1; k <= kBlurRadiusMax; ++k) sum += weights[k] * (middle[-k] + middle[k]);
    out[i] =
        static_cast<std::uint8_t>(std::rint(std::clamp(noise_model.gain * sum + noise[i], 0.0F, 255.0F)));
  }
}

}  // namespace reference
}  // namespace waymark::kernels
#endif
