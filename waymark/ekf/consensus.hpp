#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "waymark/core/filter.hpp"
#include "waymark/ekf/one_point_ransac.hpp"

namespace waymark::ekf {

/// Which matches of one block the state may believe: those that agree with each other (OnePointRansac), if
/// they are convincing. What was searched for in a wide ellipse is easily found where it is not, so landmarks
/// that would lead the state far need others to say the same. Nothing allocates after construction.
class Consensus {
 public:
  /// Room for so many observations. `gate` is that of the NIS of one observation, `area_px2` that of the
  /// image.
  Consensus(std::size_t capacity, double gate, double area_px2);

  /// One outcome per observation, of S and the innovations of all of them as OnePointRansac takes them:
  /// kMatched for those that may update the state; kGated for those that contradict them; kUnusable where
  /// that cannot be told. Valid until the next call. O(observations^2).
  [[nodiscard]] std::span<const Outcome> judge(const JointCovariance& S, std::span<const Eigen::Vector2d> nu);

  /// Whether an observation that did not agree may be used all the same because it fits where the others have
  /// led (a high-innovation inlier): with its NIS and S, px^2, after their update. These must tell its place:
  /// in a wide ellipse anything fits.
  [[nodiscard]] bool rescues(double nis, const Eigen::Matrix2d& S) const;

 private:
  void check_reacquired(const JointCovariance& S, std::span<const Eigen::Vector2d> nu,
                        std::span<const char> agrees, std::size_t known);
  [[nodiscard]] bool judge_together(const JointCovariance& S, std::span<const Eigen::Vector2d> nu,
                                    std::size_t known);

  double gate_;
  double consensus_gate_;
  double area_px2_;
  OnePointRansac all_;
  OnePointRansac together_;              ///< of those that come back after long
  std::vector<std::size_t> reacquired_;  ///< who they are
  std::vector<Outcome> outcomes_;
};

}  // namespace waymark::ekf
