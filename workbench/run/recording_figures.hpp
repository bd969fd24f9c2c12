#pragma once

#include <optional>
#include <vector>

#include "workbench/run/recording.hpp"

namespace waymark {

/// CPU time of the thread in steps that corrected: prediction, what looks into images, correction; us.
struct StepTimes {
  double mean_us = 0.0;
  double p50_us = 0.0;
  double p99_us = 0.0;
  double p999_us = 0.0;
  double max_us = 0.0;
};

[[nodiscard]] StepTimes step_times(const std::vector<Recording::TimedCost>& steps);

/// Steps that took longer than they may.
[[nodiscard]] std::int64_t deadline_misses(const Recording& recording);

/// The mean NIS per degree of freedom of the observations that were used.
[[nodiscard]] std::optional<double> nis_per_dof(const std::vector<Recording::TimedInnovation>& innovations);

}  // namespace waymark
