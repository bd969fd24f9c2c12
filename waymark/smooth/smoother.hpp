#pragma once

#include <vector>

#include "waymark/core/map_state.hpp"
#include "waymark/core/result.hpp"
#include "waymark/core/trajectory.hpp"
#include "waymark/slam/recording.hpp"
#include "waymark/smooth/calibration_file.hpp"
#include "waymark/smooth/solve.hpp"

namespace waymark::smooth {

/// What a whole log says, each pose by what came before and after it.
struct Smoothed {
  Trajectory trajectory;  ///< a point for each of the run's; covariances given the first
  std::vector<LandmarkEstimate> landmarks;
  CalibrationEstimate calibration;
  CalibrationCovariance calibration_covariance = CalibrationCovariance::Zero();
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
/// `calibration_before`: what the deviations from the config are taken to be before anything is seen. The
/// error says what the run lacks.
[[nodiscard]] Result<Smoothed> smooth(const Recording& recording, const Config& config,
                                      const Calibration& calibration_before = Calibration::Zero());

}  // namespace waymark::smooth
