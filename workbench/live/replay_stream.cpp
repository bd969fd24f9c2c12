#include "workbench/live/replay_stream.hpp"

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

#include "waymark/slam/odometer.hpp"

namespace waymark::live {
namespace {

constexpr auto kLongestSleep = std::chrono::milliseconds(50);

/// False where a stop was asked for meanwhile.
bool sleep_until(std::chrono::steady_clock::time_point when, const std::stop_token& stop) {
  for (auto now = std::chrono::steady_clock::now(); now < when && !stop.stop_requested();
       now = std::chrono::steady_clock::now())
    std::this_thread::sleep_until(std::min(when, now + kLongestSleep));
  return !stop.stop_requested();
}

}  // namespace

Result<std::optional<Stamp>> ReplayStream::first() {
  auto event = source_.next();
  if (!event) return event.error();
  if (!*event) return std::optional<Stamp>{};
  first_ = std::move(**event);
  return std::optional(first_->stamp);
}

void ReplayStream::run(const std::stop_token& stop, const SessionClock& clock, const Sink& sink) {
  state().connect();
  while (!stop.stop_requested()) {
    Result<std::optional<Event>> event = first_ ? std::exchange(first_, std::nullopt) : source_.next();
    if (!event) state().fail(event.error().message);
    if (!event || !*event) break;
    const Stamp stamp = (*event)->stamp;
    if (!sleep_until(clock.when(stamp), stop)) break;
    const Stamp arrived = clock.now();
    state().count_arrival(stamp, arrived, measures_motion((*event)->content));
    sink({std::move(**event), arrived});
  }
  state().end();
}

}  // namespace waymark::live
