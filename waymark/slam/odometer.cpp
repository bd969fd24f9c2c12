#include "waymark/slam/odometer.hpp"

#include <algorithm>

#include "waymark/core/angle.hpp"

namespace waymark {
namespace {

WheelAngles interpolate(const WheelAngles& a, const WheelAngles& b, double fraction) {
  return {a.left_rad + fraction * (b.left_rad - a.left_rad),
          a.right_rad + fraction * (b.right_rad - a.right_rad)};
}

template <class Value>
Value between(const std::pair<Stamp, Value>& a, const std::pair<Stamp, Value>& b, Stamp stamp) {
  return interpolate(a.second, b.second, to_seconds(stamp - a.first) / to_seconds(b.first - a.first));
}

Motion motion_of(const Velocity& velocity, double dt_s, const OdometryOptions& options) {
  return velocity_motion(velocity, dt_s, options);
}

Motion motion_of(const Steering& steering, double dt_s, const OdometryOptions& options) {
  return steering_motion(steering, dt_s, options);
}

/// The event's own content if it is of this kind.
template <class Content>
const Content* content_of(const Event* event) {
  return event == nullptr ? nullptr : std::get_if<Content>(&event->content);
}

}  // namespace

bool is_odometry(const EventContent& content) {
  return std::holds_alternative<WheelAngles>(content) || std::holds_alternative<Velocity>(content) ||
         std::holds_alternative<Steering>(content) || std::holds_alternative<OdometryPose>(content);
}

bool measures_motion(const EventContent& content) {
  return is_odometry(content) || std::holds_alternative<YawRate>(content);
}

template <class Value>
void SampledTrack<Value>::add(Stamp stamp, const Value& value) {
  if (last_ && last_->first < stamp) before_last_ = last_;
  last_ = {stamp, value};
}

template <class Value>
std::optional<Value> SampledTrack<Value>::at(Stamp stamp, const std::pair<Stamp, Value>* next,
                                             Duration max_hold) const {
  if (!last_) return std::nullopt;
  if (stamp <= last_->first) return last_->second;
  if (next != nullptr && next->first > last_->first) return between(*last_, *next, stamp);
  if (!before_last_) return last_->second;
  return between(*before_last_, *last_, std::min(stamp, last_->first + max_hold));
}

Odometer::Odometer(const OdometryOptions& options, double max_hold_s)
    : options_(options),
      turn_bias_(options.standing),
      max_hold_(duration_from_seconds(max_hold_s)),
      yaw_rate_(max_hold_) {}

Motion Odometer::advance(Stamp stamp, const Event* next, const Event* next_yaw_rate) {
  Motion motion;
  if (held_) motion = advance_held(stamp);
  if (wheels_now_) motion = advance_wheels(stamp, next);
  if (pose_now_) motion = advance_pose(stamp, next);
  if (track_ && gyro_)
    if (const auto turn_rad = yaw_rate_.turn_rad(*now_, stamp, next_yaw_rate))
      motion = turned_as_measured(motion, *turn_rad, options_);
  if (!is_still(motion)) {
    motion.duration_s = to_seconds(stamp - *now_);
    take_bias_out(motion.increment, motion.duration_s);
  }
  now_ = stamp;
  return motion;
}

void Odometer::take_bias_out(Pose2& increment, double dt_s) {
  turn_bias_.observe(increment, dt_s);
  const double missing_radps = to_radians(options_.turn_bias_degps) - turn_bias_.rate_radps();
  if (missing_radps != 0.0) increment = turned_more(increment, missing_radps * dt_s, options_.arc);
}

Motion Odometer::advance_held(Stamp stamp) {
  const Stamp held_until = held_since_ + max_hold_;
  if (stamp > held_until && *now_ <= held_until) ++gaps_;
  const Duration held = std::min(stamp, held_until) - *now_;
  if (held <= Duration{0}) return {};
  return std::visit([&](const auto& speed) { return motion_of(speed, to_seconds(held), options_); }, *held_);
}

Motion Odometer::advance_wheels(Stamp stamp, const Event* next) {
  std::optional<std::pair<Stamp, WheelAngles>> after;
  if (const auto* angles = content_of<WheelAngles>(next)) after = {next->stamp, *angles};
  const WheelAngles then = *wheels_now_;
  wheels_now_ = wheel_track_.at(stamp, after ? &*after : nullptr, max_hold_);
  return wheel_motion({wheels_now_->left_rad - then.left_rad, wheels_now_->right_rad - then.right_rad},
                      options_);
}

Motion Odometer::advance_pose(Stamp stamp, const Event* next) {
  std::optional<std::pair<Stamp, Pose2>> after;
  if (const auto* pose = content_of<OdometryPose>(next)) after = {next->stamp, pose->T_odom_robot};
  const Pose2 then = *pose_now_;
  pose_now_ = pose_track_.at(stamp, after ? &*after : nullptr, max_hold_);
  return odometry_pose_motion(then, *pose_now_, options_);
}

bool Odometer::follows(const Event& event) const {
  return track_of(event) == (std::holds_alternative<YawRate>(event.content) ? gyro_ : track_);
}

bool Odometer::add(const Event& event) {
  const auto* yaw_rate = std::get_if<YawRate>(&event.content);
  auto& followed = yaw_rate != nullptr ? gyro_ : track_;
  if (!followed) followed = track_of(event);
  if (!follows(event)) return false;
  now_ = event.stamp;
  if (yaw_rate != nullptr) yaw_rate_.add(event.stamp, *yaw_rate);
  if (const auto* velocity = std::get_if<Velocity>(&event.content)) {
    held_ = *velocity;
    held_since_ = event.stamp;
  } else if (const auto* steering = std::get_if<Steering>(&event.content)) {
    held_ = *steering;
    held_since_ = event.stamp;
  } else if (const auto* wheels = std::get_if<WheelAngles>(&event.content)) {
    wheel_track_.add(event.stamp, *wheels);
    if (!wheels_now_) wheels_now_ = *wheels;
  } else if (const auto* pose = std::get_if<OdometryPose>(&event.content)) {
    pose_track_.add(event.stamp, pose->T_odom_robot);
    if (!pose_now_) pose_now_ = pose->T_odom_robot;
  }
  return true;
}

std::optional<OdometryKind> Odometer::kind() const {
  if (wheels_now_) return OdometryKind::kWheels;
  if (pose_now_) return OdometryKind::kPose;
  if (!held_) return std::nullopt;
  return std::holds_alternative<Velocity>(*held_) ? OdometryKind::kVelocity : OdometryKind::kSteering;
}

template class SampledTrack<WheelAngles>;
template class SampledTrack<Pose2>;

}  // namespace waymark
