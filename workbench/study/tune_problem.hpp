#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "waymark/core/parallel.hpp"

#include "workbench/study/tune_log.hpp"

namespace waymark::study {

/// What is to be as good as can be.
enum class TuneBy {
  kLikelihood,  ///< of all observations, each as the filter foretold it
  kRmse         ///< of the path against the truth under the best rigid motion
};

struct TuneRequest {
  std::vector<std::string> logs;  ///< as parse_tune_input() takes them
  UserSettings user;
  std::vector<std::string> keys;  ///< none: the default ones
  TuneBy by = TuneBy::kLikelihood;
  int threads = 1;
};

/// One value per key, where the search looks.
using TunePoint = std::vector<double>;
/// What each log says of a point, block by block; empty for a log that was not asked.
using TuneScore = std::vector<std::vector<TuneSums>>;

/// Logs in memory and the keys to be tuned on them.
///
/// For cross-validation several logs are left out one by one; of a single log four stretches of time. The
/// filter goes through such a log as a whole, so that it has a map, but what it foretells there counts only
/// on one side.
class TuneProblem {
 public:
  /// Opens logs and keys. Refused: logs of different odometry or observations, or that have different values
  /// of a key; keys that make no difference, where the user has chosen them; fewer observations than keys; no
  /// truth to tune by, or images that are searched for what the filter expects, whose number of observations
  /// would differ.
  [[nodiscard]] static Result<TuneProblem> open(const TuneRequest& request);

  [[nodiscard]] const std::vector<TuneLog>& logs() const { return logs_; }
  [[nodiscard]] const std::vector<TuneKey>& keys() const { return keys_; }
  /// Of the default keys those that make no difference.
  [[nodiscard]] const std::vector<std::string>& idle_keys() const { return idle_keys_; }
  [[nodiscard]] TuneBy by() const { return by_; }
  [[nodiscard]] TunePoint start() const;

  [[nodiscard]] std::size_t folds() const;
  [[nodiscard]] std::string fold_name(std::size_t fold) const;

  /// Runs the logs that `without`, a fold, leaves. Nothing if `keep_going` said no.
  [[nodiscard]] std::optional<TuneScore> score(const TunePoint& at, std::optional<std::size_t> without,
                                               const TuneLog::KeepGoing& keep_going,
                                               ThreadPool& thread_pool) const;

  /// The sums over everything but a fold, or over it alone.
  [[nodiscard]] TuneSums total(const TuneScore& score) const;
  [[nodiscard]] TuneSums total_without(const TuneScore& score, std::size_t fold) const;
  [[nodiscard]] TuneSums total_of(const TuneScore& score, std::size_t fold) const;

  /// What is maximised: the log-likelihood, or -100 ln RMSE, so that one unit is a percent of it.
  [[nodiscard]] double value(const TuneSums& sums) const;
  /// For people: log-likelihood per observation, or RMSE in m. NaN where there is nothing.
  [[nodiscard]] double figure(const TuneSums& sums) const;

 private:
  TuneProblem() = default;

  [[nodiscard]] Result<void> open_logs(const TuneRequest& request);
  [[nodiscard]] Result<void> check_logs() const;
  [[nodiscard]] Result<void> choose_keys(const TuneRequest& request);
  [[nodiscard]] Result<void> check_starts() const;
  [[nodiscard]] std::size_t fold_of(std::size_t log, std::size_t block) const;
  template <class Wanted>
  [[nodiscard]] TuneSums sum_where(const TuneScore& score, const Wanted& wanted) const;

  std::vector<TuneLog> logs_;
  std::vector<TuneKey> keys_;
  std::vector<std::string> idle_keys_;
  TuneBy by_ = TuneBy::kLikelihood;
};

}  // namespace waymark::study
