#include "waymark/kernels/particle_poses.hpp"

#include <cmath>
#include <numbers>

#include "waymark/kernels/highway_targets.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "waymark/kernels/particle_poses.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "waymark/kernels/particle_formulas-inl.h"
#include "waymark/kernels/philox-inl.h"

HWY_BEFORE_NAMESPACE();
namespace waymark::kernels::HWY_NAMESPACE {

template <class T>
HWY_INLINE void headings(const PoseColumns& poses, std::size_t count) {
  for (std::size_t i = 0; i < count; i += width_of<T>()) {
    const auto heading = sin_cos(load<T>(poses.cos, i));
    store(heading.cos, poses.cos, i);
    store(heading.sin, poses.sin, i);
  }
}

// The heading waits in the column of cosines.
HWY_INLINE void subtract_origin(const WorldPoses& world, double origin_x, double origin_y,
                                const PoseColumns& poses, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) poses.x[i] = static_cast<float>(world.x_m[i] - origin_x);
  for (std::size_t i = 0; i < count; ++i) poses.y[i] = static_cast<float>(world.y_m[i] - origin_y);
  for (std::size_t i = 0; i < count; ++i) poses.cos[i] = static_cast<float>(world.theta_rad[i]);
}

template <class T>
HWY_INLINE void load_all(const WorldPoses& world, double origin_x, double origin_y, const PoseColumns& poses,
                         std::size_t count) {
  subtract_origin(world, origin_x, origin_y, poses, count);
  headings<T>(poses, count);
}

void load_lanes(const WorldPoses& world, double origin_x, double origin_y, const PoseColumns& poses,
                std::size_t count) {
  load_all<Lanes>(world, origin_x, origin_y, poses, round_up_particles(count));
}

void place_sensor_lanes(const PoseColumns& robots, const SensorMount& mount, const PoseColumns& sensors,
                        std::size_t count) {
  for (std::size_t i = 0; i < count; i += lane_count()) {
    const Sensor<Lanes> sensor = sensor_of(load_pose<Lanes>(robots, i), mount);
    store_pose(Pose<Lanes>{sensor.x, sensor.y, sensor.c, sensor.s}, sensors, i);
  }
}

// sqrt(-2 log u) with u in (0, 1) of 31 bits.
HWY_INLINE Lanes radius_from(Words w) {
  const Lanes bits = hn::ConvertTo(FloatTag(), hn::BitCast(IntTag(), hn::ShiftRight<1>(w)));
  return square_root(larger(logarithm((bits + 0.5F) * 0x1.0p-31F) * -2.0F, 0.0F));
}

// An angle of 32 bits in [-pi, pi].
HWY_INLINE SinCos<Lanes> direction_from(Words w) {
  const Lanes bits = hn::ConvertTo(FloatTag(), hn::BitCast(IntTag(), w));
  return sin_cos(bits * static_cast<float>(std::numbers::pi * 0x1.0p-31));
}

void normals_lanes(const DrawKey& key, float* n0, float* n1, float* n2, std::size_t count) {
  const WordTag words;
  const auto high = hn::Set(words, (key.purpose << 24) ^ static_cast<std::uint32_t>(key.step >> 32));
  const auto low = hn::Set(words, static_cast<std::uint32_t>(key.step));
  for (std::size_t i = 0; i < count; i += lane_count()) {
    const auto particle = hn::Iota(words, key.first + static_cast<std::uint32_t>(i));
    const PhiloxWords random = philox({hn::Zero(words), high, low, particle}, key.seed);
    const Lanes near = radius_from(random.w0);
    const SinCos<Lanes> direction = direction_from(random.w1);
    store(near * direction.cos, n0, i);
    store(near * direction.sin, n1, i);
    store(radius_from(random.w2) * direction_from(random.w3).cos, n2, i);
  }
}

void fill_lanes(const Increment& d, const IncrementColumns& increments, std::size_t count) {
  const auto all = unseen<Lanes>(d);
  for (std::size_t i = 0; i < count; i += lane_count()) store_increment(all, increments, i);
}

