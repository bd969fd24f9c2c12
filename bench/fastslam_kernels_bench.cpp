// The kernels of a FastSLAM step, per particle: items are particles, or particle-landmarks where a landmark
// is seen.
#include <array>
#include <cmath>
#include <vector>

#include <benchmark/benchmark.h>

#include "waymark/core/aligned_array.hpp"
#include "waymark/core/random.hpp"
#include "waymark/kernels/particle_observations.hpp"
#include "waymark/kernels/particle_poses.hpp"

namespace waymark::kernels {
namespace {

constexpr std::size_t kCount = 256;  // a block of particles, as the filter takes them

// Particles near the origin that all know one landmark.
class Block {
 public:
  explicit Block(LandmarkForm form, ObservationKind kind, std::size_t modes = 1) {
    RandomStream random(1, StreamPurpose::kWorld);
    for (auto* column : {poses.x, poses.y})
      for (std::size_t i = 0; i < kCount; ++i) column[i] = static_cast<float>(0.1 * random.normal());
    for (std::size_t i = 0; i < kCount; ++i) poses.cos[i] = 1.0F;
    for (std::size_t k = 0; k < modes; ++k) modes_.push_back({gaussian(), column()});
    observation.seen = {kind, 5.0F, 0.8F, 0.6F, 0.01F, 0.0F, 0.001F};
    observation.landmark = {form, 0.0F, 0.0F, column(), column(), modes_.data(), modes};
    FirstGuess guess;
    for (std::size_t k = 0; k < modes; ++k)
      guess.modes[k] = {0.2F + 0.1F * static_cast<float>(k), 0.01F, -std::log(static_cast<float>(modes))};
    place_landmark(observation, guess, poses, range);
    fill_increments(increment, increments, kCount);
  }

  float* column() { return columns_.emplace_back(kCount).data(); }
  GaussianColumns gaussian() { return {column(), column(), column(), column(), column()}; }

 private:
  std::vector<AlignedArray<float>> columns_;
  std::vector<LandmarkMode> modes_;

 public:
  Increment increment{0.1F, 0.0F, 0.01F, 1e-4F, 0.0F, 0.0F, 1e-4F, 0.0F, 1e-4F};
  PoseColumns poses{column(), column(), column(), column()};
  IncrementColumns increments{column(), column(), column(), column(), column(),
                              column(), column(), column(), column()};
  std::array<float*, 3> normals{column(), column(), column()};
  AlignedArray<double> log_weight{kCount}, x_m{kCount}, y_m{kCount}, theta_rad{kCount};
  LandmarkObservation observation;
  ParticleRange range{0, kCount};
};

void count_items(benchmark::State& state) {
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kCount));
  state.counters["ns"] = benchmark::Counter(static_cast<double>(state.iterations()) * kCount * 1e-9,
                                            benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void update(benchmark::State& state, LandmarkForm form, ObservationKind kind, std::size_t modes) {
  Block block(form, kind, modes);
  for (auto _ : state)
    update_landmark(block.observation, block.poses, 1.0, block.log_weight.data(), block.range);
  count_items(state);
}

void update_plain(benchmark::State& state) {
  Block block(LandmarkForm::kPoint, ObservationKind::kRangeBearing);
  for (auto _ : state)
    reference::update_landmark(block.observation, block.poses, 1.0, block.log_weight.data(), block.range);
  count_items(state);
}

void condition(benchmark::State& state, LandmarkForm form, ObservationKind kind) {
  Block block(form, kind);
  for (auto _ : state)
    condition_increments(block.observation, block.increment, block.poses, 1.0, block.increments,
                         block.log_weight.data(), block.range);
  count_items(state);
}

void compare(benchmark::State& state) {
  Block block(LandmarkForm::kPoint, ObservationKind::kRangeBearing);
  for (auto _ : state)
    benchmark::DoNotOptimize(
        compare_observation(block.observation, {}, block.poses, {}, block.log_weight.data(), block.range));
  count_items(state);
}

void normals(benchmark::State& state) {
  Block block(LandmarkForm::kPoint, ObservationKind::kRangeBearing);
  DrawKey key;
  for (auto _ : state) {
    ++key.step;
    draw_normals(key, block.normals[0], block.normals[1], block.normals[2], kCount);
  }
  count_items(state);
}

void draw(benchmark::State& state) {
  Block block(LandmarkForm::kPoint, ObservationKind::kRangeBearing);
  const MovingPoses world{block.x_m.data(), block.y_m.data(), block.theta_rad.data()};
  for (auto _ : state)
    draw_poses(block.increments, block.increment, block.normals[0], block.normals[1], block.normals[2],
               block.poses, world, kCount);
  count_items(state);
}

void load(benchmark::State& state) {
  Block block(LandmarkForm::kPoint, ObservationKind::kRangeBearing);
  const WorldPoses world{block.x_m.data(), block.y_m.data(), block.theta_rad.data()};
  for (auto _ : state) load_poses(world, 0.0, 0.0, block.poses, kCount);
  count_items(state);
}

BENCHMARK_CAPTURE(update, range_bearing_of_point, LandmarkForm::kPoint, ObservationKind::kRangeBearing, 1);
BENCHMARK_CAPTURE(update, range_of_point, LandmarkForm::kPoint, ObservationKind::kRange, 1);
BENCHMARK_CAPTURE(update, bearing_of_point, LandmarkForm::kPoint, ObservationKind::kBearing, 1);
BENCHMARK_CAPTURE(update, bearing_of_ray, LandmarkForm::kRay, ObservationKind::kBearing, 1);
BENCHMARK_CAPTURE(update, range_of_ring, LandmarkForm::kRing, ObservationKind::kRange, 1);
BENCHMARK_CAPTURE(update, range_of_ring_of_8, LandmarkForm::kRing, ObservationKind::kRange, 8);
BENCHMARK(update_plain);
BENCHMARK_CAPTURE(condition, range_bearing_of_point, LandmarkForm::kPoint, ObservationKind::kRangeBearing);
BENCHMARK_CAPTURE(condition, bearing_of_ray, LandmarkForm::kRay, ObservationKind::kBearing);
BENCHMARK_CAPTURE(condition, range_of_ring, LandmarkForm::kRing, ObservationKind::kRange);
BENCHMARK(compare);
BENCHMARK(load);
BENCHMARK(normals);
BENCHMARK(draw);

}  // namespace
}  // namespace waymark::kernels
