#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <thread>
#include <vector>

#include "waymark/core/chi2.hpp"
#include "waymark/core/parallel.hpp"
#include "waymark/core/stamp.hpp"

#include "workbench/eval/median.hpp"

namespace waymark {

/// Makes runs 0 to `count` - 1 by job(i), on all cores.
template <class Job>
void for_all_runs(int count, const Job& job) {
  ThreadPool thread_pool(static_cast<int>(std::max(1U, std::thread::hardware_concurrency())));
  thread_pool.run(count, job);
}

template <class Run>
double sum(const std::vector<Run>& runs, double Run::*member) {
  double total = 0.0;
  for (const Run& each : runs) total += each.*member;
  return total;
}

template <class Run>
double mean(const std::vector<Run>& runs, double Run::*member) {
  return sum(runs, member) / static_cast<double>(runs.size());
}

template <class Run>
double median(const std::vector<Run>& runs, double Run::*member) {
  std::vector<double> values;
  for (const Run& each : runs) values.push_back(each.*member);
  return eval::median(values).value_or(NAN);
}

/// Runs that are worse than dead reckoning, or without a result.
template <class Run>
auto count_diverged(const std::vector<Run>& runs) {
  return std::ranges::count_if(runs,
                               [](const Run& one) { return !(one.rmse_m <= one.dead_reckoning_rmse_m); });
}

/// The pose NEES of one run.
using NeesOverTime = std::map<Stamp, double>;

/// The part of the stamps at which the mean NEES over the runs lies inside its 99 % band; stamps that some
/// run lacks (a covariance that is still singular) do not count.
inline double part_inside(const std::vector<NeesOverTime>& runs, double from_s, double to_s) {
  const auto n = static_cast<double>(runs.size());
  const double low = chi2_quantile(0.005, 3.0 * n) / n;
  const double high = chi2_quantile(0.995, 3.0 * n) / n;
  int inside = 0;
  int all = 0;
  for (const auto& [stamp, unused] : runs.front()) {
    if (to_seconds(stamp) < from_s || to_seconds(stamp) >= to_s) continue;
    if (!std::ranges::all_of(runs, [at = stamp](const NeesOverTime& run) { return run.contains(at); }))
      continue;
    double mean = 0.0;
    for (const NeesOverTime& run : runs) mean += run.at(stamp) / n;
    ++all;
    inside += mean >= low && mean <= high ? 1 : 0;
  }
  return all > 0 ? static_cast<double>(inside) / all : NAN;
}

}  // namespace waymark
