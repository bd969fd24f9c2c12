#include "waymark/kernels/zmssd.hpp"

#include <algorithm>
#include <limits>

#include "waymark/kernels/highway_targets.hpp"

#ifndef WAYMARK_KERNELS_ZMSSD_PLAIN
#define WAYMARK_KERNELS_ZMSSD_PLAIN
namespace waymark::kernels {
namespace {

// Where column c of row r lies in the pairs of a patch.
template <class Patch>
auto& patch_pixel(Patch& patch, int r, int c) {
  const int row = r + patch.size % 2;
  return patch.pairs[row / 2][2 * c + row % 2];
}

}  // namespace
}  // namespace waymark::kernels
#endif

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "waymark/kernels/zmssd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace waymark::kernels::HWY_NAMESPACE {
#if HWY_TARGET == HWY_SCALAR

void search(const ZmssdPatch& patch, const std::uint8_t* pixels, std::ptrdiff_t stride, const WindowRow* rows,
            std::size_t row_count, std::uint32_t* scores) {
  reference::zmssd_search(patch, pixels, stride, rows, row_count, scores);
}

#else

namespace hn = hwy::HWY_NAMESPACE;

constexpr int kBand = 64;  // windows side by side
// The columns of image below a band of windows, and what vectors read behind them.
constexpr int kBehind = 32;
constexpr int kColumns = kBand + 2 * kMaxPatchSize + kBehind;
// Rows of image that are kept: those below the windows, the one that has just left them, and the next one.
// Pairs are kept twice, so that those below the windows always lie one behind the other.
constexpr int kRing = 32;
constexpr int kPairRing = 16;
alignas(64) constexpr std::int16_t kNone[kColumns] = {};

// What the windows of a row of a band have in common. Goes down the image row by row.
struct Band {
  alignas(64) std::int16_t pixels[kRing][kColumns];  // zero behind the last column
  alignas(
      64) std::int16_t pairs[2 * kPairRing][2 * kColumns];  // the row above and this one, column by column
  alignas(64) std::uint16_t sum[kColumns];                  // of each column of pixels as high as the windows
  alignas(64) std::uint32_t squares[kColumns];
  alignas(64) std::int32_t products[kColumns];  // sum d i of each window

  // The first pairs that the windows cover; the next ones are two rows further on.
  const std::int16_t* window_pairs = nullptr;
  int columns = 0;
  int from = 0, taken = 0;  // rows of image that were taken without a gap
  int summed = 0;           // those of them that have been in the sums
};

template <class Value>
HWY_INLINE void zero(Value* values, int count) {
  const hn::CappedTag<Value, 32 / sizeof(Value)> d;
  for (int k = 0; k < count; k += static_cast<int>(hn::Lanes(d))) hn::StoreU(hn::Zero(d), d, values + k);
}

// All columns of a row; the last vector overlaps the one before it instead of reading behind the row.
template <class D>
HWY_INLINE void inflate_covariance(D d16, const std::uint8_t* pixels, int columns, std::int16_t* wide) {
  const hn::Rebind<std::uint8_t, D> d8;
  const int lanes = static_cast<int>(hn::Lanes(d16));
  const auto widen_at = [&](int u) HWY_ATTR {
    hn::StoreU(hn::PromoteTo(d16, hn::LoadU(d8, pixels + u)), d16, wide + u);
  };
  for (int u = 0; u + lanes < columns; u += lanes) widen_at(u);
  widen_at(columns - lanes);
}

