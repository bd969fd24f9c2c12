#include "waymark/kernels/particle_existence.hpp"

#include "waymark/kernels/highway_targets.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "waymark/kernels/particle_existence.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "waymark/kernels/particle_formulas-inl.h"

HWY_BEFORE_NAMESPACE();
namespace waymark::kernels::HWY_NAMESPACE {

constexpr float kDeviations = 3.0F;
constexpr float kAllRound = 3.14F;

// How far inside the view a landmark is expected, the nearest edge counting: negative is outside or unsure.
template <class T>
HWY_INLINE T depth_inside(const SensorView& view, const Sensor<T>& from, const Gaussian2<T>& m, T ox, T oy) {
  const Ray<T> ray = ray_of(m.a + ox - from.x, m.b + oy - from.y);
  const T zero = T(0.0F);
  const RayCovariance<T> S = along_ray(Measured2<T>{ray, zero, zero, zero, zero, zero}, m);
  const T margin_r = T(kDeviations) * square_root(S.aa + T(view.range_var));
  const T far = T(view.max_range) - ray.r - margin_r;
  const T near = ray.r - margin_r - T(view.min_range);
  T inside = where_less(far, near, far, near);
  if (view.mount.half_view < kAllRound) {
    const T sigma = square_root(S.tt * ray.inverse_r * ray.inverse_r + T(view.bearing_var));
    const T aside =
        (T(view.mount.half_view) - absolute(off_axis(view.mount, from, ray))) / sigma - T(kDeviations);
    inside = where_less(aside, inside, aside, inside);
  }
  return inside;
}

template <class T>
HWY_INLINE void miss_as(const LandmarkView& landmark, const PoseColumns& sensors, const SensorView& view,
                        float change, float* log_odds, ParticleRange range) {
  const T zero = T(0.0F);
  for (std::size_t k = 0; k < range.count; k += width_of<T>()) {
    const std::size_t i = range.begin + k;
    const Pose<T> pose = load_pose<T>(sensors, k);
    const Sensor<T> from{pose.x, pose.y, pose.c, pose.s, zero, zero};
    const Gaussian2<T> m = load_gaussian<T>(landmark.modes->gaussian, i);
    const T inside = depth_inside(view, from, m, T(landmark.offset_x), T(landmark.offset_y));
    const T before = load<T>(log_odds, i);
    const T after = before + where_less(zero, inside, T(change), zero);
    store(where_less(after, zero, T(kAbsent), after), log_odds, i);
  }
}

void miss_lanes(const LandmarkView& landmark, const PoseColumns& sensors, const SensorView& view,
                float change, float* log_odds, ParticleRange range) {
  miss_as<Lanes>(landmark, sensors, view, change, log_odds, range);
}

}  // namespace waymark::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace waymark::kernels {

HWY_EXPORT(miss_lanes);

void miss_landmark(const LandmarkView& landmark, const PoseColumns& sensors, const SensorView& view,
                   float change, float* log_odds, ParticleRange range) {
  HWY_DYNAMIC_DISPATCH(miss_lanes)(landmark, sensors, view, change, log_odds, range);
}

namespace reference {

void miss_landmark(const LandmarkView& landmark, const PoseColumns& sensors, const SensorView& view,
                   float change, float* log_odds, ParticleRange range) {
  HWY_NAMESPACE::miss_as<double>(landmark, sensors, view, change, log_odds, range);
}

}  // namespace reference
}  // namespace waymark::kernels
#endif
