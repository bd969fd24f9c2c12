#pragma once

#include <vector>

#include "bench_result.hpp"
#include "machine.hpp"

namespace waymark::app {

/// FastSLAM: a landmark update of one particle by proposal and kind of observation, whole steps beside plain
/// implementations of the same step run in turn with them, and resampling by the size of the map.
[[nodiscard]] std::vector<BenchResult> bench_fastslam(const Machine& machine, BenchScope scope,
                                                      const BenchProgress& progress);

}  // namespace waymark::app