// Takes one row of pixels into the sums of the columns and another one out.
HWY_INLINE void exchange(const std::int16_t* come, const std::int16_t* leave, Band& band) {
  const hn::CappedTag<std::uint16_t, 16> d16;
  const hn::RebindToSigned<decltype(d16)> signed16;
  const hn::RepartitionToWide<decltype(d16)> d32;
  const int half = static_cast<int>(hn::Lanes(d32));
  for (int u = 0; u < band.columns; u += 2 * half) {
    const auto in = hn::BitCast(d16, hn::LoadU(signed16, come + u));
    const auto out = hn::BitCast(d16, hn::LoadU(signed16, leave + u));
    hn::Store(hn::Add(hn::Load(d16, band.sum + u), hn::Sub(in, out)), d16, band.sum + u);
    const auto squares_in = hn::Mul(in, in), squares_out = hn::Mul(out, out);  // 255^2 fits
    const auto add = [&](auto more, auto less, std::uint32_t* at) HWY_ATTR {
      const auto change = hn::Sub(hn::PromoteTo(d32, more), hn::PromoteTo(d32, less));
      hn::Store(hn::Add(hn::Load(d32, at), change), d32, at);
    };
    const hn::Half<decltype(d16)> d_half;
    add(hn::LowerHalf(squares_in), hn::LowerHalf(squares_out), band.squares + u);
    add(hn::UpperHalf(d_half, squares_in), hn::UpperHalf(d_half, squares_out), band.squares + u + half);
  }
}

HWY_INLINE void pair_up(const std::int16_t* upper, const std::int16_t* lower, int columns, std::int16_t* once,
                        std::int16_t* again) {
  const hn::FixedTag<std::int16_t, 8> d16;
  for (int u = 0; u < columns; u += 8) {
    const auto a = hn::LoadU(d16, upper + u), b = hn::LoadU(d16, lower + u);
    for (std::int16_t* pairs : {once, again}) {
      hn::StoreU(hn::InterleaveLower(d16, a, b), d16, pairs + 2 * u);
      hn::StoreU(hn::InterleaveUpper(d16, a, b), d16, pairs + 2 * u + 8);
    }
  }
}

constexpr unsigned slot(int v) { return static_cast<unsigned>(v) % kRing; }

// Widens the next row of image and pairs it with the one before.
HWY_INLINE void take_row(const std::uint8_t* row, Band& band) {
  std::int16_t* wide = band.pixels[slot(band.taken)];
  // NOLINTNEXTLINE(bugprone-branch-clone): the same where vectors have eight lanes
  if (band.columns >= 16)
    inflate_covariance(hn::CappedTag<std::int16_t, 16>(), row, band.columns, wide);
  else
    inflate_covariance(hn::CappedTag<std::int16_t, 8>(), row, band.columns, wide);
  const unsigned pair = static_cast<unsigned>(band.taken) % kPairRing;
  pair_up(band.taken > band.from ? band.pixels[slot(band.taken - 1)] : kNone, wide, band.columns,
          band.pairs[pair], band.pairs[pair + kPairRing]);
  ++band.taken;
}

