#include "workbench/sim/trace_rays.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

#include "waymark/kernels/highway_targets.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "workbench/sim/trace_rays.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace waymark::kernels::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using FloatTag = hn::ScalableTag<float>;
using IntTag = hn::RebindToSigned<FloatTag>;
using Floats = hn::Vec<FloatTag>;
using Ints = hn::Vec<IntTag>;

constexpr FloatTag kFloats;
constexpr IntTag kInts;

HWY_INLINE Floats all(float value) { return hn::Set(kFloats, value); }
HWY_INLINE Ints all(std::int32_t value) { return hn::Set(kInts, value); }

// No fused multiply-add: every processor is to see the same image.
HWY_INLINE Floats along(const RayFunction& f, Floats x, Floats y) {
  return hn::Add(hn::Add(hn::Mul(all(f.x), x), hn::Mul(all(f.y), y)), all(f.z));
}

/// The nearest hit of each ray.
struct Hits {
  Floats w, s, t;
  Ints id;  ///< place among the rectangles, -1: none
};

HWY_INLINE Hits find_hits(Floats x, Floats y, const TexturedRectangle* rectangles, std::size_t count) {
  Hits best{hn::Zero(kFloats), hn::Zero(kFloats), hn::Zero(kFloats), all(-1)};
  for (std::size_t k = 0; k < count; ++k) {
    const TexturedRectangle& r = rectangles[k];
    const auto w = along(r.inverse_depth, x, y);
    const auto s = along(r.s, x, y);
    const auto t = along(r.t, x, y);
    const auto in_s = hn::And(hn::Ge(s, hn::Mul(all(r.s_min), w)), hn::Le(s, hn::Mul(all(r.s_max), w)));
    const auto in_t = hn::And(hn::Ge(t, hn::Mul(all(r.t_min), w)), hn::Le(t, hn::Mul(all(r.t_max), w)));
    const auto nearer = hn::And(hn::Gt(w, best.w), hn::And(in_s, in_t));
    best.w = hn::IfThenElse(nearer, w, best.w);
    best.s = hn::IfThenElse(nearer, s, best.s);
    best.t = hn::IfThenElse(nearer, t, best.t);
    best.id = hn::IfThenElse(hn::RebindMask(kInts, nearer), all(static_cast<std::int32_t>(k)), best.id);
  }
  return best;
}

#if HWY_TARGET <= HWY_AVX2
// Highway's gather; the address of a word need not be a multiple of four here.
HWY_INLINE Ints fetch(const std::uint16_t* texels, Ints place) {
  return hn::GatherOffset(kInts, reinterpret_cast<const std::int32_t*>(texels), hn::ShiftLeft<1>(place));
}
#else
HWY_INLINE Ints fetch(const std::uint16_t* texels, Ints place) {
  HWY_ALIGN std::int32_t places[hn::MaxLanes(IntTag())];
  HWY_ALIGN std::int32_t words[hn::MaxLanes(IntTag())];
  hn::Store(place, kInts, places);
  for (std::size_t i = 0; i < hn::Lanes(kInts); ++i) std::memcpy(&words[i], texels + places[i], 4);
  return hn::Load(kInts, words);
}
#endif

/// Where a coordinate falls in a level: the texel before it, and how far it is to the next in 1/128.
struct Place {
  Ints texel, fraction;
};

HWY_INLINE Place place_in(Ints coordinate, Ints level, std::int32_t log2_size) {
  const auto half = all(1 << 15);
  const auto scaled = hn::Sub(hn::Shr(coordinate, level), half);
  const auto mask = hn::Shr(all((1 << log2_size) - 1), level);
  return {hn::And(hn::ShiftRight<16>(scaled), mask), hn::And(hn::ShiftRight<9>(scaled), all(127))};
}

// first_column() and first_row() of layout.hpp, lane by lane.
HWY_INLINE Ints first_of(Ints level, std::int32_t log2_size) {
  const auto twice = all(2 << log2_size);
  return hn::Sub(twice, hn::Shr(twice, level));
}

/// Bilinear interpolation in units of 1/16384 grey. Two texels are weighted by one multiplication: their
/// products have 15 bits.
HWY_INLINE Ints blend(Ints four, Ints fraction_s, Ints fraction_t) {
  const auto mask = all(0x00FF00FF);
  const auto upper = hn::And(four, mask);
  const auto lower = hn::And(hn::ShiftRight<8>(four), mask);
  const auto both = hn::Add(hn::ShiftLeft<7>(upper), hn::Mul(hn::Sub(lower, upper), fraction_t));
  const auto left = hn::And(both, all(0xFFFF));
  const auto right = hn::And(hn::ShiftRight<16>(both), all(0xFFFF));
  return hn::Add(hn::ShiftLeft<7>(left), hn::Mul(hn::Sub(right, left), fraction_s));
}

/// A level with a fraction of 8 bits: log2 of the texels that a ray covers, from the bits of their square,
/// straight between powers of two.
HWY_INLINE Ints level_of(Floats squared, std::int32_t levels) {
  const auto bits = hn::Sub(hn::BitCast(kInts, squared), all(127 << 23));
  return hn::Min(hn::Max(hn::ShiftRight<16>(bits), hn::Zero(kInts)), all((levels - 1) * 256));
}

