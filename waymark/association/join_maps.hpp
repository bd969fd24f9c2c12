#pragma once

#include "waymark/core/map_state.hpp"
#include "waymark/core/result.hpp"

namespace waymark {

/// Which robot's pose a joined map keeps.
enum class PoseOf { kFirst, kSecond };

/// Two maps merged into one, in the frame of the first.
struct JoinedMap {
  MapState map;
  int common = 0;  ///< landmarks of both
  Pose2 T_first_second;
  double d2 = 0.0;  ///< how far apart they put them: chi-square with `dof` degrees of freedom if all is well
  int dof = 0;
};

/// Joins two maps of 2-D landmarks by the identities that they share. Nothing is known before of how their
/// frames lie; the common landmarks tell it, weighted by the covariance of their differences. That a common
/// landmark is one is then worked into everything that goes with it: landmarks that only one map has gain,
/// too. The maps must be independent: two that have been made of one log, or of one another, are not, and the
/// result would be too sure of itself.
///
/// Refused where fewer than two landmarks are common, and where what they put differently is beyond 99.9 % of
/// chi-square with 2 k - 3 degrees of freedom for k common landmarks. O(n^3).
[[nodiscard]] Result<JoinedMap> join_maps(const MapState& first, const MapState& second, PoseOf pose);

}  // namespace waymark
