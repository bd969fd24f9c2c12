#pragma once

#include <vector>

#include "waymark/core/map_state.hpp"
#include "waymark/core/result.hpp"
#include "waymark/core/trajectory.hpp"
#include "waymark/smooth/solve.hpp"

#include "workbench/run/calibration_file.hpp"
#include "workbench/run/recording.hpp"

namespace waymark::smooth {

/// An observation of a landmark of the map, and its residual after the fit.
struct SmoothedObservation {
  Measurement measured;
  ObservationResidual postfit;
};

/// What a whole log says, each pose by what came before and after it.
struct Smoothed {
  Trajectory trajectory;  ///< a point for each of the run's; covariances given the first
  std::vector<LandmarkEstimate> landmarks;
  CalibrationEstimate calibration;
  CalibrationCovariance calibration_covariance = CalibrationCovariance::Zero();
  int iterations = 0;
  bool converged = false;
  std::vector<std::size_t> steps;  ///< of the run, whose poses were estimated: something was seen there
  std::size_t observations = 0;    ///< of landmarks of the map
  std::vector<SmoothedObservation>
      observation_residuals;  ///< of these; empty where there were too many for covariances
  std::vector<IntervalResidual> interval_residuals;  ///< of the odometry between these poses; likewise
  Duration cpu{0};
};

/// The graph of a run: poses where something was seen, with the filter's path, map and associations to start
/// from. Observations that the filter gated are in it: the whole log may judge them otherwise.
struct RunGraph {
  Graph graph;
  Estimate start;
  std::vector<std::size_t> steps;  ///< index in the run's trajectory of each pose
  std::vector<LandmarkId> ids;     ///< of each landmark
  std::vector<int> observations;   ///< of each landmark
};

/// What another smoothing of the same log leaves to this one.
struct Before {
  Calibration calibration = Calibration::Zero();  ///< what deviations from the config are taken to be
  std::vector<std::size_t> steps;  ///< whose poses are estimated; empty: as smooth.keyframe_* says
  /// By how much standard deviations of the odometry, in x, y and theta, are larger than stated.
  Eigen::Vector3d odometry_noise = Eigen::Vector3d::Ones();
};

[[nodiscard]] RunGraph graph_of(const Recording& recording, const Config& config, const Before& before = {});

/// Estimates path, map and calibration of a run that kept what that needs (smooth.run) from the whole log.
/// The error says what the run lacks.
[[nodiscard]] Result<Smoothed> smooth(const Recording& recording, const Config& config,
                                      const Before& before = {});

}  // namespace waymark::smooth
