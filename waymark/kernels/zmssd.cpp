#include "waymark/kernels/zmssd.hpp"

#include <algorithm>

#ifndef WAYMARK_KERNELS_ZMSSD_PLAIN
#define WAYMARK_KERNELS_ZMSSD_PLAIN
namespace waymark::kernels {
namespace {

// The plain formula for one window, with the pixels of the patch as `patch_at(row, column)`.
template <class PatchAt>
std::uint32_t plain_zmssd(PatchAt patch_at, const std::uint8_t* window, std::ptrdiff_t stride, int size) {
  std::int64_t sum = 0, squares = 0;
  for (int r = 0; r < size; ++r) {
    for (int c = 0; c < size; ++c) {
      const int difference = patch_at(r, c) - window[r * stride + c];
      sum += difference;
      squares += difference * difference;
    }
  }
  return static_cast<std::uint32_t>(std::int64_t{size} * size * squares - sum * sum);
}

}  // namespace
}  // namespace waymark::kernels
#endif

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "waymark/kernels/zmssd.cpp"
// Lane counts must be known at compile time; SVE machines run the NEON code.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace waymark::kernels::HWY_NAMESPACE {
#if HWY_TARGET == HWY_SCALAR

void score_row(const ZmssdPatch& patch, const std::uint8_t* first, std::ptrdiff_t stride, std::size_t count,
               std::uint32_t* scores) {
  for (std::size_t k = 0; k < count; ++k)
    scores[k] = plain_zmssd([&](int r, int c) { return patch.rows[r][c]; }, first + k, stride, patch.size);
}

#else

namespace hn = hwy::HWY_NAMESPACE;

constexpr int kChunk = 64;  // windows at a time
// The strip of image below a chunk of windows, and what vectors read behind it.
constexpr int kColumns = kChunk + kMaxPatchSize + ZmssdPatch::kLanes;

// What a chunk of windows has in common.
struct Strip {
  alignas(64) std::int16_t pixels[kMaxPatchSize][kColumns];
  alignas(64) std::uint16_t sum[kColumns];  // of each column of pixels
  alignas(64) std::uint32_t sum_of_squares[kColumns];
  alignas(64) std::int32_t products[kColumns];  // sum d i of each window
};

// Widens the strip's columns u to u + lanes and sums them up.
template <class D>
HWY_INLINE void widen_columns(D d16, const std::uint8_t* first, std::ptrdiff_t stride, int rows, int u,
                              Strip& strip) {
  const hn::RebindToSigned<D> signed16;
  const hn::Rebind<std::uint8_t, D> d8;
  const hn::RepartitionToWide<D> d32;
  auto sum = hn::Zero(d16);
  auto squares_low = hn::Zero(d32), squares_high = hn::Zero(d32);
  for (int r = 0; r < rows; ++r) {
    const auto pixels = hn::PromoteTo(d16, hn::LoadU(d8, first + r * stride + u));
    hn::StoreU(hn::BitCast(signed16, pixels), signed16, &strip.pixels[r][u]);
    const auto squares = hn::Mul(pixels, pixels);  // 255^2 fits
    sum = hn::Add(sum, pixels);
    squares_low = hn::Add(squares_low, hn::PromoteTo(d32, hn::LowerHalf(squares)));
    squares_high = hn::Add(squares_high, hn::PromoteTo(d32, hn::UpperHalf(hn::Half<D>(), squares)));
  }
  hn::StoreU(sum, d16, strip.sum + u);
  hn::StoreU(squares_low, d32, strip.sum_of_squares + u);
  hn::StoreU(squares_high, d32, strip.sum_of_squares + u + hn::Lanes(d32));
}

// All columns; the last vector overlaps the one before it instead of reading behind the strip.
template <class D>
HWY_INLINE void widen_strip(D d16, const std::uint8_t* first, std::ptrdiff_t stride, int rows, int columns,
                            Strip& strip) {
  const int lanes = static_cast<int>(hn::Lanes(d16));
  for (int u = 0; u + lanes < columns; u += lanes) widen_columns(d16, first, stride, rows, u, strip);
  widen_columns(d16, first, stride, rows, columns - lanes, strip);
}

