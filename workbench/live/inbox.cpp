#include "workbench/live/inbox.hpp"

#include <algorithm>
#include <utility>

namespace waymark::live {

Inbox::Inbox() { waiting_.reserve(kMost); }

Inbox::Outcome Inbox::push(Arrival arrival) {
  Outcome outcome = Outcome::kTaken;
  {
    const std::lock_guard lock(mutex_);
    if (std::holds_alternative<Image>(arrival.event.content)) {
      const auto older = std::ranges::find_if(waiting_, [&](const Arrival& each) {
        return each.event.stream == arrival.event.stream && std::holds_alternative<Image>(each.event.content);
      });
      if (older != waiting_.end()) {
        waiting_.erase(older);
        outcome = Outcome::kReplaced;
      }
    }
    if (waiting_.size() >= kMost) return Outcome::kDropped;
    waiting_.push_back(std::move(arrival));
  }
  arrived_.notify_one();
  return outcome;
}

void Inbox::wake() {
  {
    const std::lock_guard lock(mutex_);
    awake_ = true;
  }
  arrived_.notify_one();
}

void Inbox::take(std::vector<Arrival>& arrivals, std::chrono::steady_clock::time_point until) {
  arrivals.clear();
  std::unique_lock lock(mutex_);
  arrived_.wait_until(lock, until, [this] { return !waiting_.empty() || awake_; });
  awake_ = false;
  waiting_.swap(arrivals);
}

}  // namespace waymark::live
