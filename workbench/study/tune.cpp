#include "workbench/study/tune.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "workbench/study/flatness.hpp"
#include "workbench/study/maximise.hpp"

namespace waymark::study {
namespace {

// In the search: values two percent apart are the same.
constexpr double kResolution = 0.02;
constexpr int kMaxPolishes = 2;
constexpr double kWorthPolishing = 0.5;

/// Counts runs for the progress and asks whether to go on.
class Progress {
 public:
  Progress(const std::function<bool(double)>& keep_going, double expected)
      : keep_going_(keep_going), expected_(expected) {}

  void count() { ++done_; }
  [[nodiscard]] int done() const { return done_; }
  [[nodiscard]] bool stopped() const { return stopped_; }

  bool ask() {
    if (keep_going_ && !keep_going_(std::min(0.99, done_ / expected_))) stopped_ = true;
    return !stopped_;
  }

 private:
  const std::function<bool(double)>& keep_going_;
  double expected_;
  std::atomic<int> done_ = 0;
  std::atomic<bool> stopped_ = false;
};

double expected_runs(const TuneProblem& problem) {
  const auto keys = static_cast<double>(problem.keys().size());
  const auto fits = static_cast<double>(problem.folds() + 1);
  return fits * (15.0 + 20.0 * keys) + keys * (keys + 8.0);
}

class Tuner {
 public:
  Tuner(const TuneProblem& problem, int threads, const std::function<bool(double)>& keep_going)
      : problem_(problem), threads_(threads), progress_(keep_going, expected_runs(problem)) {}

  TuneResult tune();

 private:
  [[nodiscard]] std::optional<TuneScore> score(const TunePoint& at, std::optional<std::size_t> without,
                                               ThreadPool& thread_pool);
  [[nodiscard]] Maximum fit(const TunePoint& start, std::optional<std::size_t> without, int threads);
  [[nodiscard]] std::vector<Maximum> fit_all();
  [[nodiscard]] std::optional<Flatness> explore(Maximum& best);
  void fill_keys(const TunePoint& best, const std::optional<Flatness>& flatness);
  void fill_held_out(const std::vector<Maximum>& fits);
  void fill_logs(const TunePoint& best);

