#pragma once

#include <span>

#include "waymark/core/filter.hpp"
#include "waymark/core/motion.hpp"

namespace waymark {

/// Whether more of a scan was gated than accepted. O(observations).
[[nodiscard]] bool is_mostly_gated(std::span<const Innovation> innovations);

/// Has a filter expect its robot farther and farther from where it believes it to be, until at least half of
/// a scan passes the gate: a slip that the odometry noise does not explain. Calls `inflate(added_motion)`
/// while `innovations` are mostly gated: it makes the pose less sure by a motion of zero mean, independent in
/// x, y and theta (robot frame), and gates again. The standard deviations begin at 0.02 m and
/// 0.02 rad and double from call to call, as often as said: about 3 m and 3 rad in all for eight calls, 0.2 m
/// and 0.2 rad for four.
template <class Inflate>
void inflate_until_accepted(std::span<const Innovation> innovations, const Inflate& inflate, int most = 8) {
  constexpr double kFirstSigma = 0.02;  // m, rad
  Motion added_motion;
  added_motion.covariance = kFirstSigma * kFirstSigma * Eigen::Matrix3d::Identity();
  for (int calls = 0; calls < most && is_mostly_gated(innovations); ++calls) {
    inflate(added_motion);
    added_motion.covariance *= 4.0;
  }
}

}  // namespace waymark
