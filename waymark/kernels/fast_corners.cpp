#include "waymark/kernels/fast_corners.hpp"

#include <algorithm>

// What all instruction sets share, once.

#include "waymark/kernels/highway_targets.hpp"

#ifndef WAYMARK_KERNELS_FAST_CORNERS_PLAIN
#define WAYMARK_KERNELS_FAST_CORNERS_PLAIN
namespace waymark::kernels {
namespace {

// The circle, clockwise from the pixel above.
constexpr int kCircle[16][2] = {{0, -3}, {1, -3}, {2, -2}, {3, -1}, {3, 0},  {3, 1},   {2, 2},   {1, 3},
                                {0, 3},  {-1, 3}, {-2, 2}, {-3, 1}, {-3, 0}, {-3, -1}, {-2, -2}, {-1, -3}};

struct Circle {
  explicit Circle(std::ptrdiff_t stride) {
    for (int k = 0; k < 16; ++k) at[k] = kCircle[k][1] * stride + kCircle[k][0];
  }
  std::ptrdiff_t at[16];
};

bool is_largest(const std::uint8_t* above, const std::uint8_t* row, const std::uint8_t* below) {
  const std::uint8_t others =
      std::max({above[-1], above[0], above[1], row[-1], row[1], below[-1], below[0], below[1]});
  return *row > others;
}

}  // namespace
}  // namespace waymark::kernels
#endif

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "waymark/kernels/fast_corners.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace waymark::kernels::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

const hn::ScalableTag<std::uint8_t> kTag;
using Bytes = hn::Vec<hn::ScalableTag<std::uint8_t>>;

HWY_INLINE Bytes min_of(Bytes a, Bytes b) { return hn::Min(a, b); }
HWY_INLINE Bytes max_of(Bytes a, Bytes b) { return hn::Max(a, b); }

// The largest, over all arcs, of the smallest of the 16 values on an arc. Two arcs that begin at k and k + 1
// (k even) share all but their ends, so eight runs of kArc - 1 values do.
template <int kArc>
HWY_INLINE Bytes best_arc(const Bytes* d) {
  Bytes pairs[8], fours[8];  // from the odd places 2 j + 1
  for (int j = 0; j < 8; ++j) pairs[j] = min_of(d[2 * j + 1], d[(2 * j + 2) % 16]);
  for (int j = 0; j < 8; ++j) fours[j] = min_of(pairs[j], pairs[(j + 1) % 8]);
  Bytes best = hn::Zero(kTag);
  for (int j = 0; j < 8; ++j) {
    Bytes shared = min_of(fours[j], fours[(j + 2) % 8]);
    if constexpr (kArc == 10) shared = min_of(shared, d[(2 * j + 9) % 16]);
    if constexpr (kArc >= 11) shared = min_of(shared, pairs[(j + 4) % 8]);
    if constexpr (kArc == 12) shared = min_of(shared, d[(2 * j + 11) % 16]);
    best = max_of(best, min_of(shared, max_of(d[2 * j], d[(2 * j + kArc) % 16])));
  }
  return best;
}

// An arc of nine or more holds one of any two opposite pixels: where a pair fails no corner is.
template <int kArc>
HWY_INLINE Bytes score_vector(const std::uint8_t* first, const Circle& circle, Bytes threshold) {
  const Bytes centre = hn::LoadU(kTag, first);
  Bytes brighter[16], darker[16];
  const auto load = [&](int k) HWY_ATTR {
    const Bytes pixel = hn::LoadU(kTag, first + circle.at[k]);
    brighter[k] = hn::SaturatedSub(pixel, centre);
    darker[k] = hn::SaturatedSub(centre, pixel);
  };
  Bytes possible_brighter = hn::Set(kTag, 255), possible_darker = possible_brighter;
  const auto test_pair = [&](int k) HWY_ATTR {
    load(k);
    load(k + 8);
    possible_brighter = min_of(possible_brighter, max_of(brighter[k], brighter[k + 8]));
    possible_darker = min_of(possible_darker, max_of(darker[k], darker[k + 8]));
    const Bytes possible = max_of(possible_brighter, possible_darker);
    return !hn::AllTrue(kTag, hn::Eq(hn::SaturatedSub(possible, threshold), hn::Zero(kTag)));
  };
  const auto test_pairs = [&](int k) HWY_ATTR {
    test_pair(k);
    return test_pair(k + 4);
  };
  if (!test_pairs(0) || !test_pairs(2)) return hn::Zero(kTag);
  for (const int k : {1, 3, 5, 7}) {
    load(k);
    load(k + 8);
  }
  const Bytes margin = max_of(best_arc<kArc>(brighter), best_arc<kArc>(darker));
  const auto is_corner = hn::Ne(hn::SaturatedSub(margin, threshold), hn::Zero(kTag));
  return hn::IfThenElseZero(is_corner, hn::Sub(margin, hn::Set(kTag, 1)));
}

template <int kArc>
bool score_row(const std::uint8_t* first, std::ptrdiff_t stride, std::size_t count, std::uint8_t threshold,
               std::uint8_t* scores) {
  const Circle circle(stride);
  const std::size_t lanes = hn::Lanes(kTag);
  if (count < lanes) return reference::fast_scores(first, stride, count, threshold, kArc, scores);
  const Bytes least = hn::Set(kTag, threshold);
  Bytes any = hn::Zero(kTag);
  // The last vector overlaps the one before it.
  for (std::size_t k = 0; k < count; k += lanes) {
    const std::size_t at = std::min(k, count - lanes);
    const Bytes found = score_vector<kArc>(first + at, circle, least);
    hn::StoreU(found, kTag, scores + at);
    any = hn::Or(any, found);
  }
  return !hn::AllTrue(kTag, hn::Eq(any, hn::Zero(kTag)));
}

