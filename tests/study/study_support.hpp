#pragma once

#include <string>
#include <vector>

#include "workbench/study/sweep_plan.hpp"

namespace waymark::study::test {

/// Runs of a hundredth of a second: a small square driven once, fast.
inline SweepPlan quick_plan(std::vector<Axis> axes) {
  return {.input = "sim:square",
          .user = {.files = {}, .assignments = {"sim.side_m=2", "sim.speed_mps=1", "sim.landmarks=8"}},
          .blocks = {std::move(axes)}};
}

}  // namespace waymark::study::test
