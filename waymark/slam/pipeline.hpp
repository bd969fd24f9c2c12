#pragma once

#include <deque>
#include <functional>
#include <span>
#include <vector>

#include "waymark/core/event.hpp"
#include "waymark/core/filter.hpp"
#include "waymark/core/stopwatch.hpp"
#include "waymark/models/landmark_sensor.hpp"
#include "waymark/models/observe.hpp"
#include "waymark/slam/front_end.hpp"
#include "waymark/slam/odometer.hpp"
#include "waymark/slam/pipeline_counts.hpp"
#include "waymark/slam/pipeline_options.hpp"
#include "waymark/slam/release_horizon.hpp"

namespace waymark {

/// What the pipeline reports after every group of events with one stamp.
struct Step {
  Stamp stamp;
  PoseEstimate pose;
  Pose2 dead_reckoning;                       ///< the odometry alone, from the origin
  Motion motion;                              ///< of the odometry since the step before
  std::span<const Observation> observations;  ///< as the filter got them. Valid during the call only.
  const Correction* correction = nullptr;     ///< null: nothing was observed. Valid during the call only.
  const GreyImage* image = nullptr;           ///< what the front end looked into, if anything. Likewise.
  Duration cpu{0};  ///< of this thread, where something was observed: from prediction to correction
};

/// Sorts events by stamp, integrates odometry up to the stamp of each scan, passes all observations of
/// one stamp to the filter as one batch, and continues over gaps. Events of a file are pushed and may
/// arrive late by up to the reordering window; they wait for the odometry behind them, as long as their
/// images take no more than 256 MB; live ones are held, and processed up to the horizon of
/// each stream, so that no pose waits longer than it must. Images go to the front end, if there is one,
/// which may start on them as soon as they arrive; an image of the wrong size, or one that repeats the
/// one before, is skipped. Ground truth is ignored.
class Pipeline {
 public:
  using Sink = std::function<void(const Step&)>;

  /// `front_end` looks into images; without one they are ignored. It and the filter must outlive the
  /// pipeline.
  Pipeline(Filter& filter, const PipelineOptions& options, const OdometryOptions& odometry,
           const LandmarkSensor& sensor, Observe observe, Sink sink, FrontEnd* front_end = nullptr);

  /// Takes an event, and processes what is older than the newest by more than the reordering window.
  void push(Event event);

  /// Takes an event and processes nothing: process_until() does.
  void hold(Event event);
  /// Processes what is stamped until then, that moment included. Stamps are those of the horizon.
  void process_until(Stamp stamp);
  /// What each stream has told, in the moments that its events are of: less the sensor's delay for what is
  /// observed, and later by the robot's response for its odometry.
  [[nodiscard]] ReleaseHorizon& horizon() { return horizon_; }

  /// Processes what is still waiting.
  void finish();

  [[nodiscard]] PipelineCounts counts() const;
  [[nodiscard]] std::optional<OdometryKind> odometry() const { return odometer_.kind(); }

 private:
  [[nodiscard]] bool accept(Event& event);
  void insert(Event event);
  [[nodiscard]] bool front_is_ready() const;
  [[nodiscard]] bool may_follow(const Event& event) const;
  void process_front_group();
  [[nodiscard]] bool front_group_observes() const;
  void predict(Stamp stamp);
  void collect(const Observations& observations);
  void announce(const Event& event);
  void take(const Image& image);
  void collect_seen(std::span<const Observation> seen);
  [[nodiscard]] const Correction* correct();
  [[nodiscard]] const Correction* see_image();
  [[nodiscard]] bool is_observed(const EventContent& content) const;
  [[nodiscard]] const Event* next_odometry() const;
  [[nodiscard]] const Event* next_yaw_rate() const;
  [[nodiscard]] Duration shift_of(const EventContent& content) const;

  Filter& filter_;
  LandmarkSensor sensor_;
  Observe observe_;
  Sink sink_;
  FrontEnd* front_end_;  ///< null: nothing looks into images
  Odometer odometer_;
  Duration window_;
  Duration delay_;
  Duration response_;  ///< of the robot to what its odometry reports

  std::deque<Event> waiting_;  // by stamp
  std::size_t waiting_bytes_ = 0;
  Stamp newest_odometry_{Duration::min()};
  ReleaseHorizon horizon_;
  std::optional<std::uint16_t> robot_;  // of the first event
  std::optional<Stamp> processed_;
  std::vector<Observation> batch_;
  FrontEnd::SharedImage image_;  // of the stamp that is being processed
  FrontEnd::SharedImage last_image_;
  Pose2 dead_reckoning_;
  Motion motion_;  // to the stamp that is being processed
  Stopwatch stopwatch_;
  bool odometry_seen_ = false;
  PipelineCounts counts_;
};

}  // namespace waymark
