#pragma once

#include "waymark/core/clocks.hpp"

namespace waymark {

/// CPU time of the calling thread in spans of work, for next to nothing. Asking for CPU time takes as long as
/// a small step of a filter does. So spans go by the monotonic clock; only those of 0.1 ms and more are set
/// against the CPU time of the thread, and what it did not run for is taken out: a step does not count what
/// another program took of the core. The CPU time that this is counted from is asked for at most once per
/// millisecond.
class Stopwatch {
 public:
  void start();
  /// Since the last start(), which the same thread called.
  [[nodiscard]] Duration stop();

 private:
  /// Both clocks at one moment.
  struct Mark {
    Duration elapsed{0};
    Duration cpu{0};
  };

  Mark mark_;  // not long before start_
  Duration start_{0};
  Duration last_span_{0};
};

}  // namespace waymark
