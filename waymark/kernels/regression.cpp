#include "waymark/kernels/regression.hpp"

#include "waymark/kernels/highway_targets.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "waymark/kernels/regression.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "waymark/kernels/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace waymark::kernels::HWY_NAMESPACE {

template <class T>
HWY_INLINE RegressionSums sum_as(const float* values, float base, const float* weight, const float* delta,
                                 std::size_t count) {
  T d = T(0.0F);
  T d_delta = T(0.0F);
  T d_d = T(0.0F);
  for (std::size_t i = 0; i < count; i += width_of<T>()) {
    // What weighs nothing, padding among it, may hold anything.
    const T w = load<T>(weight, i);
    const T difference = where_less(T(0.0F), w, load<T>(values, i) - T(base), T(0.0F));
    const T weighted = w * difference;
    d = d + weighted;
    d_delta = d_delta + weighted * load<T>(delta, i);
    d_d = d_d + weighted * difference;
  }
  return {sum_of(d), sum_of(d_delta), sum_of(d_d)};
}

RegressionSums sum_lanes(const float* values, float base, const float* weight, const float* delta,
                         std::size_t count) {
  return sum_as<Lanes>(values, base, weight, delta, count);
}

void add_lanes(float factor, const float* step, float* values, std::size_t count) {
  for (std::size_t i = 0; i < count; i += lane_count())
    store(load<Lanes>(values, i) + load<Lanes>(step, i) * Lanes(factor), values, i);
}

}  // namespace waymark::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace waymark::kernels {

HWY_EXPORT(sum_lanes);
HWY_EXPORT(add_lanes);

RegressionSums sum_regression(const float* values, float base, const float* weight, const float* delta,
                              std::size_t count) {
  return HWY_DYNAMIC_DISPATCH(sum_lanes)(values, base, weight, delta, count);
}

void add_scaled(float factor, const float* step, float* values, std::size_t count) {
  HWY_DYNAMIC_DISPATCH(add_lanes)(factor, step, values, count);
}

namespace reference {

RegressionSums sum_regression(const float* values, float base, const float* weight, const float* delta,
                              std::size_t count) {
  return HWY_NAMESPACE::sum_as<double>(values, base, weight, delta, count);
}

}  // namespace reference
}  // namespace waymark::kernels
#endif
