#pragma once

#include <deque>
#include <functional>
#include <vector>

#include "waymark/core/event.hpp"
#include "waymark/core/filter.hpp"
#include "waymark/models/landmark_sensor.hpp"
#include "waymark/slam/odometer.hpp"

namespace waymark {

/// Which part of what the log holds is used.
enum class Observe { kRangeBearing, kRange, kBearing };

struct PipelineOptions {
  double reorder_window_s = 0.5;  ///< how late an event may arrive and still be put in its place
  double max_hold_s = 2.0;        ///< how long the last speed is believed when odometry is missing
};

void describe(Schema& schema, PipelineOptions& options);

/// What the pipeline reports after every group of events with one stamp.
struct Step {
  Stamp stamp;
  PoseEstimate pose;
  Pose2 dead_reckoning;                    ///< the odometry alone, from the origin
  const Correction* correction = nullptr;  ///< null: nothing was observed. Valid during the call only.
  Duration cpu{0};                         ///< of this thread in the filter since the last correction
};

/// What was not used, and why.
struct PipelineCounts {
  std::int64_t events = 0;
  std::int64_t observations = 0;
  std::int64_t late = 0;             ///< stamped before what was already processed
  std::int64_t unusable = 0;         ///< not finite or outside the sensor's limits
  std::int64_t wrong_kind = 0;       ///< lacks what --observe asks for
  std::int64_t other_odometry = 0;   ///< of a second kind
  std::int64_t before_odometry = 0;  ///< observed before the first odometry: used, at the start pose
  int odometry_gaps = 0;
};

/// Puts events in order of their stamps, turns odometry into motion up to the stamp of what is observed,
/// hands all observations of one stamp to the filter as one batch, and goes on over gaps. Events may arrive
/// late by up to the reordering window. Images and truth are not its business and are ignored.
class Pipeline {
 public:
  using Sink = std::function<void(const Step&)>;

  Pipeline(Filter& filter, const PipelineOptions& options, const OdometryOptions& odometry,
           const LandmarkSensor& sensor, Observe observe, Sink sink);

  void push(Event event);
  /// Processes what is still waiting.
  void finish();

  [[nodiscard]] PipelineCounts counts() const;

 private:
  void insert(Event event);
  void process_front_group();
  void predict(Stamp stamp);
  void collect(const Observations& observations);
  [[nodiscard]] const Event* next_odometry() const;

  Filter& filter_;
  LandmarkSensor sensor_;
  Observe observe_;
  Sink sink_;
  Odometer odometer_;
  Duration window_;
  Duration delay_;
  Duration response_;  ///< of the robot to what its odometry reports

  std::deque<Event> waiting_;  // by stamp
  std::optional<Stamp> processed_;
  std::vector<Observation> batch_;
  Pose2 dead_reckoning_;
  Duration cpu_since_correction_{0};
  bool odometry_seen_ = false;
  PipelineCounts counts_;
};

}  // namespace waymark
