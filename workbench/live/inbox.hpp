#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <vector>

#include "waymark/core/event.hpp"

namespace waymark::live {

/// An event, and when it came in, by the session's clock.
struct Arrival {
  Event event;
  Stamp arrived;
};

/// What has arrived and not been processed: streams put in on threads of their own, the filter's thread takes
/// out. Nothing of it grows without bound: of the images of one stream only the newest waits, and where
/// `kMost` arrivals wait a new one is dropped.
class Inbox {
 public:
  enum class Outcome { kTaken, kReplaced, kDropped };
  static constexpr std::size_t kMost = 4096;

  Inbox();

  /// kReplaced: an older image of the same stream had to go. kDropped: there is no room for this one.
  Outcome push(Arrival arrival);

  /// Wakes who waits in take().
  void wake();

  /// All that waits, in the order of arrival, into `arrivals`; waits until then if there is nothing.
  void take(std::vector<Arrival>& arrivals, std::chrono::steady_clock::time_point until);

 private:
  std::mutex mutex_;
  std::condition_variable arrived_;
  std::vector<Arrival> waiting_;
  bool awake_ = false;
};

}  // namespace waymark::live
