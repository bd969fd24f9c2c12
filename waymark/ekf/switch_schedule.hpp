#pragma once

namespace waymark::ekf {

/// How the work of a switch of submap is spread over the updates of the next one: an even share for each; and
/// more if more work than room is left, halfway through the submap and later, so that none is left when it is
/// full.
class SwitchSchedule {
 public:
  SwitchSchedule() = default;
  /// For `work` flop and a submap that has room for so many more landmarks.
  SwitchSchedule(double work, int room) : work_(work), room_(room) {}

  /// Flop to do at this update, where `remaining` are left to do and there is room for so many more
  /// landmarks.
  [[nodiscard]] double share(double remaining, int room) const;

 private:
  double work_ = 0.0;
  int room_ = 0;
};

}  // namespace waymark::ekf
