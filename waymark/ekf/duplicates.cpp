#include "waymark/ekf/duplicates.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <Eigen/LU>

#include "waymark/core/gaussian.hpp"

namespace waymark::ekf {
namespace {

// Nats by which being one must be likelier than standing side by side.
constexpr double kMergeMargin = 3.0;
constexpr double kFarthestTwin_m = 10.0;
// Variance of the difference of a landmark and itself: as good as none, but S stays well conditioned.
constexpr double kSameVariance_m2 = 1e-6;

double density_of_others(const AssociationModel& model) { return std::max(model.landmarks_per_m2(), 1e-9); }

/// The largest distance at which the densest Gaussian still beats landmarks side by side: it has a standard
/// deviation of d / sqrt(2), and a density of 1 / (pi e d^2).
double farthest_twin_m(const AssociationModel& model) {
  return std::min(kFarthestTwin_m,
                  1.0 / std::sqrt(kPi * density_of_others(model) * std::exp(1.0 + kMergeMargin)));
}

/// That two landmarks are one, as an observation: seen from the robot their difference is zero. (Seen in the
/// world the same constraint would tell the filter its heading.)
LinearizedObservation twin_difference(const CompressedState& state, int landmark, int twin) {
  const Eigen::Matrix2d to_robot = rotation_matrix(-state.active().linearization_pose().theta_rad);
  const Eigen::Vector2d apart =
      (state.linearization_landmark(landmark) - state.linearization_landmark(twin)).head<2>();
  LinearizedObservation difference;
  difference.landmark = landmark;
  difference.anchor = twin;
  difference.nu = -to_robot * (state.landmark(landmark) - state.landmark(twin)).head<2>();
  difference.H_landmark.leftCols<2>() = to_robot;
  difference.H_anchor.leftCols<2>() = -to_robot;
  difference.H_pose.col(2) = -to_robot * perpendicular(apart);
  difference.R = kSameVariance_m2 * Eigen::Matrix2d::Identity();
  return difference;
}

/// Log-likelihood ratio that two landmarks are one, less the margin; nothing outside of the gate.
std::optional<double> score(PointMap& map, int landmark, int twin, const AssociationModel& model,
                            double gate) {
  map.state().consider(std::array{landmark, twin});
  const LinearizedObservation apart = twin_difference(map.state(), landmark, twin);
  const Eigen::Matrix2d S = map.state().common_covariance(apart, apart) + apart.R;
  const auto d2 = mahalanobis_squared<2>(apart.nu, S);
  if (!d2 || *d2 > gate) return std::nullopt;
  const double log_others = std::log(density_of_others(model));
  return -0.5 * (*d2 + std::log(S.determinant())) - kLogTwoPi - log_others - kMergeMargin;
}

}  // namespace

std::optional<Duplicate> find_duplicate(PointMap& map, const NearbyLandmarks& nearby,
                                        const AssociationModel& model, double gate) {
  const LandmarkTable& table = map.table();
  Duplicate best;
  for (int k = 0; k < table.size(); ++k) {
    if (!table.is_observed(k)) continue;
    nearby.visit(nearby.place(k), farthest_twin_m(model), [&](int twin) {
      const bool are_certain = table[k].existence.is_certain() && table[twin].existence.is_certain();
      if (twin == k || are_certain || table.is_observed(twin)) return;
      const auto likely = score(map, k, twin, model, gate);
      if (likely && *likely > best.score) best = {*likely, k, twin};
    });
  }
  return best.landmark >= 0 ? std::optional(best) : std::nullopt;
}

bool merge(PointMap& map, const Duplicate& duplicate) {
  if (!map.state().update(std::array{twin_difference(map.state(), duplicate.landmark, duplicate.twin)}))
    return false;
  const auto rank = [&table = map.table()](int k) {
    return std::pair(table[k].existence.is_certain(), table[k].observations);
  };
  const bool twin_stays = rank(duplicate.twin) > rank(duplicate.landmark);
  const int stays = twin_stays ? duplicate.twin : duplicate.landmark;
  const int goes = twin_stays ? duplicate.landmark : duplicate.twin;
  map.table().absorb(stays, goes);
  map.remove(goes);
  return true;
}

}  // namespace waymark::ekf
