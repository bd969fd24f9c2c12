#pragma once

#include <cstdint>

#include "waymark/core/stamp.hpp"

namespace waymark {

/// Decides which of many runs of the same code are timed: all where they take long, else as few as keep the
/// cost of reading clocks below half a percent of what is measured. Each timed run stands for those that were
/// passed over before it, whose number is random, so that what alternates is met fairly.
class TimingShare {
 public:
  /// Before a run: whether it is timed.
  [[nodiscard]] bool take() {
    if (passed_over_ >= pass_over_) return true;
    ++passed_over_;
    return false;
  }
  /// How many runs the timed one stands for, itself included.
  [[nodiscard]] int weight() const { return 1 + passed_over_; }
  /// After a timed run that took so long and read clocks so often.
  void took(Duration spent, int readings);

 private:
  int pass_over_ = 0;
  int passed_over_ = 0;
  std::int64_t timed_ = 0;
  Duration total_{0};  // of the timed
  std::uint32_t random_ = 1;
};

}  // namespace waymark
