#pragma once

#include <atomic>
#include <thread>
#include <vector>

#include "workbench/study/sweep.hpp"

namespace waymark::study {

/// Threads that make the runs of a sweep, one run each at a time, until there are no more. Stopping the sweep
/// ends the runs under way without a result. What is thrown beside the runs fails the sweep.
class SweepWorkers {
 public:
  /// `threads` >= 1. The sweep must outlive them. Throws std::system_error where they cannot be
  /// started, the sweep being stopped then.
  SweepWorkers(Sweep& sweep, int threads);
  ~SweepWorkers();
  SweepWorkers(const SweepWorkers&) = delete;
  SweepWorkers& operator=(const SweepWorkers&) = delete;

  [[nodiscard]] bool busy() const { return working_ > 0; }

 private:
  void work();
  void make_runs();

  Sweep& sweep_;
  std::atomic<int> working_;
  std::vector<std::thread> threads_;
};

}  // namespace waymark::study
