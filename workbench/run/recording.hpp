#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "waymark/core/filter.hpp"
#include "waymark/core/function_blocks.hpp"
#include "waymark/core/trajectory.hpp"
#include "waymark/slam/odometer.hpp"
#include "waymark/slam/pipeline_counts.hpp"
#include "waymark/vision/tracker_counts.hpp"

#include "workbench/run/config.hpp"
#include "workbench/run/image_strip.hpp"
#include "workbench/run/pose_losses.hpp"

namespace waymark {

/// Everything a run leaves behind: what sinks (files, evaluation, report) read.
struct Recording {
  struct TimedInnovation {
    Stamp stamp;
    Innovation innovation;
  };
  struct TimedCost {
    Stamp stamp;
    Duration cpu;  ///< of this thread, from the prediction to this stamp to the end of the correction
  };

  /// An observation as the filter got it, with the landmark that it was taken for.
  struct ObservationRecord {
    std::size_t step;  ///< index in `trajectory`
    LandmarkId landmark;
    Outcome outcome;
    Observation observation;
  };

  Trajectory trajectory;      ///< causal, with covariance
  Trajectory dead_reckoning;  ///< odometry alone, from the origin
  std::vector<std::pair<Stamp, Truth>> truth;
  std::vector<TimedInnovation> innovations;
  std::vector<TimedCost> steps;
  std::vector<Motion> motions;                  ///< of the odometry, to each point of the trajectory
  std::vector<ObservationRecord> observations;  ///< kept where smooth.run is set
  std::vector<FunctionBlocks::Row> blocks;      ///< of the filter, and of what looks into images for it
  ImageStrip image_strip;
  std::optional<Duration> frame_budget;  ///< of a step, where there is one
  PoseLosses losses;                     ///< when the robot slipped or was lost
  PipelineCounts counts;
  std::optional<OdometryKind> odometry;  ///< what it is told in, if there is any
  vision::TrackerCounts tracker;         ///< of what looks into images
  std::vector<std::string> notes;        ///< what was skipped or odd, one line each
  std::vector<LandmarkPatch> patches;    ///< what landmarks and candidates look like at the end
  Duration wall{0};
  std::unique_ptr<Filter> filter;  ///< as the last event left it
  std::optional<Error> error;      ///< why reading stopped before the end; everything above holds up to there
};

/// The part of a log to run on, in seconds from its first event: what --from and --to say.
struct TimeSpan {
  double from_s = 0.0;
  double to_s = 1e18;
};

/// Runs a log through the filter that `config` asks for. `keep_going` is asked now and then with the part of
/// the log done; false stops the run, which keeps what it has. An error where there is no result: the filter
/// cannot be made, a sensor is not known, nothing in the span is what `config.observe` asks for, or the robot
/// was never localised.
[[nodiscard]] Result<Recording> record(Source& source, const Config& config, const TimeSpan& span = {},
                                       const std::function<bool(double)>& keep_going = {});

/// What is known at the end of it: the map that another run can start from. Who made it is the caller's to
/// fill in.
[[nodiscard]] MapState save_map(const Recording& recording);

}  // namespace waymark
