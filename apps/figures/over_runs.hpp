#pragma once

#include <algorithm>
#include <cmath>
#include <thread>
#include <vector>

#include "waymark/core/parallel.hpp"
#include "waymark/eval/median.hpp"

namespace waymark {

/// Makes runs 0 to `count` - 1 by job(i), on all cores.
template <class Job>
void for_all_runs(int count, const Job& job) {
  ThreadTeam team(static_cast<int>(std::max(1U, std::thread::hardware_concurrency())));
  team.run(count, job);
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

}  // namespace waymark
