#pragma once

#include <optional>
#include <utility>
#include <variant>

#include "waymark/core/event.hpp"
#include "waymark/models/odometry.hpp"
#include "waymark/slam/turn_bias.hpp"

namespace waymark {

/// What odometry is told in.
enum class OdometryKind { kWheels, kVelocity, kSteering, kPose };

/// Any odometry that this program can turn into motion.
[[nodiscard]] bool is_odometry(const EventContent& content);

/// Follows a quantity that is sampled (cumulative encoder angles, a dead-reckoned pose): its value at any
/// stamp, by interpolation up to the next sample where that is known, else at the last rate for at most
/// `max_hold`.
template <class Value>
class SampledTrack {
 public:
  void add(Stamp stamp, const Value& value);
  [[nodiscard]] std::optional<Value> at(Stamp stamp, const std::pair<Stamp, Value>* next,
                                        Duration max_hold) const;

 private:
  std::optional<std::pair<Stamp, Value>> before_last_;
  std::optional<std::pair<Stamp, Value>> last_;
};

/// Turns whatever kind of odometry a log has into the motion between any two stamps. The first kind that
/// appears counts; a log with two kinds would otherwise move twice. Learns, whenever the robot stands, how
/// its odometry turns by itself, and takes that out.
class Odometer {
 public:
  explicit Odometer(const OdometryOptions& options, double max_hold_s);

  /// The motion from the stamp of the last call to `stamp` >= that one. `next` is the first odometry event
  /// after `stamp`, if it has arrived.
  [[nodiscard]] Motion advance(Stamp stamp, const Event* next);

  /// A reading at the stamp that advance() just reached. False: of another kind than the first one.
  bool add(const Event& event);

  /// Of the odometry so far, if there was any.
  [[nodiscard]] std::optional<OdometryKind> kind() const;

  /// Times that odometry was missing for longer than it may be held: the robot was taken to stand still.
  [[nodiscard]] int gaps() const { return gaps_; }

 private:
  void take_bias_out(Pose2& increment, double dt_s);
  [[nodiscard]] Motion advance_held(Stamp stamp);
  [[nodiscard]] Motion advance_wheels(Stamp stamp, const Event* next);
  [[nodiscard]] Motion advance_pose(Stamp stamp, const Event* next);

  OdometryOptions options_;
  TurnBias turn_bias_;
  Duration max_hold_;
  std::optional<std::size_t> kind_;  // alternative of EventContent
  std::optional<Stamp> now_;
  int gaps_ = 0;

  std::optional<std::variant<Velocity, Steering>> held_;  // until the next one
  Stamp held_since_;
  SampledTrack<WheelAngles> wheel_track_;
  SampledTrack<Pose2> pose_track_;
  std::optional<WheelAngles> wheels_now_;
  std::optional<Pose2> pose_now_;
};

}  // namespace waymark
