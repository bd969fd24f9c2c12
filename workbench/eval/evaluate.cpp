#include "workbench/eval/evaluate.hpp"

#include "waymark/core/angle.hpp"

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
  evaluation.odometry = score_path(dead_reckoning, truth, options.associate);
  const PathFrames frames = path_frames(evaluation);
  evaluation.map = map_error(map, survey, frames, options.names);
  if (const auto matches = match_landmarks(map, survey, frames, options.names))
    evaluation.procrustes = procrustes_score(pairs, places(map, survey, *matches));
  evaluation.notes = notes(evaluation);
  return evaluation;
}

PathScore score_path(const Trajectory& estimate, const TruthTrack& truth, const AssociateOptions& options) {
  const std::vector<PosePair> pairs = associate(estimate, truth, options);
  const auto anchor = anchor_at_start(pairs);
  if (!anchor) return {};
  return score(pairs, errors(pairs, anchor->T_truth_estimate), fit_path(pairs));
}

}  // namespace waymark::eval
