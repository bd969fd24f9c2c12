#pragma once

#include <vector>

namespace waymark::ekf {

/// Where the landmarks of a compressed map stand. A landmark has a slot in the passive submap for as long as
/// it is there, and a place in the active state for as long as it is a member of the submap. Its index, by
/// which others know it, changes when another one is removed. Nothing allocates after construction.
class Slots {
 public:
  /// For maps of `capacity` landmarks and submaps of `submap_capacity`: with so many that were removed but
  /// are still members there are slots for both together.
  Slots(int capacity, int submap_capacity);

  [[nodiscard]] int landmarks() const { return static_cast<int>(slots_.size()); }
  [[nodiscard]] int slot_of(int index) const { return slots_[static_cast<std::size_t>(index)]; }
  /// Index in the active state, or -1.
  [[nodiscard]] int local_of(int index) const {
    return local_of_slot_[static_cast<std::size_t>(slot_of(index))];
  }
  [[nodiscard]] bool is_active(int index) const { return local_of(index) >= 0; }
  /// Slots by index in the active state.
  [[nodiscard]] const std::vector<int>& members() const { return members_; }

  /// A new landmark, whose index is the last one.
  void append(int slot) { slots_.push_back(slot); }
  /// The last landmark takes the index of one that is no more. The slot is still occupied.
  void remove(int index);

  /// The slot becomes the last member of the submap.
  void enter(int slot);
  /// The last member takes the place of one that leaves, whose slot is returned.
  int leave(int local);

  /// Slots that nothing was in so far come into use in order; those that were freed are used again.
  [[nodiscard]] bool has_unused() const { return used_ < static_cast<int>(local_of_slot_.size()); }
  [[nodiscard]] bool has_freed() const { return !freed_.empty(); }
  [[nodiscard]] int take_unused() { return used_++; }
  [[nodiscard]] int take_freed();
  void free(int slot) { freed_.push_back(slot); }

 private:
  std::vector<int> slots_;          // by landmark
  std::vector<int> local_of_slot_;  // index in the active state, or -1
  std::vector<int> members_;        // the other way round
  std::vector<int> freed_;
  int used_ = 0;
};

}  // namespace waymark::ekf
