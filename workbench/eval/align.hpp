#pragma once

#include <optional>
#include <span>

#include <Eigen/Core>

#include "waymark/core/pose2.hpp"

namespace waymark::eval {

/// The rigid motion T_to_from that brings the points `from` nearest to the points `to` in least squares:
/// closed form on centred points (Umeyama 1991 in the plane, no reflection). Same size; empty gives nothing;
/// coincident points leave the angle at 0. O(n).
[[nodiscard]] std::optional<Pose2> align_rigid(std::span<const Eigen::Vector2d> from,
                                               std::span<const Eigen::Vector2d> to);

/// `align_rigid` of points of which up to nearly half may be matched wrongly: least median of squares over
/// pairs of points (Rousseeuw 1984), then least squares over the points that agree. Nothing below three
/// points. Tries at most about 2000 pairs, always the same ones, O(n) each.
[[nodiscard]] std::optional<Pose2> align_rigid_robust(std::span<const Eigen::Vector2d> from,
                                                      std::span<const Eigen::Vector2d> to);

/// Scale, then rotation, then translation: p -> scale R(angle) p + t.
struct Similarity {
  double scale = 1.0;
  Pose2 motion;  ///< R(angle) and t

  [[nodiscard]] Eigen::Vector2d operator*(const Eigen::Vector2d& p) const { return motion * (scale * p); }
};

/// The similarity that brings the points `from` nearest to the points `to` (Umeyama 1991 in the plane, no
/// reflection). Nothing when `from` is a single place. O(n).
[[nodiscard]] std::optional<Similarity> align_similarity(std::span<const Eigen::Vector2d> from,
                                                         std::span<const Eigen::Vector2d> to);

/// How many times larger `to` is than `from` in the least-squares similarity (Umeyama 1991). It shows biased
/// wheels or ranges and is never used to score. Nothing when `from` is a single place. O(n).
[[nodiscard]] std::optional<double> fitted_scale(std::span<const Eigen::Vector2d> from,
                                                 std::span<const Eigen::Vector2d> to);

}  // namespace waymark::eval
