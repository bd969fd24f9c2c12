#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <string_view>
#include <vector>

#include "waymark/core/clocks.hpp"
#include "waymark/core/stamp.hpp"
#include "waymark/core/timing_share.hpp"

namespace waymark {

/// The timing table: calls and time per named function block. Recording allocates nothing.
class FunctionBlocks {
 public:
  struct Row {
    std::string_view name;
    std::int64_t calls = 0;
    Duration total{0};
  };

  /// Names must outlive the table: string literals.
  FunctionBlocks(std::initializer_list<std::string_view> names) : shares_(names.size()) {
    for (const auto name : names) rows_.push_back({name});
  }

  /// One call, and its time; or that of several, where it is the one of them that was timed.
  void record(std::size_t block, Duration spent) {
    ++rows_[block].calls;
    rows_[block].total += spent;
  }
  [[nodiscard]] std::span<const Row> rows() const { return rows_; }

 private:
  friend class BlockTimer;

  std::vector<Row> rows_;
  std::vector<TimingShare> shares_;  // of the walks that begin with each block
};

/// Walks through consecutive blocks with one reading of the monotonic clock at each border. Where blocks are
/// so short that this would take long in comparison, only some walks are timed, each for those between; calls
/// are all counted.
class BlockTimer {
 public:
  /// `first` is the block that the walk begins with.
  BlockTimer(FunctionBlocks& table, std::size_t first)
      : table_(table), share_(table.shares_[first]), is_timed_(share_.take()) {
    if (is_timed_) start_ = last_ = monotonic_time();
  }
  ~BlockTimer() {
    if (is_timed_) share_.took(last_ - start_, readings_);
  }
  BlockTimer(const BlockTimer&) = delete;
  BlockTimer& operator=(const BlockTimer&) = delete;

  /// What ran since the last call belongs to `block`.
  void finish(std::size_t block) {
    if (!is_timed_) return table_.record(block, Duration{0});
    const Duration now = monotonic_time();
    table_.record(block, share_.weight() * (now - last_));
    last_ = now;
    ++readings_;
  }

 private:
  FunctionBlocks& table_;
  TimingShare& share_;
  bool is_timed_;
  int readings_ = 1;
  Duration start_{0};
  Duration last_{0};
};

}  // namespace waymark
