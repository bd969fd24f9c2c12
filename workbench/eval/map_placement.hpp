#pragma once

#include <optional>
#include <span>

#include "waymark/core/map_state.hpp"

#include "workbench/eval/associate.hpp"
#include "workbench/eval/path_alignment.hpp"

namespace waymark::eval {

/// What a fit of the path says of the angle between both frames.
struct FitAngle {
  double spread_m = 0.0;   ///< root mean square distance of the true positions from their centre
  double sigma_m = 0.0;    ///< of the positions about the fit, per axis
  double sigma_rad = 0.0;  ///< sigma_m / spread_m: errors of a path go together, so that many positions tell
                           ///< the angle no better than few; infinite where the robot stood
};

/// Of the least-squares motion of these pairs. O(n).
[[nodiscard]] FitAngle fit_angle(std::span<const PosePair> pairs, const PathFit& fit);

/// The angle of the fit moves a landmark by its sigma times its distance. Where that is more than ten times
/// what the path itself is off (sigma_m), so where the landmarks are more than ten times further off than the
/// path spreads, the start places the map instead: what is fitted then is noise. Nothing else where the start
/// takes its own angle from the path. `map` in the frame of the estimate.
[[nodiscard]] bool start_places_map(std::span<const PosePair> pairs, std::span<const LandmarkEstimate> map,
                                    const StartAlignment& start, const FitAngle& angle);

}  // namespace waymark::eval
