#include "waymark/core/stopwatch.hpp"

#include <algorithm>
#include <chrono>

namespace waymark {
namespace {

constexpr Duration kWorthAsking = std::chrono::microseconds{100};
constexpr Duration kOldestMark = std::chrono::milliseconds{1};

}  // namespace

void Stopwatch::start() {
  start_ = monotonic_time();
  if (start_ - mark_.elapsed <= kOldestMark) return;
  mark_.cpu = thread_cpu_time();
  mark_.elapsed = start_ = monotonic_time();
}

Duration Stopwatch::stop() {
  const Duration end = monotonic_time();
  const Duration span = end - start_;
  if (span < kWorthAsking) return last_span_ = span;
  const Duration idle = (end - mark_.elapsed) - (thread_cpu_time() - mark_.cpu);
  // Since the mark the thread may have been idle before this span, too: it took no less than the last one.
  return last_span_ = std::clamp(span - idle, std::min(last_span_, span), span);
}

}  // namespace waymark
