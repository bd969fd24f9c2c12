#include "workbench/eval/align.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include "workbench/eval/median.hpp"

namespace waymark::eval {
namespace {

using Points = std::span<const Eigen::Vector2d>;

/// Sums over centred points q (from) and p (to).
struct Moments {
  Eigen::Vector2d mean_from = Eigen::Vector2d::Zero();
  Eigen::Vector2d mean_to = Eigen::Vector2d::Zero();
  double dot = 0.0;      ///< sum of q . p
  double cross = 0.0;    ///< sum of q x p
  double squares = 0.0;  ///< sum of q . q
};

Eigen::Vector2d mean(Points points) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& point : points) sum += point;
  return sum / static_cast<double>(points.size());
}

Moments moments(Points from, Points to) {
  Moments m{.mean_from = mean(from), .mean_to = mean(to)};
  for (std::size_t i = 0; i < from.size(); ++i) {
    const Eigen::Vector2d q = from[i] - m.mean_from;
    const Eigen::Vector2d p = to[i] - m.mean_to;
    m.dot += q.dot(p);
    m.cross += perpendicular(q).dot(p);
    m.squares += q.squaredNorm();
  }
  return m;
}

std::vector<double> residuals(Points from, Points to, const Pose2& T_to_from) {
  const Eigen::Matrix2d R = T_to_from.rotation();
  std::vector<double> lengths;
  lengths.reserve(from.size());
  for (std::size_t i = 0; i < from.size(); ++i)
    lengths.push_back((R * from[i] + T_to_from.position() - to[i]).norm());
  return lengths;
}

/// Least median of squares: the best of the motions that two matches alone would give, by the median
/// residual.
Pose2 least_median_motion(Points from, Points to) {
  constexpr std::size_t kMaxPairs = 2000;
  const std::size_t n = from.size();
  const std::size_t stride = 1 + n * (n - 1) / 2 / kMaxPairs;
  Pose2 best;
  double best_median = std::numeric_limits<double>::infinity();
  std::size_t count = 0;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 1; j < n; ++j) {
      if (count++ % stride != 0) continue;
      const Pose2 T = *align_rigid(std::vector{from[i], from[j]}, std::vector{to[i], to[j]});
      const double middle = *median(residuals(from, to, T));
      if (middle >= best_median) continue;
      best_median = middle;
      best = T;
    }
  }
  return best;
}

/// Least squares over the points that `T_to_from` brings within three robust standard deviations.
Pose2 refit(Points from, Points to, const Pose2& T_to_from) {
  const std::vector<double> lengths = residuals(from, to, T_to_from);
  const double limit = 3.0 * robust_sigma(lengths);
  std::vector<Eigen::Vector2d> agreeing_from;
  std::vector<Eigen::Vector2d> agreeing_to;
  for (std::size_t i = 0; i < from.size(); ++i) {
    if (lengths[i] > limit) continue;
    agreeing_from.push_back(from[i]);
    agreeing_to.push_back(to[i]);
  }
  return align_rigid(agreeing_from, agreeing_to).value_or(T_to_from);
}

}  // namespace

std::optional<Pose2> align_rigid(Points from, Points to) {
  if (from.empty() || from.size() != to.size()) return std::nullopt;
  const Moments m = moments(from, to);
  const double angle_rad = std::atan2(m.cross, m.dot);
  const Eigen::Vector2d t = m.mean_to - rotation_matrix(angle_rad) * m.mean_from;
  return Pose2{t.x(), t.y(), wrap_angle(angle_rad)};
}

std::optional<Pose2> align_rigid_robust(Points from, Points to) {
  if (from.size() < 3 || from.size() != to.size()) return std::nullopt;
  constexpr int kRefits = 5;
  Pose2 T = least_median_motion(from, to);
  for (int i = 0; i < kRefits; ++i) T = refit(from, to, T);
  return T;
}

std::optional<double> fitted_scale(Points from, Points to) {
  if (from.empty() || from.size() != to.size()) return std::nullopt;
  const Moments m = moments(from, to);
  if (m.squares <= 0.0) return std::nullopt;
  return std::hypot(m.dot, m.cross) / m.squares;
}

std::optional<Similarity> align_similarity(Points from, Points to) {
  const auto scale = fitted_scale(from, to);
  if (!scale) return std::nullopt;
  const double angle_rad = align_rigid(from, to)->theta_rad;
  const Eigen::Vector2d t = mean(to) - *scale * (rotation_matrix(angle_rad) * mean(from));
  return Similarity{*scale, {t.x(), t.y(), angle_rad}};
}

}  // namespace waymark::eval
