#include "workbench/eval/truth_track.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace waymark::eval {
namespace {

bool is_finite(const TruthSample& sample) {
  return std::isfinite(sample.truth.x_m) && std::isfinite(sample.truth.y_m) &&
         std::isfinite(sample.truth.theta_rad.value_or(0.0));
}

Pose2 pose_or_unturned(const Truth& truth) { return {truth.x_m, truth.y_m, truth.theta_rad.value_or(0.0)}; }

Truth between(const TruthSample& before, const TruthSample& after, Stamp stamp) {
  const double fraction = to_seconds(stamp - before.stamp) / to_seconds(after.stamp - before.stamp);
  const Pose2 pose = interpolate(pose_or_unturned(before.truth), pose_or_unturned(after.truth), fraction);
  const bool headed = before.truth.theta_rad && after.truth.theta_rad;
  return {pose.x_m, pose.y_m, headed ? std::optional(pose.theta_rad) : std::nullopt};
}

}  // namespace

std::optional<Pose2> pose_of(const Truth& truth) {
  if (!truth.theta_rad) return std::nullopt;
  return Pose2{truth.x_m, truth.y_m, wrap_angle(*truth.theta_rad)};
}

TruthTrack::TruthTrack(std::vector<TruthSample> samples) : samples_(std::move(samples)) {
  std::erase_if(samples_, [](const TruthSample& sample) { return !is_finite(sample); });
  std::ranges::stable_sort(samples_, {}, &TruthSample::stamp);
  const auto repeated = std::ranges::unique(samples_, {}, &TruthSample::stamp);
  samples_.erase(repeated.begin(), repeated.end());
}

TruthTrack TruthTrack::from_events(std::span<const Event> events) {
  std::vector<TruthSample> samples;
  for (const Event& event : events) {
    if (const auto* truth = std::get_if<Truth>(&event.content)) samples.push_back({event.stamp, *truth});
  }
  return TruthTrack(std::move(samples));
}

TruthTrack TruthTrack::from_trajectory(const Trajectory& trajectory) {
  std::vector<TruthSample> samples;
  samples.reserve(trajectory.size());
  for (const TrajectoryPoint& point : trajectory) {
    samples.push_back({point.stamp, {point.pose.x_m, point.pose.y_m, point.pose.theta_rad}});
  }
  return TruthTrack(std::move(samples));
}

std::optional<Truth> TruthTrack::at(Stamp stamp, Duration max_gap) const {
  const auto after = std::ranges::upper_bound(samples_, stamp, {}, &TruthSample::stamp);
  if (after == samples_.begin()) return std::nullopt;
  const auto before = std::prev(after);
  if (before->stamp == stamp) return before->truth;
  if (after == samples_.end() || after->stamp - before->stamp > max_gap) return std::nullopt;
  return between(*before, *after, stamp);
}

}  // namespace waymark::eval