// Goes down to the windows whose first pixels are in row v; `pixels` is that row. One more row of image is
// taken where there `is_next`: what has just been stored in parts cannot be loaded as a whole for a while.
HWY_INLINE void go_to_row(int v, const std::uint8_t* pixels, std::ptrdiff_t stride, int size, bool is_next,
                          Band& band) {
  if (band.summed <= v) {
    zero(band.sum, kColumns);
    zero(band.squares, kColumns);
    band.from = band.summed = band.taken = v;
  }
  while (band.taken < v + size + (is_next ? 1 : 0)) take_row(pixels + (band.taken - v) * stride, band);
  for (; band.summed < v + size; ++band.summed) {
    const int left = band.summed - size;
    exchange(band.pixels[slot(band.summed)], left >= band.from ? band.pixels[slot(left)] : kNone, band);
  }
  band.window_pairs = band.pairs[static_cast<unsigned>(v + 1 - size % 2) % kPairRing];
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

// sum d i of the windows u .. u + 3 of patches up to kWidth pixels wide.
template <int kWidth>
HWY_INLINE void multiply_four(const ZmssdPatch& patch, int u, Band& band) {
  const hn::CappedTag<std::int16_t, 2 * kWidth> d16;
  const hn::RepartitionToWide<decltype(d16)> d32;
  constexpr int kVector = static_cast<int>(hn::MaxLanes(decltype(d16)()));
  hn::Vec<decltype(d32)> even[4], odd[4];
  for (int k = 0; k < 4; ++k) even[k] = odd[k] = hn::Zero(d32);
  const std::int16_t* pixels = band.window_pairs + 2 * u;
  for (int pair = 0; 2 * pair < patch.size; ++pair, pixels += 2 * (2 * kColumns)) {
    for (int part = 0; part < 2 * kWidth; part += kVector) {
      const auto d = hn::Load(d16, &patch.pairs[pair][part]);
      for (int k = 0; k < 4; ++k) {
        const auto i = hn::LoadU(d16, pixels + 2 * k + part);
        even[k] = hn::ReorderWidenMulAccumulate(d32, d, i, even[k], odd[k]);
      }
    }
  }
  for (int k = 0; k < 4; ++k) even[k] = hn::Add(even[k], odd[k]);
  alignas(64) std::int32_t sums[kVector / 2];
  hn::Store(sums_of_blocks(even[0], even[1], even[2], even[3]), d32, sums);
  const hn::FixedTag<std::int32_t, 4> block;
  auto sum = hn::Load(block, sums);
  for (int k = 4; k < kVector / 2; k += 4) sum = hn::Add(sum, hn::Load(block, sums + k));
  hn::StoreU(sum, block, band.products + u);
}

template <int kWidth>
HWY_INLINE void multiply(const ZmssdPatch& patch, int begin, int end, Band& band) {
  for (int u = begin; u < end; u += 4) multiply_four<kWidth>(patch, u, band);
}

// The scores of the windows begin <= u < end.
HWY_INLINE void finish(const ZmssdPatch& patch, int begin, int end, const Band& band, std::uint32_t* scores) {
  const hn::CappedTag<std::uint16_t, 16> d16;
  const hn::RepartitionToWide<decltype(d16)> d32;
  const hn::RebindToSigned<decltype(d32)> signed32;
  const int half = static_cast<int>(hn::Lanes(d32));
  const auto n = hn::Set(d32, static_cast<std::uint32_t>(patch.size * patch.size));
  const auto patch_sum = hn::Set(d32, patch.sum), patch_squares = hn::Set(d32, patch.sum_of_squares);
  alignas(64) std::uint32_t all[kBand];
  const auto finish_half = [&](auto sum, auto squares, int u) HWY_ATTR {
    const auto products = hn::BitCast(d32, hn::LoadU(signed32, band.products + u));
    const auto ssd = hn::Sub(hn::Add(patch_squares, squares), hn::Add(products, products));
    const auto shift = hn::Sub(patch_sum, hn::PromoteTo(d32, sum));
    hn::Store(hn::Sub(hn::Mul(n, ssd), hn::Mul(shift, shift)), d32, all + (u - begin));  // Vincke (16)
  };
  for (int u = begin; u < end; u += 2 * half) {
    auto sum = hn::Zero(d16);
    auto squares_low = hn::Zero(d32), squares_high = hn::Zero(d32);
    for (int k = u; k < u + patch.size; ++k) {
      sum = hn::Add(sum, hn::LoadU(d16, band.sum + k));  // of 256 pixels fits
      squares_low = hn::Add(squares_low, hn::LoadU(d32, band.squares + k));
      squares_high = hn::Add(squares_high, hn::LoadU(d32, band.squares + k + half));
    }
    finish_half(hn::LowerHalf(sum), squares_low, u);
    finish_half(hn::UpperHalf(hn::Half<decltype(d16)>(), sum), squares_high, u + half);
  }
  std::copy_n(all, end - begin, scores);
}

// The windows of all rows in the columns first to first + width - 1.
void search_band(const ZmssdPatch& patch, const std::uint8_t* pixels, std::ptrdiff_t stride,
                 const WindowRow* rows, int last_row, int first, int width, std::uint32_t* scores) {
  Band band;
  band.columns = width + patch.size - 1;
  for (auto& row : band.pixels) zero(row + band.columns, kBehind);
  for (auto& row : band.pairs) zero(row + 2 * band.columns, 2 * kBehind);
  for (int v = 0; v <= last_row; scores += rows[v].count, ++v) {
    const int begin = std::max(rows[v].first - first, 0);
    const int end = std::min(rows[v].first + rows[v].count - first, width);
    if (begin >= end) continue;
    go_to_row(v, pixels + v * stride + first, stride, patch.size, v < last_row, band);
    if (patch.size == 8)
      multiply<8>(patch, begin, end, band);
    else
      multiply<16>(patch, begin, end, band);
    finish(patch, begin, end, band, scores + (first + begin - rows[v].first));
  }
}

void search(const ZmssdPatch& patch, const std::uint8_t* pixels, std::ptrdiff_t stride, const WindowRow* rows,
            std::size_t row_count, std::uint32_t* scores) {
  int first = std::numeric_limits<int>::max(), last = std::numeric_limits<int>::min();
  int last_row = -1;
  for (std::size_t k = 0; k < row_count; ++k) {
    if (rows[k].count <= 0) continue;
    last_row = static_cast<int>(k);
    first = std::min(first, rows[k].first);
    last = std::max(last, rows[k].first + rows[k].count);
  }
  for (; first < last; first += kBand)
    search_band(patch, pixels, stride, rows, last_row, first, std::min(last - first, kBand), scores);
}

#endif

}  // namespace waymark::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace waymark::kernels {

