#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace waymark::ekf {

/// Which members of a submap were seen last, and how many landmarks are seen at once. Members are known by
/// their index in the active state. Nothing allocates after construction.
class Recency {
 public:
  /// Counted by updates; a landmark that was removed was never seen.
  using Clock = std::int64_t;

  /// For submaps of up to `capacity` members.
  explicit Recency(int capacity);

  /// The robot moves: what is seen from now on is seen from a new place.
  void begin_step();
  void begin_update() { ++now_; }
  /// A landmark that is not in the submap.
  static constexpr int kNoMember = -1;
  /// A landmark is about to be seen: a member that is seen again in a step counts once.
  void count(int member);
  /// Does nothing for kNoMember.
  void mark_seen(int member);
  void mark_removed(int member) { seen_[static_cast<std::size_t>(member)] = kRemoved; }
  [[nodiscard]] bool is_removed(int member) const {
    return seen_[static_cast<std::size_t>(member)] == kRemoved;
  }

  /// Landmarks seen in this step, and most in one step of this submap.
  [[nodiscard]] int in_view() const { return in_view_; }
  [[nodiscard]] int max_in_view() const { return max_in_view_; }
  void begin_submap() { max_in_view_ = in_view_; }

  /// A member comes last, as seen now.
  void enter() { seen_.push_back(now_); }
  /// The last member takes the place of one that leaves.
  void leave(int member);

  /// The members that were seen last.
  class Latest {
   public:
    /// To be asked once for each member, from the last to the first.
    [[nodiscard]] bool takes(Clock seen) {
      return seen != kRemoved && (seen > oldest || (seen == oldest && as_old-- > 0));
    }
    Clock oldest = 0;
    std::ptrdiff_t as_old = 0;  ///< how many there may be of the oldest
  };
  /// `count` of them at most, without those that were removed.
  [[nodiscard]] Latest latest(std::size_t count);
  [[nodiscard]] Clock seen(int member) const { return seen_[static_cast<std::size_t>(member)]; }

 private:
  static constexpr Clock kRemoved = -1;

  Clock now_ = 0;
  Clock step_began_ = 0;
  int in_view_ = 0;
  int max_in_view_ = 0;
  std::vector<Clock> seen_;    // by member
  std::vector<Clock> ranked_;  // scratch
};

}  // namespace waymark::ekf
