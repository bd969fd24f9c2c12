#pragma once

#include <vector>

#include "bench_result.hpp"
#include "machine.hpp"

namespace waymark::app {

/// EKF-SLAM steps by map size and mode, beside plain implementations of the same step run in turn with them
/// and the time that the arithmetic alone needs on this machine.
[[nodiscard]] std::vector<BenchResult> bench_ekf(const Machine& machine, BenchScope scope,
                                                 const BenchProgress& progress);

}  // namespace waymark::app
