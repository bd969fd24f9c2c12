#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "waymark/core/map_state.hpp"
#include "waymark/core/pose2.hpp"

#include "workbench/eval/truth_track.hpp"
#include "workbench/logs/source.hpp"

namespace waymark::eval {

/// One landmark seen from the robot.
struct PositionObservation {
  Stamp stamp;
  LandmarkId id;
  Eigen::Vector2d p_robot_m = Eigen::Vector2d::Zero();  ///< robot frame
};

/// Where the observations say that each landmark is, in the frame of the truth: the median of its
/// observations, each placed by the true pose of its moment. Observations without a true pose are left out,
/// and landmarks with fewer than five observations. `truth_sensor_m`: where on the robot the truth was
/// measured. In order of id; covariances stay 0. O(n log n).
[[nodiscard]] std::vector<LandmarkEstimate> place_observations(
    std::span<const PositionObservation> landmark_observations, const TruthTrack& truth,
    const Eigen::Vector2d& truth_sensor_m = Eigen::Vector2d::Zero());

/// A surveyed landmark that is not where it is seen.
struct MapOddity {
  LandmarkId id;
  double off_m = 0.0;                 ///< from its surveyed place to where it is seen
  std::optional<LandmarkId> seen_at;  ///< the surveyed landmark in whose place it is seen
  double off_there_m = 0.0;           ///< from that place to where it is seen

  friend bool operator==(const MapOddity&, const MapOddity&) = default;
};

/// Landmarks of the survey that disagree with an estimated map far more than the others do, in the order of
/// the map: those further off than 0.25 m and five standard deviations of the rest, and pairs whose exchange
/// explains their errors much better. Landmarks are named by id number; nothing is found with fewer than four
/// in common. O(n^2).
[[nodiscard]] std::vector<MapOddity> find_oddities(std::span<const LandmarkEstimate> map,
                                                   std::span<const TrueLandmark> survey,
                                                   const Pose2& T_survey_map);

/// The same for a map in a frame of its own, which is first laid on the survey by those landmarks that agree.
[[nodiscard]] std::vector<MapOddity> compare_maps(std::span<const LandmarkEstimate> map,
                                                  std::span<const TrueLandmark> survey);

/// One sentence per finding, such as "landmarks 11 and 17 look exchanged: they are seen 6.10 m and 6.08 m
/// from their own places, and 0.04 m and 0.07 m from each other's".
[[nodiscard]] std::vector<std::string> describe(std::span<const MapOddity> oddities);

/// The survey with every pair of exchanged landmarks put right.
[[nodiscard]] std::vector<TrueLandmark> with_exchanges(std::span<const TrueLandmark> survey,
                                                       std::span<const MapOddity> oddities);

}  // namespace waymark::eval
