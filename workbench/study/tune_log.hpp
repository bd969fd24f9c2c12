#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "waymark/core/event.hpp"

#include "workbench/study/scored_run.hpp"
#include "workbench/study/tune_keys.hpp"

namespace waymark::study {

/// A log and settings of its own.
struct TuneInput {
  std::string path;
  std::vector<std::string> assignments;
};

/// "LOG" or "LOG@key=value,key=value": several runs may lie in one place.
[[nodiscard]] TuneInput parse_tune_input(std::string_view text);

/// What several observations, or several places of the truth, add up to.
struct TuneSums {
  double log_likelihood = 0.0;
  double observations = 0.0;
  double squared_error_m2 = 0.0;  ///< of the path under the best rigid motion
  double truths = 0.0;

  TuneSums& operator+=(const TuneSums& other);
};

/// Stretches of a log with as many observations each.
inline constexpr std::size_t kTuneBlocks = 20;

/// A log in memory, images too, that is run again and again with other settings.
class TuneLog {
 public:
  /// Reads it, and runs it once as it is configured. Refused: what cannot be read or run to its end, and a
  /// log without observations.
  [[nodiscard]] static Result<TuneLog> open(const std::string& name, UserSettings user);

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const Config& config() const { return config_; }
  [[nodiscard]] std::optional<OdometryKind> odometry() const { return odometry_; }
  [[nodiscard]] std::size_t observations() const { return observations_; }
  [[nodiscard]] bool has_truth() const { return !truth_.empty(); }
  /// What the filter looks for, and so what it sees, depends on its settings.
  [[nodiscard]] bool searches_images() const { return searches_images_; }

  using KeepGoing = std::function<bool()>;

  /// One run with these settings on top of the log's own; scored by block. Nothing if `keep_going` said no. A
  /// run that breaks down scores as if all of its observations were outliers. Safe to call from several
  /// threads.
  [[nodiscard]] std::optional<std::vector<TuneSums>> sums(const std::vector<std::string>& settings,
                                                          const KeepGoing& keep_going) const;

  /// The same, whole, with all that a run is scored by.
  [[nodiscard]] Result<ScoredRun> run(const std::vector<std::string>& settings,
                                      const KeepGoing& keep_going) const;

 private:
  TuneLog() = default;

  [[nodiscard]] Result<void> survey();
  [[nodiscard]] Result<Recording> record_with(const std::vector<std::string>& settings,
                                              bool keep_observations, const KeepGoing& keep_going) const;
  [[nodiscard]] std::size_t block_of(Stamp stamp) const;
  void add_errors(const Recording& recording, std::vector<TuneSums>& blocks) const;
  [[nodiscard]] std::vector<TuneSums> worst() const;

  std::string name_;
  Config config_;
  LogInfo info_;
  std::vector<Event> events_;
  std::optional<OdometryKind> odometry_;
  eval::TruthTrack truth_;
  std::size_t observations_ = 0;
  bool searches_images_ = false;
  double log_field_density_ = 0.0;
  std::vector<Stamp> block_ends_;          // of all blocks but the last
  std::vector<std::size_t> block_counts_;  // observations in them
};

}  // namespace waymark::study
