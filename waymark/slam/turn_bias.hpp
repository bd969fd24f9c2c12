#pragma once

#include "waymark/core/pose2.hpp"
#include "waymark/models/odometry.hpp"

namespace waymark {

/// The rate at which odometry turns by itself, as a gyro does, learnt whenever the robot stands: what the
/// odometry turns then is all of its own (a zero angular rate update). Nothing is known of it before, and it
/// is taken to stay what it was on the mean of all the time that the robot stood.
class TurnBias {
 public:
  explicit TurnBias(const StandingOptions& standing) : standing_(standing) {}

  /// Learns from a step that took so long, if the robot stood. One that is exactly zero says nothing: it may
  /// as well be a gap in the odometry.
  void observe(const Pose2& increment, double dt_s);

  /// rad/s; 0 as long as the robot has not stood.
  [[nodiscard]] double rate_radps() const { return stood_s_ > 0.0 ? turned_rad_ / stood_s_ : 0.0; }

 private:
  [[nodiscard]] bool stands(const Pose2& increment, double dt_s) const;

  StandingOptions standing_;
  double turned_rad_ = 0.0;
  double stood_s_ = 0.0;
};

}  // namespace waymark
