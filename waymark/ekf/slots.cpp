#include "waymark/ekf/slots.hpp"

namespace waymark::ekf {

Slots::Slots(int capacity, int region_capacity)
    : local_of_slot_(static_cast<std::size_t>(capacity + region_capacity), -1) {
  slots_.reserve(static_cast<std::size_t>(capacity));
  members_.reserve(static_cast<std::size_t>(region_capacity));
  freed_.reserve(local_of_slot_.size());
}

void Slots::remove(int index) {
  slots_[static_cast<std::size_t>(index)] = slots_.back();
  slots_.pop_back();
}

void Slots::enter(int slot) {
  local_of_slot_[static_cast<std::size_t>(slot)] = static_cast<int>(members_.size());
  members_.push_back(slot);
}

int Slots::leave(int local) {
  const auto at = static_cast<std::size_t>(local);
  const int slot = members_[at];
  members_[at] = members_.back();
  local_of_slot_[static_cast<std::size_t>(members_[at])] = local;
  local_of_slot_[static_cast<std::size_t>(slot)] = -1;
  members_.pop_back();
  return slot;
}

int Slots::take_freed() {
  const int slot = freed_.back();
  freed_.pop_back();
  return slot;
}

}  // namespace waymark::ekf