bool score_row_9(const std::uint8_t* f, std::ptrdiff_t s, std::size_t n, std::uint8_t t, std::uint8_t* out) {
  return score_row<9>(f, s, n, t, out);
}
bool score_row_10(const std::uint8_t* f, std::ptrdiff_t s, std::size_t n, std::uint8_t t, std::uint8_t* out) {
  return score_row<10>(f, s, n, t, out);
}
bool score_row_11(const std::uint8_t* f, std::ptrdiff_t s, std::size_t n, std::uint8_t t, std::uint8_t* out) {
  return score_row<11>(f, s, n, t, out);
}
bool score_row_12(const std::uint8_t* f, std::ptrdiff_t s, std::size_t n, std::uint8_t t, std::uint8_t* out) {
  return score_row<12>(f, s, n, t, out);
}

HWY_INLINE Bytes largest_of_three(const std::uint8_t* at) {
  return max_of(max_of(hn::LoadU(kTag, at - 1), hn::LoadU(kTag, at + 1)), hn::LoadU(kTag, at));
}

std::size_t find_largest(const std::uint8_t* above, const std::uint8_t* row, const std::uint8_t* below,
                         std::size_t count, std::int32_t* places) {
  const std::size_t lanes = hn::Lanes(kTag);
  std::size_t found = 0, k = 0;
  for (; k + lanes <= count; k += lanes) {
    const Bytes here = hn::LoadU(kTag, row + k);
    if (hn::AllTrue(kTag, hn::Eq(here, hn::Zero(kTag)))) continue;
    const Bytes beside = max_of(hn::LoadU(kTag, row + k - 1), hn::LoadU(kTag, row + k + 1));
    const Bytes others = max_of(beside, max_of(largest_of_three(above + k), largest_of_three(below + k)));
    const auto is_largest = hn::Ne(hn::SaturatedSub(here, others), hn::Zero(kTag));
    alignas(64) std::uint8_t lane_is_largest[64];
    hn::Store(hn::IfThenElseZero(is_largest, here), kTag, lane_is_largest);
    for (std::size_t lane = 0; lane < lanes; ++lane)
      if (lane_is_largest[lane] != 0) places[found++] = static_cast<std::int32_t>(k + lane);
  }
  for (; k < count; ++k)
    if (kernels::is_largest(above + k, row + k, below + k)) places[found++] = static_cast<std::int32_t>(k);
  return found;
}

}  // namespace waymark::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace waymark::kernels {

HWY_EXPORT(score_row_9);
HWY_EXPORT(score_row_10);
HWY_EXPORT(score_row_11);
HWY_EXPORT(score_row_12);
HWY_EXPORT(find_largest);

bool fast_scores(const std::uint8_t* first, std::ptrdiff_t stride, std::size_t count, std::uint8_t threshold,
                 int arc, std::uint8_t* scores) {
  switch (arc) {
    case 9:
      return HWY_DYNAMIC_DISPATCH(score_row_9)(first, stride, count, threshold, scores);
    case 10:
      return HWY_DYNAMIC_DISPATCH(score_row_10)(first, stride, count, threshold, scores);
    case 11:
      return HWY_DYNAMIC_DISPATCH(score_row_11)(first, stride, count, threshold, scores);
    default:
      return HWY_DYNAMIC_DISPATCH(score_row_12)(first, stride, count, threshold, scores);
  }
}

std::size_t largest_scores(const std::uint8_t* above, const std::uint8_t* row, const std::uint8_t* below,
                           std::size_t count, std::int32_t* places) {
  return HWY_DYNAMIC_DISPATCH(find_largest)(above, row, below, count, places);
}

namespace reference {

std::uint8_t fast_score(const std::uint8_t* pixel, std::ptrdiff_t stride, std::uint8_t threshold, int arc) {
  const Circle circle(stride);
  int margin = 0;
  for (int start = 0; start < 16; ++start) {
    int brighter = 255, darker = 255;
    for (int k = start; k < start + arc; ++k) {
      const int difference = pixel[circle.at[k % 16]] - *pixel;
      brighter = std::min(brighter, difference);
      darker = std::min(darker, -difference);
    }
    margin = std::max({margin, brighter, darker});
  }
  return margin > threshold ? static_cast<std::uint8_t>(margin - 1) : std::uint8_t{0};
}

bool fast_scores(const std::uint8_t* first, std::ptrdiff_t stride, std::size_t count, std::uint8_t threshold,
                 int arc, std::uint8_t* scores) {
  const Circle circle(stride);
  const int least = arc / 4;  // pixels of the compass in an arc
  bool any = false;
  for (const std::uint8_t* pixel = first; pixel < first + count; ++pixel, ++scores) {
    int brighter = 0, darker = 0;
    for (int k = 0; k < 16; k += 4) {
      const int difference = pixel[circle.at[k]] - *pixel;
      brighter += difference > threshold;
      darker += difference < -threshold;
    }
    *scores =
        std::max(brighter, darker) < least ? std::uint8_t{0} : fast_score(pixel, stride, threshold, arc);
    any |= *scores != 0;
  }
  return any;
}

}  // namespace reference
}  // namespace waymark::kernels
#endif
