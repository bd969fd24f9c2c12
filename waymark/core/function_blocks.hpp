#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "waymark/core/stamp.hpp"

namespace waymark {

/// CPU time of the calling thread; about 0.3 us per call.
[[nodiscard]] Duration thread_cpu_time();

/// The timing table: calls and CPU time per named function block. Recording allocates nothing.
class FunctionBlocks {
 public:
  struct Row {
    std::string_view name;
    std::int64_t calls = 0;
    Duration total{0};
  };

  /// Names must outlive the table: string literals.
  FunctionBlocks(std::initializer_list<std::string_view> names) {
    for (const auto name : names) rows_.push_back({name});
  }

  void record(std::size_t block, Duration spent) {
    ++rows_[block].calls;
    rows_[block].total += spent;
  }
  [[nodiscard]] std::span<const Row> rows() const { return rows_; }

 private:
  std::vector<Row> rows_;
};

/// Walks through consecutive blocks with one clock reading at each border.
class BlockTimer {
 public:
  explicit BlockTimer(FunctionBlocks& table) : table_(table), last_(thread_cpu_time()) {}

  /// What ran since the last call belongs to `block`.
  void finish(std::size_t block) {
    const Duration now = thread_cpu_time();
    table_.record(block, now - last_);
    last_ = now;
  }

 private:
  FunctionBlocks& table_;
  Duration last_;
};

}  // namespace waymark
