#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>

#include "waymark/slam/pipeline.hpp"

#include "workbench/run/log_sample.hpp"
#include "workbench/run/make_filter.hpp"
#include "workbench/run/motion_thinner.hpp"
#include "workbench/run/recording.hpp"

namespace waymark {

/// A filter at work, as its config asks for, and what it leaves behind. Events come one by one: those of a
/// log by push(), those of a robot by hold() and process_until().
class FilterRun {
 public:
  using Listener = std::function<void(const Step&)>;

  /// `config` must outlive it. An error: the filter cannot be made.
  [[nodiscard]] static Result<std::unique_ptr<FilterRun>> make(const Config& config);

  /// Has each step told after it was kept.
  void listen(Listener listener) { listener_ = std::move(listener); }

  /// For a session without end: keeps at most so many points of the path, of all of it, and of innovations
  /// and times of steps as many as fit beside them, the latest. Smoothing then is not possible.
  void keep_at_most(std::size_t points) { most_points_ = points; }

  /// An error: a sensor is not known, or the filter refuses its map. Nothing good comes of going on.
  [[nodiscard]] Result<void> push(Event event);
  [[nodiscard]] Result<void> hold(Event event);
  [[nodiscard]] Result<void> process_until(Stamp stamp);
  [[nodiscard]] ReleaseHorizon& horizon() { return pipeline_->horizon(); }

  [[nodiscard]] const Recording& recording() const { return recording_; }
  [[nodiscard]] PipelineCounts counts() const { return pipeline_->counts(); }

  /// Processes what still waits, and gives the recording away. `notes` are those
  /// of the log, `broke_off` is why reading ended before the log did. An error where there is no result, as
  /// for record().
  [[nodiscard]] Result<Recording> finish(const LogInfo& log, std::vector<std::string> notes,
                                         std::optional<Error> broke_off, bool whole_log);

 private:
  FilterRun(const Config& config, FilterSystem system);
  [[nodiscard]] Result<bool> expect(const Event& event);
  [[nodiscard]] Result<void> refusal() const;
  void keep(const Step& step);
  void limit_memory(std::size_t most);

  const Config& config_;
  Recording recording_;
  std::unique_ptr<FrontEnd> front_end_;
  LogSample sample_;
  std::optional<std::size_t> most_points_;
  MotionThinner thinner_;
  Listener listener_;
  std::optional<Pipeline> pipeline_;  // last: it works on all of these
  bool sensors_known_ = true;
  std::chrono::steady_clock::time_point start_;
};

}  // namespace waymark
