#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "waymark/core/map_state.hpp"
#include "waymark/core/pose2.hpp"

#include "workbench/logs/source.hpp"

namespace waymark::eval {

/// Whether the ids of a map mean the same as the ids of the survey.
enum class LandmarkNames {
  kAuto,     ///< they do when any marker or barcode id stands in both
  kKnown,    ///< they do: numbers are compared, whatever family they were read as
  kUnknown,  ///< they do not: the nearest surveyed landmark is meant
};

/// Indices of one landmark in the map and in the survey.
struct LandmarkMatch {
  std::size_t estimated = 0;
  std::size_t surveyed = 0;
};

/// `kAuto` decided for these two maps; other values as they are. O(n log n).
[[nodiscard]] LandmarkNames resolve_names(LandmarkNames names, std::span<const LandmarkEstimate> map,
                                          std::span<const TrueLandmark> survey);

/// Equal numbers, one to one; of several with one number the first. In the order of the map. O(n log n).
[[nodiscard]] std::vector<LandmarkMatch> match_by_number(std::span<const LandmarkEstimate> map,
                                                         std::span<const TrueLandmark> survey);

/// One to one, nearest first, no further than `max_distance_m` apart on the plane after `T_truth_estimate`:
/// landmarks may stand a metre apart. O(n m).
[[nodiscard]] std::vector<LandmarkMatch> match_nearest(std::span<const LandmarkEstimate> map,
                                                       std::span<const TrueLandmark> survey,
                                                       const Pose2& T_truth_estimate,
                                                       double max_distance_m = 0.5);

/// Estimate minus survey after `T_truth_estimate`; z counts only for landmarks that have a height (a z or its
/// variance).
[[nodiscard]] Eigen::Vector3d landmark_error_m(const LandmarkEstimate& estimate, const TrueLandmark& truth,
                                               const Pose2& T_truth_estimate);

/// How well the map agrees with the survey. Each figure is empty where it cannot be had.
struct MapError {
  std::size_t matched = 0;
  std::size_t missed = 0;                 ///< surveyed, not in the map
  std::size_t spurious = 0;               ///< in the map, not in the survey
  std::optional<double> rmse_m;           ///< under the path's least-squares alignment
  std::optional<double> rmse_anchored_m;  ///< under the anchor at the start
  std::optional<double> rmse_self_m;      ///< landmarks aligned by themselves; needs three of them
  std::optional<double> nees_per_dof;     ///< mean, anchored, over the dimensions of each landmark; ideal 1
  std::size_t nees_skipped = 0;           ///< landmarks whose covariance is not positive definite
};

/// Where the path lies on the truth; both empty when the path has no truth.
struct PathFrames {
  std::optional<Pose2> T_truth_anchored;
  std::optional<Pose2> T_truth_aligned;
};

/// Which landmark is which: by number, or the nearest under the path's alignment. Nothing when the ids tell
/// nothing and the path has no truth.
[[nodiscard]] std::optional<std::vector<LandmarkMatch>> match_landmarks(
    std::span<const LandmarkEstimate> map, std::span<const TrueLandmark> survey, const PathFrames& frames,
    LandmarkNames names = LandmarkNames::kAuto);

/// The places of matched landmarks on the plane, in the frames of the estimate and of the truth.
struct MatchedPlaces {
  std::vector<Eigen::Vector2d> estimated;
  std::vector<Eigen::Vector2d> surveyed;
};

[[nodiscard]] MatchedPlaces places(std::span<const LandmarkEstimate> map,
                                   std::span<const TrueLandmark> survey,
                                   std::span<const LandmarkMatch> matches);

/// Nothing when there is no survey, or neither names nor a path truth to find out which landmark is which.
[[nodiscard]] std::optional<MapError> map_error(std::span<const LandmarkEstimate> map,
                                                std::span<const TrueLandmark> survey,
                                                const PathFrames& frames,
                                                LandmarkNames names = LandmarkNames::kAuto);

}  // namespace waymark::eval
