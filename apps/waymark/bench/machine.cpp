#include "machine.hpp"

#include <algorithm>
#include <fstream>
#include <thread>

#include "waymark/core/function_blocks.hpp"
#include "waymark/kernels/instruction_set.hpp"
#include "waymark/kernels/multiply_add.hpp"

namespace waymark::app {
namespace {

std::string cpu_name() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.starts_with("model name") && line.find(": ") != std::string::npos)
      return line.substr(line.find(": ") + 2);
  return "unknown";
}

/// The best of several rounds of CPU time: a peak is what nothing disturbed.
double fma_gflops() {
  constexpr std::size_t kRounds = 2'000'000;
  double best = 0.0;
  for (int i = 0; i < 7; ++i) {
    const Duration start = thread_cpu_time();
    const double flop = kernels::multiply_add(kRounds).flop;
    best = std::max(best, flop / static_cast<double>((thread_cpu_time() - start).count()));
  }
  return best;
}

}  // namespace

Machine inspect_machine() {
  return {cpu_name(), std::thread::hardware_concurrency(), kernels::instruction_set(), fma_gflops()};
}

}  // namespace waymark::app
