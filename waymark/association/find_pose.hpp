#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "waymark/core/map_state.hpp"
#include "waymark/core/observation.hpp"
#include "waymark/core/pose2.hpp"

namespace waymark {

/// 99.9 % of chi-square with two degrees of freedom.
inline constexpr double kPlaceGate = 13.82;

/// A landmark as the robot saw it: robot frame, m.
struct ObservedLandmark {
  std::optional<LandmarkId> id;
  Eigen::Vector2d p_robot = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  int times = 1;  ///< that it was seen
};

/// Where in a map the robot may be.
struct PoseCandidate {
  Pose2 T_world_robot;
  std::vector<int> landmarks;  ///< of the map, by what was seen; -1: of none
  int agreeing = 0;            ///< how many are of one
};

struct PoseCandidates {
  PoseCandidate best;
  int rival = 0;  ///< how many agree on a place more than a metre or 0.3 rad away from there
};

/// Finds the pose from which most of what was seen stands where the map has it (consensus as in Fischler and
/// Bolles 1981, over all pairs instead of some): every pair that is as far apart as a pair of the map
/// proposes a pose, and the others are gated against it, with all that seen places and map, with its
/// correlations, are unsure of. What has an identity is compared with that landmark only, what has none with
/// all. The pose of the largest consensus, of several the nearest fit, is then fitted to all that agree.
/// A map of 2-D landmarks. Nothing agrees where no pair does. O(s^3 n^2) at worst for s seen without identity
/// and n in the map, O(s^3) with identities: not for the hot loop.
[[nodiscard]] PoseCandidates find_pose(std::span<const ObservedLandmark> seen, const MapState& map);

/// How many pairs of landmarks with identities that were seen more than once stand at another distance than
/// in the map (99.9 % gates, as above).
[[nodiscard]] int count_contradictions(std::span<const ObservedLandmark> seen, const MapState& map);

}  // namespace waymark