HWY_INLINE Floats mix(Floats a, Floats b, Floats fraction) {
  return hn::Add(a, hn::Mul(hn::Sub(b, a), fraction));
}

HWY_INLINE Floats fraction_of(Ints level) {
  return hn::Mul(hn::ConvertTo(kFloats, hn::And(level, all(255))), all(1.0F / 256.0F));
}

struct Column {
  Ints first;
  Place place;
};

HWY_INLINE Floats sample(const TexturedRectangle& r, const Column& column, const Place& row, Ints row_begin) {
  const auto place = hn::Add(row_begin, hn::Add(column.first, column.place.texel));
  return hn::ConvertTo(kFloats, blend(fetch(r.texels, place), column.place.fraction, row.fraction));
}

HWY_INLINE Column column_of(const TexturedRectangle& r, Ints s, Ints level) {
  return {hn::Add(first_of(level, r.layout.log2_width), level), place_in(s, level, r.layout.log2_width)};
}

HWY_INLINE Floats sample_row(const TexturedRectangle& r, const Column& fine, const Column& coarse, Ints t,
                             Ints level, Floats fraction_s) {
  const Place row = place_in(t, level, r.layout.log2_height);
  const auto begin =
      hn::Mul(hn::Add(first_of(level, r.layout.log2_height), row.texel), all(r.layout.pitch()));
  return mix(sample(r, fine, row, begin), sample(r, coarse, row, begin), fraction_s);
}

HWY_INLINE Floats sample_texture(const TexturedRectangle& r, Floats s, Floats t, Ints level_s, Ints level_t) {
  const auto s_fixed = hn::ConvertTo(kInts, hn::Mul(s, all(65536.0F)));
  const auto t_fixed = hn::ConvertTo(kInts, hn::Mul(t, all(65536.0F)));
  const auto last = all(r.layout.levels - 1);
  const auto fine_s = hn::ShiftRight<8>(level_s);
  const auto fine_t = hn::ShiftRight<8>(level_t);
  const Column fine = column_of(r, s_fixed, fine_s);
  const Column coarse = column_of(r, s_fixed, hn::Min(hn::Add(fine_s, all(1)), last));
  const auto fraction_s = fraction_of(level_s);
  const auto near = sample_row(r, fine, coarse, t_fixed, fine_t, fraction_s);
  const auto far = sample_row(r, fine, coarse, t_fixed, hn::Min(hn::Add(fine_t, all(1)), last), fraction_s);
  return hn::Mul(mix(near, far, fraction_of(level_t)), all(r.gain * (1.0F / 16384.0F)));
}

/// The square of how many texels a coordinate moves from a ray to its neighbours.
HWY_INLINE Floats reach_squared(const RayFunction& f, const RayFunction& w, Floats coordinate, Floats depth,
                                const Rays& rays) {
  const auto dx =
      hn::Mul(hn::Sub(all(f.x), hn::Mul(coordinate, all(w.x))), hn::Mul(depth, all(rays.spacing_x)));
  const auto dy =
      hn::Mul(hn::Sub(all(f.y), hn::Mul(coordinate, all(w.y))), hn::Mul(depth, all(rays.spacing_y)));
  return hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy));
}

HWY_INLINE Floats shade(const TexturedRectangle& r, const Hits& hits, const Rays& rays) {
  const auto depth = hn::Div(all(1.0F), hits.w);
  const auto s = hn::Mul(hits.s, depth);
  const auto t = hn::Mul(hits.t, depth);
  const auto level_s = level_of(reach_squared(r.s, r.inverse_depth, s, depth, rays), r.layout.levels);
  const auto level_t = level_of(reach_squared(r.t, r.inverse_depth, t, depth, rays), r.layout.levels);
  return sample_texture(r, s, t, level_s, level_t);
}

// Neighbouring rays mostly hit the same rectangle: one pass for each that is hit.
HWY_INLINE Floats shade_all(const Hits& hits, const std::int32_t* places, const Rays& rays,
                            const TexturedRectangle* rectangles) {
  auto grey = hn::Zero(kFloats);
  auto pending = hn::Gt(hits.id, all(-1));
  for (auto first = hn::FindFirstTrue(kInts, pending); first >= 0;
       first = hn::FindFirstTrue(kInts, pending)) {
    const std::int32_t place = places[first];
    const auto same = hn::Eq(hits.id, all(place));
    grey = hn::IfThenElse(hn::RebindMask(kFloats, same), shade(rectangles[place], hits, rays), grey);
    pending = hn::And(pending, hn::Not(same));
  }
  return grey;
}

void trace_lanes(const Rays& rays, std::size_t count, const TexturedRectangle* rectangles,
                 std::size_t rectangle_count, float* grey, std::int32_t* id) {
  const std::size_t lanes = hn::Lanes(kFloats);
  for (std::size_t i = 0; i < count; i += lanes) {
    const auto x = hn::Load(kFloats, rays.x + i);
    const auto y = hn::Load(kFloats, rays.y + i);
    const Hits hits = find_hits(x, y, rectangles, rectangle_count);
    hn::Store(hits.id, kInts, id + i);
    hn::Store(shade_all(hits, id + i, rays, rectangles), kFloats, grey + i);
    for (std::size_t j = i; j < i + lanes; ++j)
      if (id[j] >= 0) id[j] = rectangles[id[j]].id;
  }
}

}  // namespace waymark::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace waymark::kernels {

