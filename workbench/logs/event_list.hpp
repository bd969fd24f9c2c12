#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "workbench/logs/source.hpp"

namespace waymark {

/// A log that is held in memory: made rather than read, or read as a whole.
class EventList : public Source {
 public:
  /// Events of one stamp stay in the order in which they are given. O(n log n).
  EventList(LogInfo info, std::vector<Event> events, std::vector<std::string> notes = {})
      : info_(std::move(info)), events_(std::move(events)), notes_(std::move(notes)) {
    std::ranges::stable_sort(events_, {}, &Event::stamp);
  }

  [[nodiscard]] const LogInfo& info() const override { return info_; }
  [[nodiscard]] Result<std::optional<Event>> next() override {
    if (next_ == events_.size()) return std::optional<Event>{};
    return std::optional(std::move(events_[next_++]));
  }
  [[nodiscard]] std::vector<std::string> notes() const override { return notes_; }
  [[nodiscard]] double progress() const override {
    return events_.empty() ? 1.0 : static_cast<double>(next_) / static_cast<double>(events_.size());
  }

 private:
  LogInfo info_;
  std::vector<Event> events_;
  std::vector<std::string> notes_;
  std::size_t next_ = 0;
};

}  // namespace waymark
