#pragma once

#include <cstdint>
#include <optional>
#include <utility>

#include "waymark/core/motion.hpp"

namespace waymark {

/// Decides which points of a path without end are kept, so that there are never more than `most`: all, then
/// every second, fourth, eighth... The motions between those that are kept are put together.
class MotionThinner {
 public:
  /// The motion since the last point that was kept, where this one is to be.
  [[nodiscard]] std::optional<Motion> add(const Motion& motion) {
    pending_ = pending_ ? compose(*pending_, motion) : motion;
    if (count_++ % stride_ != 0) return std::nullopt;
    return std::exchange(pending_, std::nullopt);
  }

  /// Every second point was dropped.
  void double_stride() { stride_ *= 2; }

 private:
  std::optional<Motion> pending_;
  std::uint64_t count_ = 0;
  std::uint64_t stride_ = 1;
};

}  // namespace waymark