HWY_INLINE void add_to_world(const float* dx, const float* dy, const float* dt, const MovingPoses& world,
                             std::size_t begin, std::size_t count) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  for (std::size_t i = 0; i < count; ++i) {
    world.x_m[begin + i] += static_cast<double>(dx[i]);
    world.y_m[begin + i] += static_cast<double>(dy[i]);
    const double theta = world.theta_rad[begin + i] + static_cast<double>(dt[i]);
    world.theta_rad[begin + i] = theta - kTurn * std::rint(theta / kTurn);
  }
}

template <class T>
HWY_INLINE void draw_all(const IncrementColumns& increments, const Increment& expected, const float* n0,
                         const float* n1, const float* n2, const PoseColumns& robots,
                         const MovingPoses& world, std::size_t count) {
  alignas(64) float dx[kParticleLanes];
  alignas(64) float dy[kParticleLanes];
  alignas(64) float dt[kParticleLanes];
  for (std::size_t i = 0; i < count; i += width_of<T>()) {
    const Pose<T> before = load_pose<T>(robots, i);
    const Column3<T> d =
        // Francisco (5)
        draw_from(load_increment<T>(increments, i), load<T>(n0, i), load<T>(n1, i), load<T>(n2, i));
    const Pose<T> swung = moved(before, d.x, d.y, d.t);
    const Pose<T> after = moved(swung, T(expected.x), T(expected.y), T(expected.t));
    store_pose(after, robots, i);
    store(before.c * d.x - before.s * d.y + swung.c * T(expected.x) - swung.s * T(expected.y), dx, 0);
    store(before.s * d.x + before.c * d.y + swung.s * T(expected.x) + swung.c * T(expected.y), dy, 0);
    store(d.t + T(expected.t), dt, 0);
    add_to_world(dx, dy, dt, world, i, width_of<T>());
  }
}

void draw_lanes(const IncrementColumns& increments, const Increment& expected, const float* n0,
                const float* n1, const float* n2, const PoseColumns& robots, const MovingPoses& world,
                std::size_t count) {
  draw_all<Lanes>(increments, expected, n0, n1, n2, robots, world, count);
}

}  // namespace waymark::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace waymark::kernels {

HWY_EXPORT(load_lanes);
HWY_EXPORT(place_sensor_lanes);
HWY_EXPORT(fill_lanes);
HWY_EXPORT(normals_lanes);
HWY_EXPORT(draw_lanes);

void load_poses(const WorldPoses& world, double origin_x, double origin_y, const PoseColumns& poses,
                std::size_t count) {
  HWY_DYNAMIC_DISPATCH(load_lanes)(world, origin_x, origin_y, poses, count);
}

void place_sensors(const PoseColumns& robots, const SensorMount& mount, const PoseColumns& sensors,
                   std::size_t count) {
  HWY_DYNAMIC_DISPATCH(place_sensor_lanes)(robots, mount, sensors, count);
}

void fill_increments(const Increment& increment, const IncrementColumns& increments, std::size_t count) {
  HWY_DYNAMIC_DISPATCH(fill_lanes)(increment, increments, count);
}

void draw_normals(const DrawKey& key, float* n0, float* n1, float* n2, std::size_t count) {
  HWY_DYNAMIC_DISPATCH(normals_lanes)(key, n0, n1, n2, count);
}

void draw_poses(const IncrementColumns& increments, const Increment& expected, const float* n0,
                const float* n1, const float* n2, const PoseColumns& robots, const MovingPoses& world,
                std::size_t count) {
  HWY_DYNAMIC_DISPATCH(draw_lanes)(increments, expected, n0, n1, n2, robots, world, count);
}

namespace reference {

void load_poses(const WorldPoses& world, double origin_x, double origin_y, const PoseColumns& poses,
                std::size_t count) {
  HWY_NAMESPACE::load_all<double>(world, origin_x, origin_y, poses, count);
}

void draw_poses(const IncrementColumns& increments, const Increment& expected, const float* n0,
                const float* n1, const float* n2, const PoseColumns& robots, const MovingPoses& world,
                std::size_t count) {
  HWY_NAMESPACE::draw_all<double>(increments, expected, n0, n1, n2, robots, world, count);
}

}  // namespace reference
}  // namespace waymark::kernels
#endif
