#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "waymark/core/angle.hpp"
#include "waymark/ekf/state.hpp"

namespace waymark::study {

/// A robot drives loops of 200 steps and 7.5 m radius among landmarks beside its path, whose identities it
/// knows and which it sees within 8 m; every run has a world and noise of its own.
struct ConsistencyOptions {
  int runs = 60;
  int steps = 800;
  int landmarks = 20;
  double odometry_sigma_m = 0.02;  ///< per step, each of x and y
  double odometry_sigma_rad = to_radians(1.0);
  double range_sigma_m = 0.15;
  double bearing_sigma_rad = to_radians(2.0);
  std::uint64_t seed = 1;
};

/// How honest a filter is about its pose.
struct ConsistencyResult {
  std::vector<double> nees;  ///< by step: mean over the runs, ideally 3
  double low = 0.0;          ///< the 99 % band of such a mean
  double high = 0.0;
  double nees_mean = 0.0;    ///< over all steps
  double part_inside = 0.0;  ///< of the steps, inside the band
  double position_rmse_m = 0.0;
};

/// Monte Carlo study of the EKF's pose NEES (Bar-Shalom, Li, Kirubarajan 2001, 5.4). The result does not
/// depend on `threads`.
[[nodiscard]] ConsistencyResult study_consistency(ekf::Consistency mode, const ConsistencyOptions& options,
                                                  int threads);

/// All modes over the same worlds and noise.
struct ConsistencyComparison {
  struct Mode {
    std::string name;  ///< as in the config: "invariant"
    ConsistencyResult result;
  };
  ConsistencyOptions options;
  std::vector<Mode> modes;
};

[[nodiscard]] ConsistencyComparison compare_modes(const ConsistencyOptions& options, int threads);

}  // namespace waymark::study
