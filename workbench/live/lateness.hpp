#pragma once

#include <algorithm>

#include "waymark/core/stamp.hpp"

namespace waymark::live {

/// How late the events of one stream come: what is stamped before now less that has arrived, so that nobody
/// waits for it. The largest age of late, which fades by a hundredth of the time that passes; half of it and
/// `slack` are added for the next that is later, up to 200 times the slack in all.
class Lateness {
 public:
  explicit Lateness(Duration slack) : slack_(slack) {}

  void add(Stamp stamp, Stamp arrived) {
    largest_ = std::max(faded(arrived), std::clamp(arrived - stamp, Duration{0}, most()));
    since_ = arrived;
  }

  /// Everything stamped up to then has arrived.
  [[nodiscard]] Stamp all_until(Stamp now) const {
    return now - std::min(faded(now) * 3 / 2 + slack_, most());
  }

 private:
  [[nodiscard]] Duration most() const { return 200 * slack_; }
  [[nodiscard]] Duration faded(Stamp now) const {
    return std::max(largest_ - (now - since_) / 100, Duration{0});
  }

  Duration slack_;
  Duration largest_{0};
  Stamp since_;
};

}  // namespace waymark::live
