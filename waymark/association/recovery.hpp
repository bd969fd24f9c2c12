#pragma once

#include <span>

#include "waymark/core/filter.hpp"
#include "waymark/core/motion.hpp"

namespace waymark {

/// Recovery from a slip that the odometry noise does not explain. A filter that only went on gating would
/// stay lost.
///
/// Misread identities are rare. So many consecutive gated observations, in a scan that is mostly gated,
/// mean that the pose is wrong, not the observations. Then its covariance is inflated step by step until
/// at least half of the scan passes the gate.
class Recovery {
 public:
  /// Counts the outcomes of one scan, once. True if the robot is lost. O(observations).
  [[nodiscard]] bool is_lost(std::span<const Innovation> innovations);

  /// Calls `inflate(added_motion)` while `innovations` are mostly gated: it makes the pose less sure by the
  /// motion `added_motion`, of zero mean and independent in x, y and theta (robot frame), and gates again
  /// what was gated. The standard deviations begin at 0.02 m and 0.02 rad and double from call to call, eight
  /// at most: about 3 m and 3 rad in all.
  template <class Inflate>
  void recover(std::span<const Innovation> innovations, const Inflate& inflate) {
    ++recoveries_;
    gated_in_a_row_ = 0;
    Motion added_motion = first_inflation();
    for (int doublings = 0; doublings < kMaxDoublings && is_mostly_gated(innovations); ++doublings) {
      inflate(added_motion);
      added_motion.covariance *= 4.0;
    }
  }

  /// How often the robot was lost.
  [[nodiscard]] int recoveries() const { return recoveries_; }

 private:
  static constexpr int kMaxDoublings = 8;

  [[nodiscard]] static bool is_mostly_gated(std::span<const Innovation> innovations);
  [[nodiscard]] static Motion first_inflation();

  int gated_in_a_row_ = 0;
  int recoveries_ = 0;
};

}  // namespace waymark
