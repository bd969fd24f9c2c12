#pragma once

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "workbench/live/inbox.hpp"
#include "workbench/live/latency.hpp"
#include "workbench/live/lateness.hpp"
#include "workbench/live/pose_of_now.hpp"
#include "workbench/live/stream.hpp"
#include "workbench/run/filter_run.hpp"

namespace waymark::live {

/// What a session tells while it runs. Called on the thread named; must not block.
struct Listeners {
  std::function<void(const StampedPose&)> pose_of_now = {};  ///< that of the stream of odometry
  std::function<void(const Step&)> step = {};                ///< that of the filter, after each stamp
  std::function<void(const Event&)> held = {};               ///< likewise, before the filter is given it
  std::function<void(Stamp)> processed = {};                 ///< likewise, up to there
};

/// What a session took, beside what the run itself recorded.
struct SessionFigures {
  LatencyHistogram correction_waits;      ///< of observations for the odometry of their moment
  LatencyHistogram correction_latencies;  ///< from both to the corrected pose
  LatencyHistogram pose_latencies;        ///< from odometry that arrives to the pose of now
  std::vector<StreamSummary> streams;
};

/// A filter fed by streams as they come. Each stream runs on a thread of its own and puts what arrives into
/// the inbox; the thread that calls run() takes it out and processes what no stream can add to any more: up
/// to the newest stamp of each, or to what must have arrived by its usual lateness, so that a stream that
/// falls silent holds nobody up. The pose of now is told on the thread of the odometry, so that it never
/// waits for an image.
class Session {
 public:
  Session(FilterRun& run, const Config& config, const SessionClock& clock,
          std::vector<std::unique_ptr<Stream>> streams, Listeners listeners);

  /// Until `keep_going`, which is asked ten times a second, says no, or all streams have ended. An error: the
  /// filter cannot go on, or a thread cannot be started.
  [[nodiscard]] Result<void> run(const std::function<bool()>& keep_going);

  [[nodiscard]] SessionFigures figures() const;
  [[nodiscard]] std::vector<StreamSummary> stream_summaries() const;
  [[nodiscard]] std::optional<StampedPose> pose_of_now() const { return pose_of_now_.now(); }
  /// For the thread of the filter.
  [[nodiscard]] const LatencyHistogram& correction_latencies() const { return corrections_.latencies(); }

 private:
  void receive(Stream& stream, Arrival arrival);
  [[nodiscard]] Result<void> process(const std::vector<Arrival>& arrivals);
  void note_arrival(const Arrival& arrival);
  void take(const Step& step);
  void advance_horizon(Stamp now);
  [[nodiscard]] Stamp moment_of(const Event& event) const;
  [[nodiscard]] bool have_all_ended() const;

  FilterRun& run_;
  SessionClock clock_;
  std::vector<std::unique_ptr<Stream>> streams_;
  Listeners listeners_;
  Duration delay_;     ///< of what is observed
  Duration response_;  ///< of the robot to its odometry
  Inbox inbox_;
  PoseOfNow pose_of_now_;
  std::map<StreamId, Lateness> lateness_;  // of moments, by who tells of them
  std::optional<StampedPose> last_step_;
  CorrectionLatency corrections_;
  mutable std::mutex pose_latency_mutex_;
  LatencyHistogram pose_latencies_;
};

}  // namespace waymark::live
