#pragma once

#include <vector>

#include "waymark/core/map_state.hpp"
#include "waymark/fastslam/belief.hpp"

namespace waymark::fastslam {

/// What the set believes of the landmarks that count in the map, in the order of the store: mean and
/// covariance of the mixture, sum w (Sigma_i + d_i d_i^T), d_i the deviation of a particle's mean from that
/// of all. World frame, m. Allocates. O(N landmarks).
[[nodiscard]] std::vector<LandmarkEstimate> summarise_landmarks(const Belief& belief);

/// The belief with all its correlations, moment-matched: the spread of (pose, landmarks) over the particles
/// plus the particles' own landmark covariances; the robot after the pending motion. Allocates. O(N
/// landmarks^2).
[[nodiscard]] MapState summarise(const Belief& belief);

}  // namespace waymark::fastslam
