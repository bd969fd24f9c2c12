#pragma once

#include <algorithm>
#include <optional>

#include <Eigen/Core>

#include "waymark/fastslam/belief.hpp"

namespace waymark::test {

inline LandmarkId marker(int number) { return {LandmarkId::Family::kMarker, number}; }

inline Observation range_bearing(double range_m, double bearing_rad,
                                 std::optional<LandmarkId> id = std::nullopt) {
  return {id, RangeBearing{range_m, bearing_rad},
          Eigen::Matrix2d(Eigen::Vector2d(0.01, 0.0004).asDiagonal())};
}

inline Observation range_alone(double range_m, std::optional<LandmarkId> id = std::nullopt) {
  return {id, Range{range_m}, Eigen::Matrix2d(Eigen::Vector2d(0.01, 0.0).asDiagonal())};
}

/// A landmark that all particles know to be at a place, give or take 1 cm. Returns its index.
inline int add_point(fastslam::Belief& belief, const Eigen::Vector2d& p_world,
                     Identity identity = Identity::kKnown) {
  const bool known = identity == Identity::kKnown;
  const LandmarkId id = known ? marker(belief.landmarks.size()) : belief.landmarks.unused_id();
  const Existence existence = known ? Existence::certain() : Existence();
  const int landmark = belief.add({.id = id, .identity = identity, .existence = existence},
                                  kernels::LandmarkForm::kPoint, 1, {});
  const auto& m = belief.store.view(landmark, Eigen::Vector2d::Zero()).modes->gaussian;
  for (int i = 0; i < belief.particles.count(); ++i) {
    m.a[i] = static_cast<float>(p_world.x());
    m.b[i] = static_cast<float>(p_world.y());
    m.aa[i] = m.bb[i] = 1e-4F;
    m.ab[i] = 0.0F;
  }
  if (!known) std::fill_n(belief.store.existence(landmark), belief.particles.count(), 1.0F);
  return landmark;
}

}  // namespace waymark::test
