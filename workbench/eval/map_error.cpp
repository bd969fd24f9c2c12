#include "workbench/eval/map_error.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "workbench/eval/align.hpp"
#include "workbench/eval/nees.hpp"

namespace waymark::eval {
namespace {

using Map = std::span<const LandmarkEstimate>;
using Survey = std::span<const TrueLandmark>;
using Matches = std::span<const LandmarkMatch>;

constexpr std::size_t kMinSelfAligned = 3;

bool has_height(const LandmarkEstimate& landmark) {
  return landmark.position_m.z() != 0.0 || landmark.covariance(2, 2) != 0.0;
}

bool is_name(LandmarkId id) {
  return id.family == LandmarkId::Family::kMarker || id.family == LandmarkId::Family::kBarcode;
}

std::optional<double> rmse_m(Map map, Survey survey, Matches matches,
                             const std::optional<Pose2>& T_truth_estimate) {
  if (!T_truth_estimate || matches.empty()) return std::nullopt;
  double sum = 0.0;
  for (const auto [i, j] : matches)
    sum += landmark_error_m(map[i], survey[j], *T_truth_estimate).squaredNorm();
  return std::sqrt(sum / static_cast<double>(matches.size()));
}

std::optional<Pose2> self_alignment(Map map, Survey survey, Matches matches) {
  if (matches.size() < kMinSelfAligned) return std::nullopt;
  const MatchedPlaces matched = places(map, survey, matches);
  return align_rigid(matched.estimated, matched.surveyed);
}

struct LandmarkNees {
  std::optional<double> value;
  int dof = 0;
};

LandmarkNees landmark_nees(const LandmarkEstimate& estimate, const TrueLandmark& truth, const Pose2& T) {
  const Eigen::Vector3d e = landmark_error_m(estimate, truth, T);
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  R.topLeftCorner<2, 2>() = T.rotation();
  const Eigen::Matrix3d P = R * estimate.covariance * R.transpose();
  if (has_height(estimate)) return {nees<3>(e, P), 3};
  return {nees<2>(e.head<2>(), P.topLeftCorner<2, 2>()), 2};
}

void add_nees(MapError& error, Map map, Survey survey, Matches matches, const Pose2& T_truth_anchored) {
  double sum = 0.0;
  int dof = 0;
  for (const auto [i, j] : matches) {
    const LandmarkNees nees = landmark_nees(map[i], survey[j], T_truth_anchored);
    sum += nees.value.value_or(0.0);
    dof += nees.value ? nees.dof : 0;
    error.nees_skipped += nees.value ? 0 : 1;
  }
  if (dof > 0) error.nees_per_dof = sum / dof;
}

}  // namespace

LandmarkNames resolve_names(LandmarkNames names, Map map, Survey survey) {
  if (names != LandmarkNames::kAuto) return names;
  std::set<LandmarkId> surveyed;
  for (const TrueLandmark& landmark : survey) surveyed.insert(landmark.id);
  const auto shared = [&](const LandmarkEstimate& landmark) {
    return is_name(landmark.id) && surveyed.contains(landmark.id);
  };
  return std::ranges::any_of(map, shared) ? LandmarkNames::kKnown : LandmarkNames::kUnknown;
}

std::vector<LandmarkMatch> match_by_number(Map map, Survey survey) {
  std::map<std::int32_t, std::size_t> unmatched;
  for (std::size_t j = 0; j < survey.size(); ++j) unmatched.try_emplace(survey[j].id.number, j);
  std::vector<LandmarkMatch> matches;
  for (std::size_t i = 0; i < map.size(); ++i) {
    const auto found = unmatched.extract(map[i].id.number);
    if (found) matches.push_back({i, found.mapped()});
  }
  return matches;
}

std::vector<LandmarkMatch> match_nearest(Map map, Survey survey, const Pose2& T_truth_estimate,
                                         double max_distance_m) {
  struct Candidate {
    double distance_m;
    LandmarkMatch match;
  };
  std::vector<Candidate> candidates;
  for (std::size_t i = 0; i < map.size(); ++i) {
    const Eigen::Vector2d p = T_truth_estimate * map[i].position_m.head<2>();
    for (std::size_t j = 0; j < survey.size(); ++j) {
      const double distance_m = std::hypot(p.x() - survey[j].x_m, p.y() - survey[j].y_m);
      if (distance_m <= max_distance_m) candidates.push_back({distance_m, {i, j}});
    }
  }
  std::ranges::stable_sort(candidates, {}, &Candidate::distance_m);
  std::vector<bool> map_taken(map.size());
  std::vector<bool> survey_taken(survey.size());
  std::vector<LandmarkMatch> matches;
  for (const auto& [distance_m, match] : candidates) {
    if (map_taken[match.estimated] || survey_taken[match.surveyed]) continue;
    map_taken[match.estimated] = survey_taken[match.surveyed] = true;
    matches.push_back(match);
  }
  return matches;
}

Eigen::Vector3d landmark_error_m(const LandmarkEstimate& estimate, const TrueLandmark& truth,
                                 const Pose2& T_truth_estimate) {
  const Eigen::Vector2d p = T_truth_estimate * estimate.position_m.head<2>();
  return {p.x() - truth.x_m, p.y() - truth.y_m,
          has_height(estimate) ? estimate.position_m.z() - truth.z_m : 0.0};
}

std::optional<std::vector<LandmarkMatch>> match_landmarks(Map map, Survey survey, const PathFrames& frames,
                                                          LandmarkNames names) {
  if (resolve_names(names, map, survey) == LandmarkNames::kKnown) return match_by_number(map, survey);
  const auto& T = frames.T_truth_aligned ? frames.T_truth_aligned : frames.T_truth_anchored;
  if (!T) return std::nullopt;
  return match_nearest(map, survey, *T);
}

MatchedPlaces places(Map map, Survey survey, Matches matches) {
  MatchedPlaces matched;
  for (const auto [i, j] : matches) {
    matched.estimated.emplace_back(map[i].position_m.head<2>());
    matched.surveyed.emplace_back(survey[j].x_m, survey[j].y_m);
  }
  return matched;
}

std::optional<MapError> map_error(Map map, Survey survey, const PathFrames& frames, LandmarkNames names) {
  if (survey.empty()) return std::nullopt;
  const auto matches = match_landmarks(map, survey, frames, names);
  if (!matches) return std::nullopt;
  MapError error{.matched = matches->size(),
                 .missed = survey.size() - matches->size(),
                 .spurious = map.size() - matches->size(),
                 .rmse_m = rmse_m(map, survey, *matches, frames.T_truth_aligned),
                 .rmse_anchored_m = rmse_m(map, survey, *matches, frames.T_truth_anchored),
                 .rmse_self_m = rmse_m(map, survey, *matches, self_alignment(map, survey, *matches))};
  if (frames.T_truth_anchored) add_nees(error, map, survey, *matches, *frames.T_truth_anchored);
  return error;
}

}  // namespace waymark::eval