HWY_EXPORT(search);

ZmssdPatch make_zmssd_patch(const std::uint8_t* pixels, std::ptrdiff_t stride, int size) {
  ZmssdPatch patch;
  patch.size = size;
  for (int r = 0; r < size; ++r) {
    for (int c = 0; c < size; ++c) {
      const std::uint8_t pixel = pixels[r * stride + c];
      patch.sum += pixel;
      patch.sum_of_squares += std::uint32_t{pixel} * pixel;
      patch_pixel(patch, r, c) = pixel;
    }
  }
  return patch;
}

void zmssd_search(const ZmssdPatch& patch, const std::uint8_t* pixels, std::ptrdiff_t stride,
                  const WindowRow* rows, std::size_t row_count, std::uint32_t* scores) {
  HWY_DYNAMIC_DISPATCH(search)(patch, pixels, stride, rows, row_count, scores);
}

namespace reference {

std::uint32_t zmssd(const std::uint8_t* patch, std::ptrdiff_t patch_stride, const std::uint8_t* window,
                    std::ptrdiff_t window_stride, int size) {
  std::int64_t sum = 0, squares = 0;
  for (int r = 0; r < size; ++r) {
    for (int c = 0; c < size; ++c) {
      const int difference = patch[r * patch_stride + c] - window[r * window_stride + c];
      sum += difference;
      squares += difference * difference;
    }
  }
  // Vincke (14)
  return static_cast<std::uint32_t>(std::int64_t{size} * size * squares - sum * sum);  // Vincke (15)
}

void zmssd_search(const ZmssdPatch& patch, const std::uint8_t* pixels, std::ptrdiff_t stride,
                  const WindowRow* rows, std::size_t row_count, std::uint32_t* scores) {
  std::uint8_t plain[kMaxPatchSize * kMaxPatchSize];
  for (int r = 0; r < patch.size; ++r)
    for (int c = 0; c < patch.size; ++c)
      plain[r * patch.size + c] = static_cast<std::uint8_t>(patch_pixel(patch, r, c));
  for (std::size_t k = 0; k < row_count; ++k, pixels += stride)
    for (int u = rows[k].first; u < rows[k].first + rows[k].count; ++u)
      *scores++ = zmssd(plain, patch.size, pixels + u, stride, patch.size);
}

}  // namespace reference
}  // namespace waymark::kernels
#endif
