#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "support/circle_world.hpp"
#include "waymark/core/filter.hpp"
#include "waymark/core/random.hpp"

namespace waymark::test {

inline std::vector<Observation> without_identity(std::vector<Observation> scan) {
  for (Observation& observation : scan) observation.id.reset();
  return scan;
}

/// Somewhere in the field of view, where nothing stands.
inline Observation clutter(RandomStream& random) {
  const double range_m = random.uniform(1.0, 12.0);
  return {std::nullopt, RangeBearing{range_m, random.uniform(-kPi, kPi)},
          Eigen::Matrix2d(Eigen::Vector2d(0.0025, 0.0004).asDiagonal())};
}

using Steps = std::vector<std::pair<Motion, std::vector<Observation>>>;

/// A drive among landmarks of unknown identity; every other scan shows something that is not there.
inline Steps cluttered_steps(CircleWorld& world, int count, std::uint64_t seed = 1) {
  RandomStream random(seed, StreamPurpose::kSimulation, 77);
  Steps steps;
  for (int i = 0; i < count; ++i) {
    const Motion motion = world.move();
    steps.emplace_back(motion, without_identity(world.look()));
    if (i % 2 == 0) steps.back().second.push_back(clutter(random));
  }
  return steps;
}

inline void drive(Filter& filter, CircleWorld& world, int count, std::uint64_t seed = 1) {
  for (const auto& [motion, scan] : cluttered_steps(world, count, seed)) {
    filter.predict(motion);
    filter.correct(scan);
  }
}

inline double nearest_m(const Snapshot& snapshot, const Eigen::Vector2d& p) {
  double nearest = 1e9;
  for (const LandmarkEstimate& landmark : snapshot.landmarks)
    nearest = std::min(nearest, (landmark.position_m.head<2>() - p).norm());
  return nearest;
}

}  // namespace waymark::test
