// The rendered simulator: images per second of CPU time over a whole lap, in the order in which a filter sees
// them.
#include <algorithm>
#include <string>

#include <benchmark/benchmark.h>

#include "workbench/sim/camera_simulator.hpp"
#include "workbench/sim/rooms.hpp"

namespace waymark::sim {
namespace {

CameraSimulator camera_simulator_of(const std::string& name) {
  const SimOptions options = *scenario(name);
  const Path path = make_path(options.path, 1);
  return {options.camera_simulator, build_scene(options.room, path, 1), drive(path, options, 1), 1, 1};
}

void take_a_lap(benchmark::State& state, const std::string& name) {
  CameraSimulator camera_simulator = camera_simulator_of(name);
  for (auto _ : state)
    for (std::size_t i = 0; i < camera_simulator.size(); ++i)
      benchmark::DoNotOptimize(camera_simulator.take(i));
  const auto images = static_cast<double>(state.iterations()) * static_cast<double>(camera_simulator.size());
  state.counters["images/s"] = benchmark::Counter(images, benchmark::Counter::kIsRate);
}

void build(benchmark::State& state, const std::string& name) {
  const SimOptions options = *scenario(name);
  const Path path = make_path(options.path, 1);
  for (auto _ : state) benchmark::DoNotOptimize(build_scene(options.room, path, 1));
}

double largest(const std::vector<double>& values) { return *std::ranges::max_element(values); }
double smallest(const std::vector<double>& values) { return *std::ranges::min_element(values); }

void rounds(benchmark::internal::Benchmark* bench) {
  bench->Unit(benchmark::kMillisecond)
      ->Iterations(1)
      ->Repetitions(5)
      ->ReportAggregatesOnly()
      ->ComputeStatistics("max", largest)
      ->ComputeStatistics("min", smallest);
}

BENCHMARK_CAPTURE(take_a_lap, room, "room")->Apply(rounds);
BENCHMARK_CAPTURE(take_a_lap, corridor, "corridor")->Apply(rounds);
BENCHMARK_CAPTURE(build, room, "room")->Apply(rounds);
BENCHMARK_CAPTURE(build, corridor, "corridor")->Apply(rounds);

}  // namespace
}  // namespace waymark::sim
