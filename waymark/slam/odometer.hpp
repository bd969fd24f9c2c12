#pragma once

#include <optional>
#include <utility>
#include <variant>

#include "waymark/core/event.hpp"
#include "waymark/models/odometry.hpp"
#include "waymark/slam/gyro.hpp"
#include "waymark/slam/jump_filter.hpp"
#include "waymark/slam/odometry_gaps.hpp"
#include "waymark/slam/turn_bias.hpp"

namespace waymark {

/// Kind of odometry in a log.
enum class OdometryKind { kWheels, kVelocity, kSteering, kPose };

/// Any odometry that this program can turn into motion.
[[nodiscard]] bool is_odometry(const EventContent& content);
/// Odometry, or what a gyro adds to it.
[[nodiscard]] bool measures_motion(const EventContent& content);

/// Follows a quantity that is sampled (cumulative encoder angles, a dead-reckoned pose): its value at any
/// stamp, by interpolation up to the next sample where that is known, else at the last rate for at most
/// `max_hold`.
template <class Value>
class SampledTrack {
 public:
  void add(Stamp stamp, const Value& value);
  [[nodiscard]] std::optional<Value> at(Stamp stamp, const std::pair<Stamp, Value>* next,
                                        Duration max_hold) const;
  /// The part that [from, to] is of the time from the last sample to `next`, in [0, 1].
  [[nodiscard]] double part(Stamp from, Stamp to, Stamp next) const;

 private:
  std::optional<std::pair<Stamp, Value>> before_last_;
  std::optional<std::pair<Stamp, Value>> last_;
};

/// Turns whatever kind of odometry a log has into the motion between any two stamps. The first stream of
/// odometry that appears counts; a log with two would otherwise move twice. Readings that no robot can follow
/// (JumpFilter, SpeedFilter) make no motion: it goes on as before them, with noise that covers what was not
/// measured. Where a gyro tells the yaw rate, it holds the heading (Gyro). Where readings are missing for
/// longer than they may be held the motion is not known: poses and wheels go evenly to the next reading, if
/// that has come, and a speed counts no longer; the noise is that of a robot that takes another speed, up to
/// the fastest so far, every `max_hold_s`. Learns, whenever the robot stands, how its heading turns by
/// itself, and takes that out.
class Odometer {
 public:
  explicit Odometer(const OdometryOptions& options, double max_hold_s);

  /// The motion from the stamp of the last call to `stamp` >= that one. `next` is the first odometry event
  /// that it follows, or may follow if there was none so far, at or after `stamp`, `next_yaw_rate` the first
  /// yaw rate, if they have arrived.
  [[nodiscard]] Motion advance(Stamp stamp, const Event* next, const Event* next_yaw_rate = nullptr);

  /// A reading at the stamp that advance() just reached. False: of another stream than it follows.
  bool add(const Event& event);

  /// Whether an event is of the odometry, or the yaw rate, that it follows. Nothing is followed before the
  /// first.
  [[nodiscard]] bool follows(const Event& event) const;

  /// Its readings are speeds, which hold until the next one.
  [[nodiscard]] bool holds_speeds() const { return held_.has_value(); }

  [[nodiscard]] bool has_yaw_rate() const { return gyro_track_.has_value(); }

  /// What the gyro is like.
  [[nodiscard]] GyroFindings gyro() const { return gyro_.findings(); }

  /// Of the odometry so far, if there was any.
  [[nodiscard]] std::optional<OdometryKind> kind() const;

  /// Where odometry was missing for longer than it may be held.
  [[nodiscard]] const OdometryGaps& gaps() const { return gaps_; }

  /// What no robot can do, in the odometry so far.
  [[nodiscard]] const OdometryJumps& jumps() const;

 private:
  /// Which odometry it is: the alternative of EventContent, and who tells it.
  struct Track {
    std::size_t kind;
    StreamId stream;

    friend bool operator==(const Track&, const Track&) = default;
  };

  static Track track_of(const Event& event) { return {event.content.index(), event.stream}; }
  void take_bias_out(Pose2& increment, double dt_s);
  [[nodiscard]] double unknown_s(Stamp stamp, const Event* next) const;
  [[nodiscard]] ReadingStep fastest() const;
  [[nodiscard]] Motion advance_held(Stamp stamp);
  [[nodiscard]] Motion advance_wheels(Stamp stamp, const Event* next);
  [[nodiscard]] Motion advance_pose(Stamp stamp, const Event* next);
  void hold(Stamp stamp, const std::variant<Velocity, Steering>& speed);

  OdometryOptions options_;
  TurnBias turn_bias_;
  Duration max_hold_;
  std::optional<Track> track_;
  std::optional<Track> gyro_track_;
  std::optional<Stamp> now_;
  Stamp last_reading_;  // of the odometry
  OdometryGaps gaps_;

  std::optional<std::variant<Velocity, Steering>> held_;  // until the next one
  Stamp held_since_;
  bool held_is_measured_ = true;  // false: it is of before a reading that no robot can follow
  SpeedFilter speeds_;
  Gyro gyro_;
  JumpFilter<WheelAngles> wheel_jumps_;
  JumpFilter<Pose2> pose_jumps_;
  SampledTrack<WheelAngles> wheel_track_;
  SampledTrack<Pose2> pose_track_;
  std::optional<WheelAngles> wheels_now_;
  std::optional<Pose2> pose_now_;
};

}  // namespace waymark
