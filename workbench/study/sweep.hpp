#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "waymark/core/result.hpp"

#include "workbench/study/sweep_figures.hpp"
#include "workbench/study/sweep_journal.hpp"
#include "workbench/study/sweep_plan.hpp"

namespace waymark::study {

/// A sweep in progress: hands out the runs that are still to be made and takes in what comes back, from
/// whatever makes them (threads, other machines). Continues where its journal ends. All members may be called
/// from several threads.
class Sweep {
 public:
  /// `folder` must exist.
  [[nodiscard]] static Result<std::unique_ptr<Sweep>> open(const SweepPlan& plan,
                                                           const std::filesystem::path& folder);

  [[nodiscard]] const SweepPlan& plan() const { return plan_; }
  [[nodiscard]] const SweepPoint& point(std::size_t run) const { return points_[run]; }

  /// The next run to make; nothing when all were handed out or the sweep was stopped.
  [[nodiscard]] std::optional<std::size_t> take();
  /// A run of the plan is done: on disk when this returns. Where that fails the sweep stops.
  void finish(SweepRow row);
  /// Hands out no more.
  void stop();
  /// Stops for a reason, of which the first is kept.
  void fail(Error error);

  [[nodiscard]] std::size_t total() const { return points_.size(); }
  [[nodiscard]] std::size_t done() const;
  /// How many were done when it was opened.
  [[nodiscard]] std::size_t resumed() const { return resumed_; }
  [[nodiscard]] bool stopped() const;
  [[nodiscard]] std::optional<Error> error() const;

  /// What is done, in the order of the plan.
  [[nodiscard]] std::vector<SweepRow> rows() const;

 private:
  Sweep(const SweepPlan& plan, SweepJournal journal);
  void stop_for(Error error);

  SweepPlan plan_;
  std::vector<SweepPoint> points_;
  std::map<SweepPoint, std::size_t> places_;  // of the points
  std::size_t resumed_ = 0;

  mutable std::mutex mutex_;
  SweepJournal journal_;
  std::vector<std::optional<SweepRow>> rows_;
  std::size_t next_ = 0;
  std::size_t done_ = 0;
  bool stopped_ = false;
  std::optional<Error> error_;
};

/// The table of a sweep: a header and a row per run.
[[nodiscard]] std::string csv(const SweepPlan& plan, const std::vector<SweepRow>& rows);

}  // namespace waymark::study
