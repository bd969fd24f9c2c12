#include "waymark/vision/visual_memory.hpp"

#include <algorithm>

namespace waymark::vision {

VisualMemory::VisualMemory(int patch_px) : patch_px_(patch_px) {
  entries_.reserve(kRoom);
  free_.reserve(kRoom);
  slots_.reserve(kRoom);
}

std::vector<VisualMemory::Entry>::iterator VisualMemory::place_of(LandmarkId id) {
  return std::ranges::lower_bound(entries_, id, {}, &Entry::id);
}

Appearance* VisualMemory::find(LandmarkId id) {
  const auto place = place_of(id);
  return place != entries_.end() && place->id == id ? &slots_[place->slot] : nullptr;
}

void VisualMemory::remember(LandmarkId id, const ReferencePatch& reference, const Pose2& T_world_robot,
                            const CameraPose& seen_from) {
  forget(id);
  const std::size_t slot = store({T_world_robot, seen_from, WarpedPatch(reference, patch_px_)});
  entries_.insert(place_of(id), {id, slot});
}

std::size_t VisualMemory::store(const Appearance& appearance) {
  if (free_.empty()) {
    slots_.push_back(appearance);
    return slots_.size() - 1;
  }
  const std::size_t slot = free_.back();
  free_.pop_back();
  slots_[slot] = appearance;
  return slot;
}

std::vector<LandmarkPatch> VisualMemory::patches() const {
  std::vector<LandmarkPatch> patches;
  for (const Entry& entry : entries_) {
    const Appearance& appearance = slots_[entry.slot];
    const auto& pixels = appearance.patch.reference().pixels;
    patches.push_back({entry.id, appearance.T_world_robot, {pixels.begin(), pixels.end()}});
  }
  return patches;
}

void VisualMemory::forget(LandmarkId id) {
  const auto place = place_of(id);
  if (place == entries_.end() || place->id != id) return;
  free_.push_back(place->slot);
  entries_.erase(place);
}

}  // namespace waymark::vision
