#include "workbench/eval/evaluate.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <iterator>
#include <utility>

#include "waymark/core/angle.hpp"

#include "workbench/eval/map_placement.hpp"

namespace waymark::eval {
namespace {

PathScore score(std::span<const PosePair> pairs, std::span<const ErrorSample> anchored,
                const std::optional<PathFit>& fit) {
  PathScore score;
  score.position_rmse_m = position_rmse_m(anchored);
  if (fit) score.position_rmse_aligned_m = position_rmse_m(pairs, fit->T_truth_estimate);
  const auto heading_rad = heading_rmse_rad(anchored);
  if (heading_rad) score.heading_rmse_deg = to_degrees(*heading_rad);
  if (!anchored.empty()) score.final_error_m = anchored.back().position_m.norm();
  return score;
}

std::vector<RelativeError> relative_errors(std::span<const PosePair> pairs,
                                           std::span<const double> travelled) {
  std::vector<RelativeError> all;
  for (const double distance_m : kRelativeDistancesM) {
    const RelativeError error = relative_error(pairs, travelled, distance_m);
    if (error.count > 0) all.push_back(error);
  }
  return all;
}

std::optional<std::string> anchor_note(AnchorHeading heading) {
  switch (heading) {
    case AnchorHeading::kTruth:
      return std::nullopt;
    case AnchorHeading::kPath:
      return "ground truth has no heading at the start: the start was aligned by the direction of the first "
             "metre of path";
    case AnchorHeading::kNone:
      return "ground truth has no heading and less than a metre of path: both frames were assumed to be "
             "parallel";
  }
  return std::nullopt;
}

std::vector<std::string> notes(const Evaluation& evaluation) {
  std::vector<std::string> notes;
  if (evaluation.anchor) {
    if (auto note = anchor_note(evaluation.anchor->heading)) notes.push_back(std::move(*note));
  }
  if (evaluation.truth_samples > 0 && evaluation.pairs == 0) {
    notes.emplace_back("no ground-truth sample lies within the time of the run: no position errors");
  } else if (evaluation.pairs < evaluation.truth_samples) {
    notes.push_back(std::to_string(evaluation.pairs) + " of " + std::to_string(evaluation.truth_samples) +
                    " ground-truth samples lie within the time of the run and are used");
  }
  return notes;
}

void add_path(Evaluation& evaluation, std::span<const PosePair> pairs) {
  evaluation.pairs = pairs.size();
  evaluation.anchor = anchor_at_start(pairs);
  if (!evaluation.anchor) return;
  evaluation.fit = fit_path(pairs);
  evaluation.series = errors(pairs, evaluation.anchor->T_truth_estimate);
  evaluation.path = score(pairs, evaluation.series, evaluation.fit);
  evaluation.nees = summarise_nees(evaluation.series);
  const std::vector<double> travelled = travelled_m(pairs);
  evaluation.path_m = travelled.back();
  evaluation.relative = relative_errors(pairs, travelled);
  evaluation.scored_s = to_seconds(pairs.back().stamp - pairs.front().stamp);
}

std::string start_note(const FitAngle& angle) {
  constexpr double kMost_rad = 0.5 * kPi;
  std::array<char, 200> text{};
  std::snprintf(text.data(), text.size(),
                "landmarks are placed by the start pose: the path spreads over %.3g m, which tells its angle "
                "to +- %.2g deg",
                angle.spread_m, to_degrees(std::min(angle.sigma_rad, kMost_rad)));
  return text.data();
}

/// Where the path is too short to tell the angle of the map, its start does.
void place_map(Evaluation& evaluation, std::span<const PosePair> pairs,
               std::span<const LandmarkEstimate> map) {
  if (!evaluation.anchor || !evaluation.fit) return;
  const FitAngle angle = fit_angle(pairs, *evaluation.fit);
  if (!start_places_map(pairs, map, *evaluation.anchor, angle)) return;
  evaluation.notes.push_back(start_note(angle));
  evaluation.fit->T_truth_estimate = evaluation.anchor->T_truth_estimate;
}

PathFrames path_frames(const Evaluation& evaluation) {
  PathFrames frames;
  if (evaluation.anchor) frames.T_truth_anchored = evaluation.anchor->T_truth_estimate;
  if (evaluation.fit) frames.T_truth_aligned = evaluation.fit->T_truth_estimate;
  return frames;
}

}  // namespace

Evaluation evaluate(const Trajectory& estimate, std::span<const LandmarkEstimate> map,
                    const TruthTrack& truth, std::span<const TrueLandmark> survey,
                    const Trajectory& dead_reckoning, const EvaluateOptions& options) {
  Evaluation evaluation{.truth_samples = truth.samples().size()};
  const std::vector<PosePair> pairs = associate(estimate, truth, options.associate);
  add_path(evaluation, pairs);
  if (!survey.empty()) place_map(evaluation, pairs, map);
  evaluation.odometry = score_path(dead_reckoning, truth, options.associate);
  const PathFrames frames = path_frames(evaluation);
  evaluation.map = map_error(map, survey, frames, options.names);
  if (const auto matches = match_landmarks(map, survey, frames, options.names))
    evaluation.procrustes = procrustes_score(pairs, places(map, survey, *matches));
  std::ranges::move(notes(evaluation), std::back_inserter(evaluation.notes));
  return evaluation;
}

PathScore score_path(const Trajectory& estimate, const TruthTrack& truth, const AssociateOptions& options) {
  const std::vector<PosePair> pairs = associate(estimate, truth, options);
  const auto anchor = anchor_at_start(pairs);
  if (!anchor) return {};
  return score(pairs, errors(pairs, anchor->T_truth_estimate), fit_path(pairs));
}

}  // namespace waymark::eval
