#include "workbench/live/pose_of_now.hpp"

#include <algorithm>
#include <cstddef>

namespace waymark::live {
namespace {

/// A minute of odometry at 60 Hz: a filter that is farther behind has stopped.
constexpr std::size_t kMostSegments = 4096;

/// The last `part` in [0, 1] of a motion along its chord; its noise grows with the way.
Motion last_part(const Motion& motion, double part) {
  const Pose2 skipped = interpolate(Pose2{}, motion.increment, 1.0 - part);
  return {skipped.inverse() * motion.increment, part * motion.covariance, part * motion.duration_s};
}

}  // namespace

PoseOfNow::PoseOfNow(const OdometryOptions& odometry, double max_hold_s)
    : odometer_(odometry, max_hold_s), response_(duration_from_seconds(odometry.response_s)) {
  segments_.reserve(kMostSegments);
}

std::optional<StampedPose> PoseOfNow::add(const Event& event) {
  if (!measures_motion(event.content)) return std::nullopt;
  const std::lock_guard lock(mutex_);
  Event shifted = event;
  if (is_odometry(event.content)) shifted.stamp = event.stamp + response_;
  const bool is_first = is_odometry(event.content) ? !odometer_.kind() : !odometer_.has_yaw_rate();
  if (!is_first && !odometer_.follows(shifted)) return std::nullopt;
  if (reached_ && shifted.stamp < *reached_) return std::nullopt;
  const bool is_gyro = !is_odometry(event.content);
  const Motion motion =
      odometer_.advance(shifted.stamp, is_gyro ? nullptr : &shifted, is_gyro ? &shifted : nullptr);
  odometer_.add(shifted);
  if (reached_ && segments_.size() < kMostSegments) segments_.push_back({*reached_, shifted.stamp, motion});
  reached_ = shifted.stamp;
  if (!now_ || shifted.stamp < now_->stamp) return std::nullopt;
  now_ = StampedPose{shifted.stamp, propagate(now_->estimate, motion)};
  return now_;
}

void PoseOfNow::correct(const StampedPose& pose) {
  const std::lock_guard lock(mutex_);
  forget_segments_before(pose.stamp);
  now_ = pose;
  for (const Segment& segment : segments_)
    now_ = StampedPose{segment.to, propagate(now_->estimate, segment.motion)};
}

/// A segment that the moment is within keeps its later part.
void PoseOfNow::forget_segments_before(Stamp stamp) {
  const auto later =
      std::ranges::find_if(segments_, [stamp](const Segment& segment) { return segment.to > stamp; });
  segments_.erase(segments_.begin(), later);
  if (segments_.empty() || segments_.front().from >= stamp) return;
  Segment& first = segments_.front();
  const double part = to_seconds(first.to - stamp) / to_seconds(first.to - first.from);
  first = {stamp, first.to, last_part(first.motion, part)};
}

std::optional<StampedPose> PoseOfNow::now() const {
  const std::lock_guard lock(mutex_);
  return now_;
}

}  // namespace waymark::live