  const TuneProblem& problem_;
  int threads_;
  Progress progress_;
  TuneResult result_;
};

std::optional<TuneScore> Tuner::score(const TunePoint& at, std::optional<std::size_t> without,
                                      ThreadPool& thread_pool) {
  auto score = problem_.score(
      at, without, [this] { return progress_.ask(); }, thread_pool);
  progress_.count();
  return score;
}

Maximum Tuner::fit(const TunePoint& start, std::optional<std::size_t> without, int threads) {
  SearchBox box{start, {}, {}, {}};
  for (const TuneKey& key : problem_.keys()) {
    box.low.push_back(key.to_search(key.low));
    box.high.push_back(key.to_search(key.high));
    box.step.push_back(key.first_step());
  }
  ThreadPool thread_pool(threads);
  return maximise(
      [&](const std::vector<double>& at) -> std::optional<double> {
        const auto scored = score(at, without, thread_pool);
        if (!scored) return std::nullopt;
        return problem_.value(without ? problem_.total_without(*scored, *without) : problem_.total(*scored));
      },
      box, kResolution);
}

/// All data first, then without each fold; beside each other.
std::vector<Maximum> Tuner::fit_all() {
  std::vector<Maximum> fits(problem_.folds() + 1);
  const int count = static_cast<int>(fits.size());
  ThreadPool(std::min(threads_, count)).run(count, [&](int i) {
    const auto fold = i == 0 ? std::nullopt : std::optional(static_cast<std::size_t>(i - 1));
    fits[static_cast<std::size_t>(i)] = fit(problem_.start(), fold, std::max(1, threads_ / count));
  });
  return fits;
}

/// How flat it is at the best; where it turns out to be better beside it, from there on.
std::optional<Flatness> Tuner::explore(Maximum& best) {
  for (int polish = 0;; ++polish) {
    auto flatness = find_flatness(problem_, best.at, threads_, [this] { return progress_.ask(); });
    if (!flatness || polish == kMaxPolishes || flatness->gained < kWorthPolishing) return flatness;
    best = fit(flatness->best, {}, threads_);
    if (best.stopped) return std::nullopt;
  }
}

void Tuner::fill_keys(const TunePoint& best, const std::optional<Flatness>& flatness) {
  for (std::size_t k = 0; k < best.size(); ++k) {
    const TuneKey& key = problem_.keys()[k];
    TunedKey tuned{.name = key.name, .before = key.start, .after = key.to_value(best[k])};
    tuned.by_factor = key.by_factor;
    if (flatness) {
      const KeyFlatness& flat = flatness->keys[k];
      tuned.interval = {key.to_value(flat.low), key.to_value(flat.high)};
      tuned.open_low = flat.open_low;
      tuned.open_high = flat.open_high;
      for (const auto& [at, value] : flat.slice) tuned.slice.emplace_back(key.to_value(at), value);
    }
    result_.keys.push_back(std::move(tuned));
  }
}

void Tuner::fill_held_out(const std::vector<Maximum>& fits) {
  ThreadPool thread_pool(threads_);
  const auto before = score(problem_.start(), {}, thread_pool);
  if (!before) return;
  TuneSums all_before;
  TuneSums all_after;
  for (std::size_t fold = 0; fold < problem_.folds(); ++fold) {
    const auto after = score(fits[fold + 1].at, {}, thread_pool);
    if (!after) return result_.held_out.clear();
    const TuneSums of_before = problem_.total_of(*before, fold);
    const TuneSums of_after = problem_.total_of(*after, fold);
    result_.held_out.push_back(
        {problem_.fold_name(fold), problem_.figure(of_before), problem_.figure(of_after)});
    all_before += of_before;
    all_after += of_after;
  }
  result_.held_out.push_back({"all", problem_.figure(all_before), problem_.figure(all_after)});
}

void Tuner::fill_logs(const TunePoint& best) {
  ThreadPool thread_pool(threads_);
  const auto before = score(problem_.start(), {}, thread_pool);
  const auto after = score(best, {}, thread_pool);
  if (!before || !after) return;
  result_.before = problem_.figure(problem_.total(*before));
  result_.after = problem_.figure(problem_.total(*after));
  for (std::size_t i = 0; i < problem_.logs().size(); ++i) {
    const TuneLog& log = problem_.logs()[i];
    const auto sum = [](const std::vector<TuneSums>& blocks) {
      TuneSums sums;
      for (const TuneSums& block : blocks) sums += block;
      return sums;
    };
    const auto old_run = log.run(assignments(problem_.keys(), problem_.start()), {});
    const auto new_run = log.run(assignments(problem_.keys(), best), {});
    if (!old_run || !new_run) continue;
    result_.logs.push_back({log.name(), problem_.figure(sum((*before)[i])), problem_.figure(sum((*after)[i])),
                            figures_of(*old_run), figures_of(*new_run)});
  }
}

TuneResult Tuner::tune() {
  result_.by = problem_.by();
  result_.idle_keys = problem_.idle_keys();
  for (const TuneLog& log : problem_.logs()) result_.observations += log.observations();
  std::vector<Maximum> fits = fit_all();
  Maximum& best = fits.front();
  std::optional<Flatness> flatness;
  if (!progress_.stopped()) flatness = explore(best);
  fill_keys(best.at, flatness);
  if (!progress_.stopped()) fill_held_out(fits);
  if (!progress_.stopped()) fill_logs(best.at);
  result_.runs = progress_.done();
  result_.stopped = progress_.stopped();
  return std::move(result_);
}

}  // namespace

Result<TuneResult> tune(const TuneRequest& request, const std::function<bool(double)>& keep_going) {
  const auto problem = TuneProblem::open(request);
  if (!problem) return problem.error();
  return Tuner(*problem, request.threads, keep_going).tune();
}

}  // namespace waymark::study