// What vectors read behind the last column counts for nothing, but must be something.
HWY_INLINE void zero_behind(int rows, int columns, Strip& strip) {
  const hn::CappedTag<std::int16_t, ZmssdPatch::kLanes> d;
  for (int r = 0; r < rows; ++r)
    for (std::size_t k = 0; k < ZmssdPatch::kLanes; k += hn::Lanes(d))
      hn::StoreU(hn::Zero(d), d, &strip.pixels[r][columns] + k);
}

// Sums of neighbouring lanes of four vectors: each block of four lanes holds that of a, b, c and d.
template <class V>
HWY_INLINE V sums_of_blocks(V a, V b, V c, V d) {
  const hn::DFromV<V> d32;
  const hn::RepartitionToWide<decltype(d32)> d64;
  const auto pairs = [&](V x, V y) HWY_ATTR {
    return hn::BitCast(d64, hn::Add(hn::InterleaveLower(d32, x, y), hn::InterleaveUpper(d32, x, y)));
  };
  const auto ab = pairs(a, b), cd = pairs(c, d);
  return hn::Add(hn::BitCast(d32, hn::InterleaveLower(d64, ab, cd)),
                 hn::BitCast(d32, hn::InterleaveUpper(d64, ab, cd)));
}

// sum d i of the windows u .. u + 3, and of those at u + kWidth, u + 2 kWidth, ... as far as a vector
// reaches.
template <int kWidth, class D>
HWY_INLINE void multiply_four(D d16, const ZmssdPatch& patch, int u, Strip& strip) {
  const hn::RepartitionToWide<D> d32;
  const hn::FixedTag<std::int32_t, 4> block;
  constexpr int kVector = static_cast<int>(hn::MaxLanes(D()));
  constexpr int kReach = kVector < kWidth ? kWidth : kVector;
  hn::Vec<decltype(d32)> even[4], odd[4];
  for (int k = 0; k < 4; ++k) even[k] = odd[k] = hn::Zero(d32);
  for (int r = 0; r < patch.size; ++r) {
    for (int part = 0; part < kReach; part += kVector) {
      const auto d = hn::Load(d16, &patch.rows[r][part]);
      for (int k = 0; k < 4; ++k) {
        const auto i = hn::LoadU(d16, &strip.pixels[r][u + k + part]);
        even[k] = hn::ReorderWidenMulAccumulate(d32, d, i, even[k], odd[k]);
      }
    }
  }
  for (int k = 0; k < 4; ++k) even[k] = hn::Add(even[k], odd[k]);
  alignas(64) std::int32_t sums[16];
  hn::Store(sums_of_blocks(even[0], even[1], even[2], even[3]), d32, sums);
  for (int w = 0; w < kReach; w += kWidth) {
    constexpr int kBlocks = std::min(kWidth, kVector) / 8;
    auto sum = hn::Load(block, sums + w / 2);
    if constexpr (kBlocks == 2) sum = hn::Add(sum, hn::Load(block, sums + w / 2 + 4));
    hn::StoreU(sum, block, strip.products + u + w);
  }
}

template <int kWidth, class D>
HWY_INLINE void multiply(D d16, const ZmssdPatch& patch, int count, Strip& strip) {
  constexpr int kVector = static_cast<int>(hn::MaxLanes(D()));
  constexpr int kReach = kVector < kWidth ? kWidth : kVector;
  for (int from = 0; from < count; from += kReach)
    for (int u = from; u < std::min(from + kWidth, count); u += 4)
      multiply_four<kWidth>(d16, patch, u, strip);
}

// A vector serves several windows where there are enough of them.
template <int kWidth>
HWY_INLINE void multiply_best(const ZmssdPatch& patch, int count, Strip& strip) {
  const hn::CappedTag<std::int16_t, ZmssdPatch::kLanes> wide;
  const hn::CappedTag<std::int16_t, kWidth> narrow;
  if (2 * count > 3 * kWidth)
    multiply<kWidth>(wide, patch, count, strip);
  else
    multiply<kWidth>(narrow, patch, count, strip);
}

