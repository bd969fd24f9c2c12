#pragma once

#include <optional>

#include <Eigen/Core>

#include "waymark/core/event.hpp"
#include "waymark/models/odometry.hpp"
#include "waymark/slam/odometry_jumps.hpp"

namespace waymark {

/// Motion from one reading to the next: of a pose forward, left (m) and turn (rad); of wheels the distance
/// that the left and the right one roll (m), and 0.
using ReadingStep = Eigen::Array3d;

/// Continues the readings of odometry that is cumulative (encoder angles, a dead-reckoned pose) over what no
/// robot can do: a reset, a counter that rolls over, readings far off for a moment, angles that wrap.
///
/// A step is possible if it goes on at the mean speed of the last 0.25 s, each component within the sum of
/// 0.05 m or 0.1 rad; twice the largest of the steps of that time, since stamps jitter; and what the robot
/// may accelerate meanwhile: 10 m/s^2 (the grip of a tyre) and 20 rad/s^2, up to 1 m/s and 2 rad/s or twice
/// the fastest motion so far. Behind a step that is not possible the robot is taken to have gone on at that
/// speed. The next readings decide what it was: if one is where the robot can be by the readings before the
/// jump, those between them are outliers; if the next step is like it, the robot does move so; else it was a
/// reset.
///
/// Readings are returned bit by bit as they are as long as nothing jumps. O(1), allocates nothing.
template <class Value>
class JumpFilter {
 public:
  /// A reading as it goes on from those before.
  struct Continued {
    Value value;
    /// Standard deviation of the step to it, where it was not measured: the fastest motion so far.
    ReadingStep sigma = ReadingStep::Zero();
  };

  /// Poses need no wheels. Wheels without radius never jump.
  explicit JumpFilter(const WheelGeometry& wheels) : radius_m_(wheels.left_radius_m, wheels.right_radius_m) {}

  /// The next reading, at or after the stamp of the last one added.
  [[nodiscard]] Continued continued(Stamp stamp, const Value& raw) const;
  /// Takes it in, and returns what continued() says that it is.
  const Value& add(Stamp stamp, const Value& raw);

  /// Of the steps so far, per second.
  [[nodiscard]] const ReadingStep& fastest() const { return fastest_; }

  [[nodiscard]] const OdometryJumps& jumps() const { return jumps_; }

 private:
  enum class Kind { kPossible, kWrap, kReturn, kFast, kReset };

  /// A reading, and what leads from the raw readings to those that go on from each other; empty: nothing.
  struct Reading {
    Stamp stamp;
    Value raw;
    Value value;
    std::optional<Value> shift;
  };
  struct Step {
    ReadingStep size = ReadingStep::Zero();
    double duration_s = 0.0;
  };
  /// Steps that were possible, in a row.
  struct Window {
    Step sum;
    ReadingStep largest = ReadingStep::Zero();
  };
  struct Judgement {
    Kind kind;
    Reading reading;
    Step step;  ///< as told, from the last reading
  };
  /// A step that was not possible, on trial.
  struct Trial {
    Reading before = {};             ///< the last reading before the first jump
    Stamp first = {};                ///< of the first jump
    Occurrences resets = {};         ///< before it
    int readings = 0;                ///< since then
    Reading before_step = {};        ///< the last reading before the last jump
    Occurrences resets_before = {};  ///< before that
    std::optional<Step> step = {};   ///< the last jump; empty: another reading has followed it
  };

  [[nodiscard]] Judgement judge(Stamp stamp, const Value& raw) const;
  [[nodiscard]] Reading reading(Stamp stamp, const Value& raw, const std::optional<Value>& shift) const;
  [[nodiscard]] Step step(const Reading& from, const Reading& to) const;
  [[nodiscard]] ReadingStep expected(double duration_s) const;
  [[nodiscard]] ReadingStep tolerance(double duration_s) const;
  [[nodiscard]] bool is_possible(const Step& step) const;
  [[nodiscard]] bool goes_on(const Step& step) const;
  [[nodiscard]] std::optional<Value> unwrapping(const Value& raw, double duration_s) const;
  void learn(const Step& step);
  void settle(const Judgement& judged);

  Eigen::Array2d radius_m_;
  std::optional<Reading> last_;
  Window open_;  // the steps since the last one that is complete
  Window closed_;
  ReadingStep fastest_ = ReadingStep::Zero();       // per second
  Eigen::Array2d lowest_ = Eigen::Array2d::Zero();  // raw, of wheels
  Eigen::Array2d highest_ = Eigen::Array2d::Zero();
  std::optional<Trial> trial_;
  OdometryJumps jumps_;
};

/// The same for odometry that tells speeds: forward (m/s), and turning (rad/s) or the steering angle (rad).
/// A reading that differs from the last good one by more than 1 m/s or 3 rad/s and twice the fastest so far
/// is an outlier, as is a first one above 50 m/s or 30 rad/s, unless it is the third in a row that agree
/// within a half: the robot does move so.
class SpeedFilter {
 public:
  /// Whether a reading is to be used; the last good one holds on where it is not.
  [[nodiscard]] bool accept(Stamp stamp, const Eigen::Array2d& speed);

  /// Of readings used so far.
  [[nodiscard]] const Eigen::Array2d& fastest() const { return fastest_; }
  [[nodiscard]] const OdometryJumps& jumps() const { return jumps_; }

 private:
  void trust(const Eigen::Array2d& speed);

  std::optional<Eigen::Array2d> last_;
  Eigen::Array2d fastest_ = Eigen::Array2d::Zero();
  Eigen::Array2d suspect_ = Eigen::Array2d::Zero();
  int suspects_ = 0;
  OdometryJumps before_;  // the first of them
  OdometryJumps jumps_;
};

}  // namespace waymark
