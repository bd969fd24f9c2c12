#include "workbench/study/tune_problem.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace waymark::study {
namespace {

constexpr std::size_t kFoldsOfOneLog = 4;
// A key is probed at half as much again.
constexpr double kProbe = 0.6;

bool is_same(const TuneScore& a, const TuneScore& b) {
  for (std::size_t log = 0; log < a.size(); ++log)
    for (std::size_t block = 0; block < a[log].size(); ++block)
      if (a[log][block].log_likelihood != b[log][block].log_likelihood ||
          a[log][block].squared_error_m2 != b[log][block].squared_error_m2)
        return false;
  return true;
}

std::string value_of(const Config& config, const std::string& key) {
  Config copy = config;
  return describe(copy).value(key);
}

/// Which keys change nothing, each probed by itself.
std::vector<bool> find_idle(const TuneProblem& problem, int threads) {
  const TunePoint start = problem.start();
  std::vector<TuneScore> scores(start.size() + 1);
  ThreadPool(threads).run(static_cast<int>(scores.size()), [&](int i) {
    const auto k = static_cast<std::size_t>(i);
    TunePoint at = start;
    if (k < at.size()) at[k] += kProbe * problem.keys()[k].first_step();
    ThreadPool alone(1);
    scores[k] = problem.score(at, {}, {}, alone).value_or(TuneScore{});
  });
  std::vector<bool> idle;
  for (std::size_t k = 0; k < start.size(); ++k) idle.push_back(is_same(scores[k], scores.back()));
  return idle;
}

}  // namespace

Result<TuneProblem> TuneProblem::open(const TuneRequest& request) {
  TuneProblem problem;
  problem.by_ = request.by;
  if (auto done = problem.open_logs(request); !done) return done.error();
  if (auto done = problem.check_logs(); !done) return done.error();
  if (auto done = problem.choose_keys(request); !done) return done.error();
  return problem;
}

Result<void> TuneProblem::open_logs(const TuneRequest& request) {
  for (const auto& name : request.logs) {
    auto log = TuneLog::open(name, request.user);
    if (!log) return log.error();
    logs_.push_back(*std::move(log));
  }
  return {};
}

Result<void> TuneProblem::check_logs() const {
  const TuneLog& first = logs_.front();
  for (const TuneLog& log : logs_) {
    if (log.odometry() != first.odometry())
      return Error{fmt::format("{} has {}, but {} has {}: tune them separately", first.name(),
                               describe(first.odometry()), log.name(), describe(log.odometry()))};
    if (log.config().observe != first.config().observe)
      return Error{fmt::format("{} observes {}, but {} {}: tune them separately, or set observe",
                               first.name(), value_of(first.config(), "observe"), log.name(),
                               value_of(log.config(), "observe"))};
    if (by_ == TuneBy::kRmse && !log.has_truth())
      return Error{fmt::format("--by rmse: {} has no ground truth; use --by likelihood", log.name())};
    if (by_ == TuneBy::kLikelihood && log.searches_images())
      return Error{
          fmt::format("--by likelihood: which corners are found in the images of {} depends on the settings, "
                      "so likelihoods are not comparable; with ground truth use --by rmse",
                      log.name())};
  }
  return {};
}

Result<void> TuneProblem::choose_keys(const TuneRequest& request) {
  const TuneLog& first = logs_.front();
  const bool chosen = !request.keys.empty();
  auto keys =
      tune_keys(first.config(), chosen ? request.keys : default_tune_keys(first.config(), first.odometry()));
  if (!keys) return keys.error();
  keys_ = *std::move(keys);
  if (auto checked = check_starts(); !checked) return checked;
  std::size_t observations = 0;
  for (const TuneLog& log : logs_) observations += log.observations();
  if (observations < keys_.size())
    return Error{fmt::format("{} observations are too few to tune {} keys; name fewer with --keys",
                             observations, keys_.size())};
  const auto idle = find_idle(*this, request.threads);
  std::vector<TuneKey> working;
  for (std::size_t k = 0; k < keys_.size(); ++k) {
    if (idle[k] && chosen)
      return Error{fmt::format("--keys: {} has no effect on {}", keys_[k].name,
                               logs_.size() == 1 ? "this log" : "these logs")};
    if (idle[k])
      idle_keys_.push_back(keys_[k].name);
    else
      working.push_back(keys_[k]);
  }
  keys_ = std::move(working);
  if (keys_.empty()) return Error{"none of the keys has an effect; name others with --keys"};
  return {};
}

