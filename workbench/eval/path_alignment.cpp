#include "workbench/eval/path_alignment.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Core>

#include "workbench/eval/align.hpp"

namespace waymark::eval {
namespace {

constexpr std::size_t kMinFitted = 3;

double direction(const Eigen::Vector2d& v) { return std::atan2(v.y(), v.x()); }

/// Turns about the first estimate by `angle_rad` and moves it onto the first truth.
Pose2 onto_first_truth(const PosePair& first, double angle_rad) {
  const Eigen::Vector2d t = position_of(first.truth) - rotation_matrix(angle_rad) * first.estimate.position();
  return {t.x(), t.y(), wrap_angle(angle_rad)};
}

/// From the direction of the first metre to that of the true one, or nothing when the robot never went so
/// far.
std::optional<double> angle_from_path(std::span<const PosePair> pairs) {
  constexpr double kPathM = 1.0;
  const PosePair& first = pairs.front();
  const auto away = [&](const PosePair& pair) {
    return (position_of(pair.truth) - position_of(first.truth)).eval();
  };
  const auto there =
      std::ranges::find_if(pairs, [&](const PosePair& pair) { return away(pair).norm() >= kPathM; });
  if (there == pairs.end()) return std::nullopt;
  return direction(away(*there)) - direction(there->estimate.position() - first.estimate.position());
}

}  // namespace

std::optional<StartAlignment> anchor_at_start(std::span<const PosePair> pairs) {
  if (pairs.empty()) return std::nullopt;
  const PosePair& first = pairs.front();
  if (first.truth.theta_rad) {
    return StartAlignment{onto_first_truth(first, *first.truth.theta_rad - first.estimate.theta_rad),
                          AnchorHeading::kTruth};
  }
  const auto angle_rad = angle_from_path(pairs);
  return StartAlignment{onto_first_truth(first, angle_rad.value_or(0.0)),
                        angle_rad ? AnchorHeading::kPath : AnchorHeading::kNone};
}

std::optional<PathFit> fit_path(std::span<const PosePair> pairs) {
  if (pairs.size() < kMinFitted) return std::nullopt;
  std::vector<Eigen::Vector2d> from;
  std::vector<Eigen::Vector2d> to;
  from.reserve(pairs.size());
  to.reserve(pairs.size());
  for (const PosePair& pair : pairs) {
    from.push_back(pair.estimate.position());
    to.push_back(position_of(pair.truth));
  }
  return PathFit{*align_rigid(from, to), fitted_scale(from, to)};
}

}  // namespace waymark::eval
