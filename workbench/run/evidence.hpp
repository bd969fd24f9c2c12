#pragma once

#include <cstddef>

#include "waymark/core/filter_health.hpp"

#include "workbench/run/recording.hpp"

namespace waymark {

/// A mean of squares over what it is if covariances are right: by what factor these are too small.
struct VarianceRatio {
  double value = 1.0;
  double dof = 0.0;  ///< independent normal variables that the mean is of; 0: there are none
};

/// How badly one scan fits the map: how many of its observations, of those of unknown identity, match no
/// landmark.
struct Misfit {
  double since_start_s = 0.0;
  int observations = 0;
  int unmatched = 0;
  double log_probability = 0.0;  ///< that some scan of the run is as bad by chance, an upper bound
};

/// The part of a sensor's observations that may be false: what FaultIsolation allows for.
inline constexpr double kManyOutliers = 0.1;

/// Successive innovations of one landmark that are summed.
inline constexpr int kInnovationBlock = 10;

/// What a run tells of its own quality, without truth. docs/fault-isolation.md, "Verdict", has the formulas
/// and what each part finds.
struct Evidence {
  std::size_t matched = 0;    ///< observations
  std::size_t gated = 0;      ///< observations that the gate rejected
  std::size_t deferred = 0;   ///< observations kept until their landmark can be placed
  VarianceRatio innovations;  ///< of single innovations: the median NIS over that of chi-square
  VarianceRatio blocks;       ///< of sums of successive innovations of one landmark
  VarianceRatio departure;    ///< of the path from odometry, metre by metre
  double travelled_m = 0.0;
  double unaided_m = 0.0;  ///< of it in stretches of a metre and more in which no landmark was observed again
  Misfit misfit;           ///< of the scan that fits worst
  FilterHealth health;
};

/// O(trajectory + innovations log landmarks).
[[nodiscard]] Evidence gather_evidence(const Recording& recording);

}  // namespace waymark
