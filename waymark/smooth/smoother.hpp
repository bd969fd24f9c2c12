#pragma once

#include <string>
#include <vector>

#include "waymark/core/map_state.hpp"
#include "waymark/core/result.hpp"
#include "waymark/core/trajectory.hpp"
#include "waymark/slam/recording.hpp"
#include "waymark/smooth/solve.hpp"

namespace waymark::smooth {

/// What a whole log says, each pose by what came before and after it.
struct Smoothed {
  Trajectory trajectory;  ///< a point for each of the run's; covariances given the first
  std::vector<LandmarkEstimate> landmarks;
  Calibration calibration = Calibration::Zero();
  Calibration calibration_sigmas = Calibration::Zero();  ///< 0: was not estimated
  int iterations = 0;
  bool converged = false;
  std::size_t poses = 0;      ///< that were estimated: those at which something was seen
  std::size_t sightings = 0;  ///< of landmarks of the map
  Duration cpu{0};
};

/// The graph of a run: poses where something was seen, with the filter's path, map and associations to start
/// from. Sightings that the filter gated are in it: the whole log may judge them otherwise.
struct RunGraph {
  Graph graph;
  Estimate start;
  std::vector<std::size_t> steps;  ///< index in the run's trajectory of each pose
  std::vector<LandmarkId> ids;     ///< of each landmark
  std::vector<int> observations;   ///< of each landmark
};

[[nodiscard]] RunGraph graph_of(const Recording& recording, const Config& config);

/// Estimates path, map and calibration of a run that kept what that needs (smooth.run) from the whole log.
/// The error says what the run lacks.
[[nodiscard]] Result<Smoothed> smooth(const Recording& recording, const Config& config);

/// Something of the sensors that was estimated, under the config key which puts it in force.
struct CalibratedKey {
  std::string key;
  double value = 0.0;
  double sigma = 0.0;
};

/// Those that have a key and whose certainty is known.
[[nodiscard]] std::vector<CalibratedKey> calibrated_keys(const Smoothed& smoothed, const Config& config);

/// The same as a config file; what has no key stands in a comment.
[[nodiscard]] std::string calibration_yaml(const Smoothed& smoothed, const Config& config);

}  // namespace waymark::smooth