Result<void> TuneProblem::check_starts() const {
  for (const TuneLog& log : logs_)
    for (const TuneKey& key : keys_) {
      const std::string value = value_of(log.config(), key.name);
      const std::string first = value_of(logs_.front().config(), key.name);
      if (value != first)
        return Error{
            fmt::format("{0} is {1} in {2}, but {3} in {4}: give a common initial value by --set {0}=...",
                        key.name, first, logs_.front().name(), value, log.name())};
    }
  return {};
}

TunePoint TuneProblem::start() const {
  TunePoint at;
  for (const TuneKey& key : keys_) at.push_back(key.to_search(key.start));
  return at;
}

std::size_t TuneProblem::folds() const { return logs_.size() > 1 ? logs_.size() : kFoldsOfOneLog; }

std::string TuneProblem::fold_name(std::size_t fold) const {
  if (logs_.size() > 1) return logs_[fold].name();
  constexpr double kPercent = 100.0 / kFoldsOfOneLog;
  const auto begin = static_cast<double>(fold);
  return fmt::format("{:.0f} to {:.0f} % of the observations", kPercent * begin, kPercent * (begin + 1.0));
}

std::size_t TuneProblem::fold_of(std::size_t log, std::size_t block) const {
  return logs_.size() > 1 ? log : block * kFoldsOfOneLog / kTuneBlocks;
}

std::optional<TuneScore> TuneProblem::score(const TunePoint& at, std::optional<std::size_t> without,
                                            const TuneLog::KeepGoing& keep_going,
                                            ThreadPool& thread_pool) const {
  const auto settings = assignments(keys_, at);
  std::vector<std::optional<std::vector<TuneSums>>> sums(logs_.size());
  thread_pool.run(static_cast<int>(logs_.size()), [&](int i) {
    const auto log = static_cast<std::size_t>(i);
    const bool left_out = logs_.size() > 1 && without == log;
    sums[log] = left_out ? std::vector<TuneSums>{} : logs_[log].sums(settings, keep_going);
  });
  TuneScore score;
  for (auto& of_log : sums) {
    if (!of_log) return std::nullopt;
    score.push_back(*std::move(of_log));
  }
  return score;
}

template <class Wanted>
TuneSums TuneProblem::sum_where(const TuneScore& score, const Wanted& wanted) const {
  TuneSums sums;
  for (std::size_t log = 0; log < score.size(); ++log)
    for (std::size_t block = 0; block < score[log].size(); ++block)
      if (wanted(fold_of(log, block))) sums += score[log][block];
  return sums;
}

TuneSums TuneProblem::total(const TuneScore& score) const {
  return sum_where(score, [](std::size_t) { return true; });
}

TuneSums TuneProblem::total_without(const TuneScore& score, std::size_t fold) const {
  return sum_where(score, [fold](std::size_t of) { return of != fold; });
}

TuneSums TuneProblem::total_of(const TuneScore& score, std::size_t fold) const {
  return sum_where(score, [fold](std::size_t of) { return of == fold; });
}

double TuneProblem::value(const TuneSums& sums) const {
  return by_ == TuneBy::kLikelihood ? sums.log_likelihood : -100.0 * std::log(figure(sums));
}

double TuneProblem::figure(const TuneSums& sums) const {
  const double count = by_ == TuneBy::kLikelihood ? sums.observations : sums.truths;
  if (count == 0.0) return std::numeric_limits<double>::quiet_NaN();
  return by_ == TuneBy::kLikelihood ? sums.log_likelihood / count : std::sqrt(sums.squared_error_m2 / count);
}

}  // namespace waymark::study
