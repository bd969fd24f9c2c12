#include "waymark/kernels/particle_likelihood.hpp"

#include "waymark/kernels/highway_targets.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "waymark/kernels/particle_likelihood.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "waymark/kernels/particle_formulas-inl.h"

HWY_BEFORE_NAMESPACE();
namespace waymark::kernels::HWY_NAMESPACE {

constexpr double kLogTurn = 1.8378770664093453;  // log 2 pi

template <class T>
HWY_INLINE void list_as(const LandmarkObservation& observation, const Increment& increment,
                        const PoseColumns& before, float* log_likelihood, ParticleRange range) {
  const LandmarkObservation s = carried(observation, increment);
  const auto d = unseen<T>(increment);
  const T offset_x = T(s.landmark.offset_x);
  const T offset_y = T(s.landmark.offset_y);
  for (std::size_t i = 0; i < range.count; i += width_of<T>()) {
    const Pose<T> pose = load_pose<T>(before, i);
    const Sensor<T> from = sensor_of(pose, s.mount);
    const Gaussian2<T> m = load_gaussian<T>(s.landmark.modes->gaussian, range.begin + i);
    const Measured2<T> measured =
        measure_point(s.seen, range_of<T>(s.seen, range.begin + i), from, m, offset_x, offset_y);
    store(condition2(d, rows_of(measured, from, pose), measured, m).log_likelihood - T(kLogTurn),
          log_likelihood, i);
  }
}

void list_lanes(const LandmarkObservation& observation, const Increment& increment, const PoseColumns& before,
                float* log_likelihood, ParticleRange range) {
  list_as<Lanes>(observation, increment, before, log_likelihood, range);
}

}  // namespace waymark::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace waymark::kernels {

HWY_EXPORT(list_lanes);

void list_log_likelihoods(const LandmarkObservation& observation, const Increment& increment,
                          const PoseColumns& before, float* log_likelihood, ParticleRange range) {
  HWY_DYNAMIC_DISPATCH(list_lanes)(observation, increment, before, log_likelihood, range);
}

namespace reference {

void list_log_likelihoods(const LandmarkObservation& observation, const Increment& increment,
                          const PoseColumns& before, float* log_likelihood, ParticleRange range) {
  HWY_NAMESPACE::list_as<double>(observation, increment, before, log_likelihood, range);
}

}  // namespace reference
}  // namespace waymark::kernels
#endif
