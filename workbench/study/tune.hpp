#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "workbench/study/sweep_figures.hpp"
#include "workbench/study/tune_problem.hpp"

namespace waymark::study {

/// What became of one key.
struct TunedKey {
  std::string name;
  double before = 0.0;
  double after = 0.0;
  /// From where to where the score falls by no more than 2 units (see find_flatness()); nothing where tuning
  /// was stopped before that was known.
  std::optional<std::pair<double, double>> interval;
  bool open_low = false;  ///< the interval does not end there: the logs do not tell
  bool open_high = false;
  bool by_factor = true;
  std::vector<std::pair<double, double>>
      slice;  ///< value of the key, score less the best; the others as they are
};

/// A part of the data that was left out of a fit of its own, and what it scores before and after.
struct HeldOutLog {
  std::string name;
  double before = 0.0;
  double after = 0.0;
};

/// A log as a whole, run with the old and the new values.
struct TunedLog {
  std::string name;
  double before = 0.0;  ///< score
  double after = 0.0;
  Figures figures_before{};
  Figures figures_after{};
};

/// Scores are log-likelihoods per observation (the more the better), or RMSE in m (the less the better).
struct TuneResult {
  TuneBy by = TuneBy::kLikelihood;
  std::vector<TunedKey> keys;
  std::vector<std::string> idle_keys;  ///< default keys that make no difference on these logs
  std::size_t observations = 0;
  double before = 0.0;  ///< score of everything
  double after = 0.0;
  std::vector<HeldOutLog> held_out;  ///< by part, then all parts together; empty where tuning was stopped
  std::vector<TunedLog> logs;        ///< likewise
  int runs = 0;                      ///< over all logs
  bool stopped = false;
};

/// Climbs from where the config is to the best values of the keys, once with all logs and once without each
/// part of them, and looks at how flat it is there. `keep_going` is asked now and then, from several threads,
/// with the part of the work done; false ends it with the best values so far. The result does not depend on
/// the number of threads.
[[nodiscard]] Result<TuneResult> tune(const TuneRequest& request,
                                      const std::function<bool(double)>& keep_going = {});

}  // namespace waymark::study
