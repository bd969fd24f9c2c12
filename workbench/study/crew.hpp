#pragma once

#include <atomic>
#include <thread>
#include <vector>

#include "workbench/study/sweep.hpp"

namespace waymark::study {

/// Threads that make the runs of a sweep, one run each at a time, until there are no more. Stopping the sweep
/// ends the runs under way without a result. What is thrown beside the runs fails the sweep.
class Crew {
 public:
  /// `threads` >= 1. The sweep must outlive the crew. Throws std::system_error where they cannot be started,
  /// the sweep being stopped then.
  Crew(Sweep& sweep, int threads);
  ~Crew();
  Crew(const Crew&) = delete;
  Crew& operator=(const Crew&) = delete;

  [[nodiscard]] bool busy() const { return working_ > 0; }

 private:
  void work();
  void make_runs();

  Sweep& sweep_;
  std::atomic<int> working_;
  std::vector<std::thread> threads_;
};

}  // namespace waymark::study