HWY_INLINE void finish(const ZmssdPatch& patch, int count, const Strip& strip, std::uint32_t* scores) {
  const hn::CappedTag<std::uint32_t, 8> d32;
  const hn::Rebind<std::uint16_t, decltype(d32)> d16;
  const auto n = hn::Set(d32, static_cast<std::uint32_t>(patch.size * patch.size));
  const auto patch_sum = hn::Set(d32, patch.sum), patch_squares = hn::Set(d32, patch.sum_of_squares);
  alignas(64) std::uint32_t all[kChunk];
  for (int u = 0; u < count; u += static_cast<int>(hn::Lanes(d32))) {
    auto sum = hn::Zero(d16);
    auto squares = hn::Zero(d32);
    for (int k = 0; k < patch.size; ++k) {
      sum = hn::Add(sum, hn::LoadU(d16, strip.sum + u + k));  // of 256 pixels fits
      squares = hn::Add(squares, hn::LoadU(d32, strip.sum_of_squares + u + k));
    }
    const auto products =
        hn::BitCast(d32, hn::LoadU(hn::RebindToSigned<decltype(d32)>(), strip.products + u));
    const auto ssd = hn::Sub(hn::Add(patch_squares, squares), hn::Add(products, products));
    const auto shift = hn::Sub(patch_sum, hn::PromoteTo(d32, sum));
    hn::Store(hn::Sub(hn::Mul(n, ssd), hn::Mul(shift, shift)), d32, all + u);
  }
  std::copy_n(all, count, scores);
}

void score_row(const ZmssdPatch& patch, const std::uint8_t* first, std::ptrdiff_t stride, std::size_t count,
               std::uint32_t* scores) {
  Strip strip;
  for (std::size_t done = 0; done < count; done += kChunk, first += kChunk, scores += kChunk) {
    const int windows = static_cast<int>(std::min<std::size_t>(count - done, kChunk));
    const int columns = windows + patch.size - 1;
    if (columns >= 16)
      widen_strip(hn::CappedTag<std::uint16_t, 16>(), first, stride, patch.size, columns, strip);
    else
      widen_strip(hn::CappedTag<std::uint16_t, 8>(), first, stride, patch.size, columns, strip);
    zero_behind(patch.size, columns, strip);
    if (patch.size == 8)
      multiply_best<8>(patch, windows, strip);
    else
      multiply_best<16>(patch, windows, strip);
    finish(patch, windows, strip, scores);
  }
}

#endif

}  // namespace waymark::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace waymark::kernels {

HWY_EXPORT(score_row);

ZmssdPatch make_zmssd_patch(const std::uint8_t* pixels, std::ptrdiff_t stride, int size) {
  ZmssdPatch patch;
  patch.size = size;
  const int width = size == 8 ? 8 : kMaxPatchSize;
  for (int r = 0; r < size; ++r) {
    for (int c = 0; c < size; ++c) {
      const std::uint8_t pixel = pixels[r * stride + c];
      patch.sum += pixel;
      patch.sum_of_squares += std::uint32_t{pixel} * pixel;
      for (int copy = c; copy < ZmssdPatch::kLanes; copy += width) patch.rows[r][copy] = pixel;
    }
  }
  return patch;
}

void zmssd_row(const ZmssdPatch& patch, const std::uint8_t* first, std::ptrdiff_t stride, std::size_t count,
               std::uint32_t* scores) {
  HWY_DYNAMIC_DISPATCH(score_row)(patch, first, stride, count, scores);
}

namespace reference {

std::uint32_t zmssd(const std::uint8_t* patch, std::ptrdiff_t patch_stride, const std::uint8_t* window,
                    std::ptrdiff_t window_stride, int size) {
  return plain_zmssd([&](int r, int c) { return patch[r * patch_stride + c]; }, window, window_stride, size);
}

}  // namespace reference
}  // namespace waymark::kernels
#endif
