#include "workbench/eval/space_score.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

#include <Eigen/Geometry>

#include "waymark/core/angle.hpp"

#include "workbench/eval/space_path.hpp"

namespace waymark::eval {
namespace {

struct SpacePair {
  SpacePose estimate, truth;
};

std::optional<SpacePose> pose_at(const SpacePath& path, std::size_t before, Stamp stamp, Duration max_gap) {
  const SpacePose& a = path[before];
  if (a.stamp == stamp) return a;
  if (before + 1 == path.size() || path[before + 1].stamp - a.stamp > max_gap) return std::nullopt;
  const SpacePose& b = path[before + 1];
  const double fraction = to_seconds(stamp - a.stamp) / to_seconds(b.stamp - a.stamp);
  return SpacePose{stamp, a.p_m + fraction * (b.p_m - a.p_m), a.q.slerp(fraction, b.q)};
}

/// As associate() on the plane: one pair per stamp of the truth inside the estimate.
std::vector<SpacePair> pair_up(const SpacePath& estimate, const SpacePath& truth, Duration max_gap) {
  std::vector<SpacePair> pairs;
  std::size_t next = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (i > 0 && truth[i].stamp == truth[i - 1].stamp) continue;
    while (next < estimate.size() && estimate[next].stamp <= truth[i].stamp) ++next;
    if (next == 0) continue;
    if (const auto pose = pose_at(estimate, next - 1, truth[i].stamp, max_gap))
      pairs.push_back({*pose, truth[i]});
  }
  return pairs;
}

/// Least squares over all positions.
Eigen::Isometry3d fit_in_space(const std::vector<SpacePair>& pairs) {
  const auto n = static_cast<Eigen::Index>(pairs.size());
  Eigen::Matrix3Xd from(3, n), to(3, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    from.col(i) = pairs[static_cast<std::size_t>(i)].estimate.p_m;
    to.col(i) = pairs[static_cast<std::size_t>(i)].truth.p_m;
  }
  return Eigen::Isometry3d(Eigen::umeyama(from, to, false));
}

/// Turns the estimate by `R` and puts its first position onto that of the truth.
Eigen::Isometry3d onto_first(const SpacePair& first, const Eigen::Matrix3d& R) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = R;
  T.translation() = first.truth.p_m - R * first.estimate.p_m;
  return T;
}

double distance_m(const SpacePair& pair, const Eigen::Isometry3d& T) {
  return (T * pair.estimate.p_m - pair.truth.p_m).norm();
}

template <class Error>
double root_mean_square(const std::vector<SpacePair>& pairs, const Error& error) {
  double sum = 0.0;
  for (const SpacePair& pair : pairs) sum += error(pair) * error(pair);
  return std::sqrt(sum / static_cast<double>(pairs.size()));
}

double rmse_of_positions_m(const std::vector<SpacePair>& pairs, const Eigen::Isometry3d& T) {
  return root_mean_square(pairs, [&](const SpacePair& pair) { return distance_m(pair, T); });
}

double rmse_of_rotations_deg(const std::vector<SpacePair>& pairs, const Eigen::Isometry3d& T) {
  const Eigen::Quaterniond R(T.linear());
  return to_degrees(root_mean_square(
      pairs, [&](const SpacePair& pair) { return pair.truth.q.angularDistance(R * pair.estimate.q); }));
}

std::string text_of(const char* format, double a, double b) {
  std::array<char, 200> text{};
  std::snprintf(text.data(), text.size(), format, a, b);
  return text.data();
}

std::string why_in_space(const SpacePath& estimate, const SpacePath& truth) {
  const OutOfPlane of_estimate = out_of_plane(estimate), of_truth = out_of_plane(truth);
  const bool is_estimate = !is_planar(of_estimate);
  const OutOfPlane& out = is_estimate ? of_estimate : of_truth;
  return std::string("scored in space (3-D), headings as the angle between the orientations: ") +
         (is_estimate ? "the result" : "the ground truth") +
         text_of(" is not planar, its z spreads over %.3g m and it tilts by up to %.3g deg", out.height_m,
                 to_degrees(out.tilt_rad)) +
         "; to score it in a plane, give --plane xy, xz, yz or fit";
}

std::vector<std::string> space_notes(const Evaluation& e, std::string why, bool has_start) {
  std::vector<std::string> notes{std::move(why)};
  if (e.pairs > 0 && !has_start)
    notes.emplace_back(
        "all rows of one of the paths have the same orientation, which was taken as not measured: the start "
        "was aligned by the turn of the whole path");
  if (e.pairs < e.truth_samples)
    notes.push_back(std::to_string(e.pairs) + " of " + std::to_string(e.truth_samples) +
                    " ground-truth samples lie within the time of the run and are used");
  return notes;
}

}  // namespace

Evaluation evaluate_in_space(const SpacePath& estimate, const SpacePath& truth,
                             const AssociateOptions& options) {
  constexpr std::size_t kMinFitted = 3;
  Evaluation e{.truth_samples = truth.size()};
  const std::vector<SpacePair> pairs = pair_up(estimate, truth, options.max_gap);
  const bool has_start = has_orientation(estimate) && has_orientation(truth);
  e.pairs = pairs.size();
  e.notes = space_notes(e, why_in_space(estimate, truth), has_start);
  if (pairs.empty()) return e;
  const SpacePair& first = pairs.front();
  const Eigen::Isometry3d aligned =
      pairs.size() < kMinFitted ? Eigen::Isometry3d::Identity() : fit_in_space(pairs);
  const Eigen::Matrix3d turn =
      has_start ? (first.truth.q * first.estimate.q.conjugate()).toRotationMatrix() : aligned.linear();
  const Eigen::Isometry3d anchored = onto_first(first, turn);
  e.path.position_rmse_m = rmse_of_positions_m(pairs, anchored);
  if (pairs.size() >= kMinFitted) e.path.position_rmse_aligned_m = rmse_of_positions_m(pairs, aligned);
  if (has_start) e.path.heading_rmse_deg = rmse_of_rotations_deg(pairs, anchored);
  e.path.final_error_m = distance_m(pairs.back(), anchored);
  e.path_m = out_of_plane(truth).length_m;
  e.scored_s = to_seconds(pairs.back().truth.stamp - first.truth.stamp);
  return e;
}

}  // namespace waymark::eval
