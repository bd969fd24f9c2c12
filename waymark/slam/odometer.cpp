#include "waymark/slam/odometer.hpp"

#include <algorithm>
#include <cmath>

#include "waymark/core/angle.hpp"

namespace waymark {
namespace {

// m/s, m/s, rad/s: a robot in a room, as long as its own speeds are not known.
const ReadingStep kSlowRobot(0.5, 0.0, 0.5);

WheelAngles interpolate(const WheelAngles& a, const WheelAngles& b, double fraction) {
  return {a.left_rad + fraction * (b.left_rad - a.left_rad),
          a.right_rad + fraction * (b.right_rad - a.right_rad)};
}

template <class Value>
Value between(const std::pair<Stamp, Value>& a, const std::pair<Stamp, Value>& b, Stamp stamp) {
  return interpolate(a.second, b.second, to_seconds(stamp - a.first) / to_seconds(b.first - a.first));
}

/// Part of a step was not measured: it has these standard deviations in forward, left and turn as a whole.
Motion unsure(Motion motion, const ReadingStep& sigma, double part) {
  motion.covariance.diagonal() += part * sigma.square().matrix();
  return motion;
}

/// Of the robot, where those are of its wheels.
ReadingStep robot_sigma(const ReadingStep& wheels_m, double track_m) {
  const double both_m = std::hypot(wheels_m[0], wheels_m[1]);
  return {0.5 * both_m, 0.0, both_m / track_m};
}

Eigen::Array2d components(const Velocity& velocity) { return {velocity.v_mps, velocity.w_radps}; }
Eigen::Array2d components(const Steering& steering) { return {steering.v_mps, steering.steer_rad}; }

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

template <class Value>
double SampledTrack<Value>::part(Stamp from, Stamp to, Stamp next) const {
  const double whole_s = to_seconds(next - last_->first);
  return whole_s > 0.0 ? std::clamp(to_seconds(to - from) / whole_s, 0.0, 1.0) : 1.0;
}

Odometer::Odometer(const OdometryOptions& options, double max_hold_s)
    : options_(options),
      turn_bias_(options.standing),
      max_hold_(duration_from_seconds(max_hold_s)),
      gaps_(max_hold_),
      gyro_(options.arc, max_hold_),
      wheel_jumps_(options.wheels),
      pose_jumps_(options.wheels) {}

Motion Odometer::advance(Stamp stamp, const Event* next, const Event* next_yaw_rate) {
  Motion motion;
  if (held_) motion = advance_held(stamp);
  if (wheels_now_) motion = advance_wheels(stamp, next);
  if (pose_now_) motion = advance_pose(stamp, next);
  if (track_ && gyro_track_)
    motion = gyro_.hold_heading(motion, {*now_, stamp, stamp <= last_reading_ + max_hold_}, next_yaw_rate);
  if (!is_still(motion)) {
    motion.duration_s = to_seconds(stamp - *now_);
    take_bias_out(motion.increment, motion.duration_s);
  }
  gaps_.see(stamp);
  if (const double part_s = unknown_s(stamp, next); part_s > 0.0) {
    motion = unsure(motion, fastest(), to_seconds(max_hold_) * part_s);
    motion.duration_s = to_seconds(stamp - *now_);
  }
  now_ = stamp;
  return motion;
}

/// How much of the time since the last call has a motion that no reading tells. What lies between two
/// readings of a pose or of wheels as a whole is measured by them, however long it is.
double Odometer::unknown_s(Stamp stamp, const Event* next) const {
  if (!now_) return 0.0;
  const bool bridged = next != nullptr && !held_;
  const Stamp known = *gaps_.known();
  if (bridged && next->stamp - known <= max_hold_) return 0.0;
  if (bridged && track_ && *now_ <= known && stamp >= next->stamp) return 0.0;
  const Stamp since = std::max(*now_, bridged ? known : known + max_hold_);
  return std::max(0.0, to_seconds(stamp - since));
}

/// Per second; of a robot that has not moved so far that of a slow one.
ReadingStep Odometer::fastest() const {
  ReadingStep fastest(speeds_.fastest()[0], 0.0, speeds_.fastest()[1]);
  if (pose_now_) fastest = pose_jumps_.fastest();
  if (wheels_now_) fastest = robot_sigma(wheel_jumps_.fastest(), options_.wheels.track_m);
  return fastest.isZero(0.0) ? kSlowRobot : fastest;
}

void Odometer::take_bias_out(Pose2& increment, double dt_s) {
  turn_bias_.observe(increment, dt_s);
  const double missing_radps = to_radians(options_.turn_bias_degps) - turn_bias_.rate_radps();
  if (missing_radps != 0.0) increment = turned_more(increment, missing_radps * dt_s, options_.arc);
}

Motion Odometer::advance_held(Stamp stamp) {
  const Stamp held_until = held_since_ + max_hold_;
  const Duration held = std::min(stamp, held_until) - *now_;
  if (held <= Duration{0}) return {};
  const double held_s = to_seconds(held);
  Motion motion = std::visit([&](const auto& speed) { return motion_of(speed, held_s, options_); }, *held_);
  if (held_is_measured_) return motion;
  const Eigen::Array2d sigma = held_s * speeds_.fastest();
  return unsure(motion, {sigma[0], 0.0, sigma[1]}, 1.0);
}

Motion Odometer::advance_wheels(Stamp stamp, const Event* next) {
  std::optional<std::pair<Stamp, WheelAngles>> after;
  ReadingStep sigma = ReadingStep::Zero();
  if (const auto* angles = content_of<WheelAngles>(next)) {
    const auto continued = wheel_jumps_.continued(next->stamp, *angles);
    after = {next->stamp, continued.value};
    sigma = continued.sigma;
  }
  const WheelAngles then = *wheels_now_;
  wheels_now_ = wheel_track_.at(stamp, after ? &*after : nullptr, max_hold_);
  Motion motion = wheel_motion(
      {wheels_now_->left_rad - then.left_rad, wheels_now_->right_rad - then.right_rad}, options_);
  if (sigma.isZero(0.0)) return motion;
  return unsure(motion, robot_sigma(sigma, options_.wheels.track_m),
                wheel_track_.part(*now_, stamp, next->stamp));
}

Motion Odometer::advance_pose(Stamp stamp, const Event* next) {
  std::optional<std::pair<Stamp, Pose2>> after;
  ReadingStep sigma = ReadingStep::Zero();
  if (const auto* pose = content_of<OdometryPose>(next)) {
    const auto continued = pose_jumps_.continued(next->stamp, pose->T_odom_robot);
    after = {next->stamp, continued.value};
    sigma = continued.sigma;
  }
  const Pose2 then = *pose_now_;
  pose_now_ = pose_track_.at(stamp, after ? &*after : nullptr, max_hold_);
  Motion motion = odometry_pose_motion(then, *pose_now_, options_);
  if (sigma.isZero(0.0)) return motion;
  return unsure(motion, sigma, pose_track_.part(*now_, stamp, next->stamp));
}

bool Odometer::follows(const Event& event) const {
  return track_of(event) == (std::holds_alternative<YawRate>(event.content) ? gyro_track_ : track_);
}

bool Odometer::add(const Event& event) {
  const auto* yaw_rate = std::get_if<YawRate>(&event.content);
  auto& followed = yaw_rate != nullptr ? gyro_track_ : track_;
  if (!followed) followed = track_of(event);
  if (!follows(event)) return false;
  now_ = event.stamp;
  if (yaw_rate != nullptr) {
    gyro_.add(event.stamp, *yaw_rate);
  } else {
    last_reading_ = event.stamp;
    gaps_.see_reading(event.stamp);
  }
  if (const auto* velocity = std::get_if<Velocity>(&event.content)) {
    hold(event.stamp, *velocity);
  } else if (const auto* steering = std::get_if<Steering>(&event.content)) {
    hold(event.stamp, *steering);
  } else if (const auto* wheels = std::get_if<WheelAngles>(&event.content)) {
    const WheelAngles continued = wheel_jumps_.add(event.stamp, *wheels);
    wheel_track_.add(event.stamp, continued);
    if (!wheels_now_) wheels_now_ = continued;
  } else if (const auto* pose = std::get_if<OdometryPose>(&event.content)) {
    const Pose2 continued = pose_jumps_.add(event.stamp, pose->T_odom_robot);
    pose_track_.add(event.stamp, continued);
    if (!pose_now_) pose_now_ = continued;
  }
  return true;
}

void Odometer::hold(Stamp stamp, const std::variant<Velocity, Steering>& speed) {
  const Eigen::Array2d told = std::visit([](const auto& each) { return components(each); }, speed);
  held_is_measured_ = speeds_.accept(stamp, told);
  held_since_ = stamp;
  if (held_is_measured_) held_ = speed;
}

const OdometryJumps& Odometer::jumps() const {
  if (wheels_now_) return wheel_jumps_.jumps();
  return pose_now_ ? pose_jumps_.jumps() : speeds_.jumps();
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