HWY_EXPORT(trace_lanes);

void trace_rays(const Rays& rays, std::size_t count, const TexturedRectangle* rectangles,
                std::size_t rectangle_count, float* grey, std::int32_t* id) {
  HWY_DYNAMIC_DISPATCH(trace_lanes)(rays, count, rectangles, rectangle_count, grey, id);
}

namespace reference {
namespace {

float along(const RayFunction& f, float x, float y) { return f.x * x + f.y * y + f.z; }

struct Hit {
  float w = 0.0F, s = 0.0F, t = 0.0F;
  const TexturedRectangle* rectangle = nullptr;
};

Hit nearest_hit(float x, float y, const TexturedRectangle* rectangles, std::size_t count) {
  Hit best;
  for (const TexturedRectangle* r = rectangles; r != rectangles + count; ++r) {
    const float w = along(r->inverse_depth, x, y);
    const float s = along(r->s, x, y);
    const float t = along(r->t, x, y);
    const bool inside = s >= r->s_min * w && s <= r->s_max * w && t >= r->t_min * w && t <= r->t_max * w;
    if (inside && w > best.w) best = {w, s, t, r};
  }
  return best;
}

int texel(const TexturedRectangle& r, int lu, int lv, int column, int row) {
  const MipmapLayout& layout = r.layout;
  const int u = column & (layout.width(lu) - 1);
  const int v = row & (layout.height(lv) - 1);
  return r.texels[(layout.first_row(lv) + v) * layout.pitch() + layout.first_column(lu) + u] & 0xFF;
}

float bilinear(const TexturedRectangle& r, int lu, int lv, int s, int t) {
  const int u = (s >> lu) - (1 << 15);
  const int v = (t >> lv) - (1 << 15);
  const int fs = (u >> 9) & 127;
  const int ft = (v >> 9) & 127;
  const auto at = [&](int du, int dv) { return texel(r, lu, lv, (u >> 16) + du, (v >> 16) + dv); };
  const int left = at(0, 0) * (128 - ft) + at(0, 1) * ft;
  const int right = at(1, 0) * (128 - ft) + at(1, 1) * ft;
  return static_cast<float>(left * (128 - fs) + right * fs);
}

int level_of(float squared, int levels) {
  return std::clamp((std::bit_cast<std::int32_t>(squared) - (127 << 23)) >> 16, 0, (levels - 1) * 256);
}

float reach_squared(const RayFunction& f, const RayFunction& w, float coordinate, float depth,
                    const Rays& rays) {
  const float dx = (f.x - coordinate * w.x) * (depth * rays.spacing_x);
  const float dy = (f.y - coordinate * w.y) * (depth * rays.spacing_y);
  return dx * dx + dy * dy;
}

float mix(float a, float b, int level) {
  return a + (b - a) * (static_cast<float>(level & 255) * (1.0F / 256.0F));
}

float sample_row(const TexturedRectangle& r, int s, int t, int level_s, int lv) {
  const int lu = level_s >> 8;
  const int coarse = std::min(lu + 1, r.layout.levels - 1);
  return mix(bilinear(r, lu, lv, s, t), bilinear(r, coarse, lv, s, t), level_s);
}

float shade(const TexturedRectangle& r, const Hit& hit, const Rays& rays) {
  const float depth = 1.0F / hit.w;
  const float s = hit.s * depth;
  const float t = hit.t * depth;
  const int level_s = level_of(reach_squared(r.s, r.inverse_depth, s, depth, rays), r.layout.levels);
  const int level_t = level_of(reach_squared(r.t, r.inverse_depth, t, depth, rays), r.layout.levels);
  const auto s_fixed = static_cast<std::int32_t>(s * 65536.0F);
  const auto t_fixed = static_cast<std::int32_t>(t * 65536.0F);
  const int lv = level_t >> 8;
  const int coarse = std::min(lv + 1, r.layout.levels - 1);
  return mix(sample_row(r, s_fixed, t_fixed, level_s, lv), sample_row(r, s_fixed, t_fixed, level_s, coarse),
             level_t) *
         (r.gain * (1.0F / 16384.0F));
}

}  // namespace

void trace_rays(const Rays& rays, std::size_t count, const TexturedRectangle* rectangles,
                std::size_t rectangle_count, float* grey, std::int32_t* id) {
  for (std::size_t i = 0; i < count; ++i) {
    const Hit hit = nearest_hit(rays.x[i], rays.y[i], rectangles, rectangle_count);
    grey[i] = hit.rectangle != nullptr ? shade(*hit.rectangle, hit, rays) : 0.0F;
    id[i] = hit.rectangle != nullptr ? hit.rectangle->id : -1;
  }
}

}  // namespace reference
}  // namespace waymark::kernels
#endif
