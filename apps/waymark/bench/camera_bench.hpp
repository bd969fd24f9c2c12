#pragma once

#include <vector>

#include "bench_result.hpp"
#include "machine.hpp"

namespace waymark::app {

/// The camera system: its kernels on a rendered image, then whole frames and their function blocks on a
/// drive through the rendered room, as it is and in the article's mode, with the article's published times.
[[nodiscard]] std::vector<BenchResult> bench_camera(const Machine& machine, BenchScope scope,
                                                    const BenchProgress& progress);

}  // namespace waymark::app
