#include "waymark/ekf/recency.hpp"

#include <algorithm>
#include <functional>

namespace waymark::ekf {

Recency::Recency(int capacity) {
  seen_.reserve(static_cast<std::size_t>(capacity));
  ranked_.reserve(static_cast<std::size_t>(capacity));
}

void Recency::begin_step() {
  step_began_ = now_;
  in_view_ = 0;
}

void Recency::count(int member) {
  if (member != kNoMember && seen(member) > step_began_) return;
  ++in_view_;
  max_in_view_ = std::max(max_in_view_, in_view_);
}

void Recency::mark_seen(int member) {
  if (member != kNoMember) seen_[static_cast<std::size_t>(member)] = now_;
}

void Recency::leave(int member) {
  seen_[static_cast<std::size_t>(member)] = seen_.back();
  seen_.pop_back();
}

Recency::Latest Recency::latest(std::size_t count) {
  if (count >= seen_.size()) return {0, static_cast<std::ptrdiff_t>(seen_.size())};
  ranked_ = seen_;
  std::nth_element(ranked_.begin(), ranked_.begin() + static_cast<std::ptrdiff_t>(count) - 1, ranked_.end(),
                   std::greater<>());
  const Clock oldest = ranked_[count - 1];
  const auto newer = std::ranges::count_if(seen_, [&](Clock seen) { return seen > oldest; });
  return {oldest, static_cast<std::ptrdiff_t>(count) - newer};
}

}  // namespace waymark::ekf
