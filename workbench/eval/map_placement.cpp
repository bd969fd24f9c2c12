#include "workbench/eval/map_placement.hpp"

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "workbench/eval/median.hpp"

namespace waymark::eval {
namespace {

/// Median distance of the landmarks from where the path begins.
double reach_m(std::span<const LandmarkEstimate> map, const Pose2& start) {
  std::vector<double> distances_m;
  for (const LandmarkEstimate& landmark : map)
    distances_m.push_back((landmark.position_m.head<2>() - start.position()).norm());
  return median(std::move(distances_m)).value_or(0.0);
}

}  // namespace

FitAngle fit_angle(std::span<const PosePair> pairs, const PathFit& fit) {
  const auto n = static_cast<double>(pairs.size());
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  for (const PosePair& pair : pairs) centre += position_of(pair.truth) / n;
  double spread = 0.0, error = 0.0;
  for (const PosePair& pair : pairs) {
    spread += (position_of(pair.truth) - centre).squaredNorm();
    error += (fit.T_truth_estimate * pair.estimate.position() - position_of(pair.truth)).squaredNorm();
  }
  FitAngle angle{.spread_m = std::sqrt(spread / n), .sigma_m = std::sqrt(0.5 * error / n)};
  angle.sigma_rad =
      angle.spread_m > 0.0 ? angle.sigma_m / angle.spread_m : std::numeric_limits<double>::infinity();
  return angle;
}

bool start_places_map(std::span<const PosePair> pairs, std::span<const LandmarkEstimate> map,
                      const StartAlignment& start, const FitAngle& angle) {
  constexpr double kTimes = 10.0;
  if (pairs.empty() || map.empty() || start.heading == AnchorHeading::kPath) return false;
  return angle.sigma_rad * reach_m(map, pairs.front().estimate) > kTimes * angle.sigma_m;
}

}  // namespace waymark::eval
