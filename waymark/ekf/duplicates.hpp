#pragma once

#include <optional>

#include "waymark/association/association_options.hpp"
#include "waymark/ekf/nearby_landmarks.hpp"
#include "waymark/ekf/point_map.hpp"

namespace waymark::ekf {

/// Two landmarks that are likely one.
struct Duplicate {
  double score = 0.0;  ///< log-likelihood ratio over a margin, nats
  int landmark = -1;
  int twin = -1;
};

/// The likeliest pair of a landmark that was observed in this scan and one beside it that was not. That they
/// are one is likely by log N(p - p'; 0, S) over the density of landmarks side by side (docs/association.md,
/// "Merging"); two that are certain never are. `gate` is the chi-square threshold for two degrees of freedom,
/// `nearby` of the present estimate. O(1) per pair within reach, which enters the submap of a compressed map.
[[nodiscard]] std::optional<Duplicate> find_duplicate(PointMap& map, const NearbyLandmarks& nearby,
                                                      const AssociationModel& model, double gate);

/// Updates the state with the observation that the two are one, and removes the less sure of them: the one
/// that is not certain, or was observed less often. False, and nothing changed, if S is not positive
/// definite.
[[nodiscard]] bool merge(PointMap& map, const Duplicate& duplicate);

}  // namespace waymark::ekf
