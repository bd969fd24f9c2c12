#include "waymark/association/contradictions.hpp"

#include <algorithm>

namespace waymark {
namespace {

constexpr std::size_t kMaxSupporters = 16;

}  // namespace

Contradictions::Contradictions(const LandmarkSensor& sensor) : seen_(sensor) {
  contradictions_.reserve(LocalMap::kCapacity);
  supporters_.reserve(kMaxSupporters);
}

void Contradictions::predict(const Motion& motion) {
  seen_.predict(motion);
  travelled_m_ += travelled_m(motion);
}

Contradiction& Contradictions::contradict(LandmarkId id, const Observation& observation) {
  const auto at = std::ranges::find(contradictions_, id, &Contradiction::id);
  const auto now = seen_.locate(observation);
  const Contradiction first{
      .id = id, .began_at_support = support_, .began_at_m = travelled_m_, .placed = now.has_value()};
  if (at == contradictions_.end()) {
    if (contradictions_.size() == LocalMap::kCapacity) forget(contradictions_.front().id);
    if (now) seen_.observe(*now);
    return contradictions_.emplace_back(first);
  }
  const ObservedLandmark* const before = seen_.find(id);
  const bool agrees = !now || !before || LocalMap::agree(*before, *now);
  if (now) seen_.observe(*now);
  const int in_a_row = at->in_a_row + 1;
  if (agrees)
    ++at->observations;
  else
    *at = first;
  at->in_a_row = in_a_row;
  return *at;
}

void Contradictions::support(LandmarkId id, bool is_connected) {
  forget(id);
  if (!is_connected) return;
  ++support_;
  std::erase_if(supporters_, [id](const Supporter& each) { return each.id == id; });
  if (supporters_.size() == kMaxSupporters) supporters_.erase(supporters_.begin());
  supporters_.push_back({id, support_});
}

void Contradictions::forget(LandmarkId id) {
  seen_.erase(id);
  std::erase_if(contradictions_, [id](const Contradiction& each) { return each.id == id; });
}

void Contradictions::clear() {
  seen_.clear();
  contradictions_.clear();
  supporters_.clear();
}

const Contradiction* Contradictions::find(LandmarkId id) const {
  const auto at = std::ranges::find(contradictions_, id, &Contradiction::id);
  return at != contradictions_.end() ? &*at : nullptr;
}

int Contradictions::supporters_since(const Contradiction& contradiction) const {
  return static_cast<int>(std::ranges::count_if(supporters_, [&](const Supporter& each) {
    return each.supported_at > contradiction.began_at_support;
  }));
}

}  // namespace waymark
