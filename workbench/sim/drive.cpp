#include "workbench/sim/drive.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "waymark/core/random.hpp"

#include "workbench/sim/faults.hpp"
#include "workbench/sim/wheels.hpp"

namespace waymark::sim {
namespace {

// Distances over which an error is steered away; four to one is critical damping.
constexpr double kSettle_m = 0.25;
constexpr double kLookahead_m = 1.0;

int steps_of(const PathSegment& segment, const SimOptions& options) {
  const double turn_rate_max = to_radians(options.path.turn_rate_max_degps);
  const double duration_s = std::max(segment.arc.distance_m / options.path.speed_mps,
                                     std::abs(segment.arc.turn_rad) / turn_rate_max);
  return static_cast<int>(std::ceil(duration_s * options.wheels.rate_hz - 1e-9));
}

// A robot that turns on the spot leaves its errors for the next straight line. It catches up at twice its
// speed at most, waits rather than drives backwards, and corrects its heading no faster than it may turn:
// small errors never meet these limits, only a robot that was carried away does.
ArcStep steer(const ArcStep& planned, const Pose2& T_world_planned, const Pose2& T_world_robot,
              double max_turn_rad) {
  const Pose2 error = T_world_robot.inverse() * T_world_planned;
  const double lookahead_m = std::max(kLookahead_m, 2.0 * planned.distance_m);
  const double gain = 1.0 - std::exp(-planned.distance_m / kSettle_m);
  const double heading_rad = wrap_angle(error.theta_rad + std::atan(error.y_m / lookahead_m));
  return {planned.distance_m + std::clamp(gain * error.x_m, -planned.distance_m, planned.distance_m),
          planned.turn_rad + std::clamp(gain * heading_rad, -max_turn_rad, max_turn_rad)};
}

// Somewhere else: as far and as much turned as the options say, in a direction and a sense that are drawn.
Pose2 carried(const Pose2& T_world_robot, const FaultOptions& options, std::uint64_t seed) {
  RandomStream random(seed, StreamPurpose::kSimulation, 0, kCarriedRobot);
  const double direction_rad = random.uniform(-std::numbers::pi, std::numbers::pi);
  const double turn_rad = to_radians(options.robot_carried_deg) * (random.uniform() < 0.5 ? -1.0 : 1.0);
  return {T_world_robot.x_m + options.robot_carried_m * std::cos(direction_rad),
          T_world_robot.y_m + options.robot_carried_m * std::sin(direction_rad),
          wrap_angle(T_world_robot.theta_rad + turn_rad)};
}

/// The part of a turn that the wheels make without the robot.
double turn_slip(const FaultOptions& options, std::uint64_t turn, std::uint64_t seed) {
  if (options.turn_slip_ratio <= 0.0) return 0.0;
  return RandomStream(seed, StreamPurpose::kSimulation, turn, kTurnSlip)
      .uniform(0.0, options.turn_slip_ratio);
}

class Driver {
 public:
  Driver(const SimOptions& options, const Pose2& T_world_start, std::uint64_t seed)
      : options_(options),
        seed_(seed),
        max_turn_rad_(to_radians(options.path.turn_rate_max_degps) / options.wheels.rate_hz),
        carried_at_step_(options.faults.robot_carried_at_s * options.wheels.rate_hz),
        T_world_robot_(T_world_start) {
    drive_.rate_hz = options.wheels.rate_hz;
  }

  void stand(double duration_s) {
    const double count = duration_s * options_.wheels.rate_hz;
    while (static_cast<double>(drive_.steps.size()) < count) step({});
  }

  void follow(const PathSegment& segment) {
    const int count = steps_of(segment, options_);
    slip_ratio_ = segment.arc.turn_rad != 0.0 ? turn_slip(options_.faults, turns_++, seed_) : 0.0;
    for (int i = 0; i < count; ++i) {
      const ArcStep planned{segment.arc.distance_m / count, segment.arc.turn_rad / count};
      carry_if_due();
      step(steer(planned, segment.at(static_cast<double>(i) / count), T_world_robot_, max_turn_rad_));
    }
    if (segment.arc.distance_m > 0.0) drive_.corners.push_back(drive_.steps.size());
  }

  [[nodiscard]] Drive finish() && { return std::move(drive_); }

 private:
  void carry_if_due() {
    const auto step = static_cast<double>(drive_.steps.size());
    if (carried_at_step_ > 0.0 && step >= carried_at_step_ && step < carried_at_step_ + 1.0)
      T_world_robot_ = carried(T_world_robot_, options_.faults, seed_);
  }

  void step(const ArcStep& command) {
    RandomStream random(seed_, StreamPurpose::kSimulation, drive_.steps.size(), 0);
    DriveStep next{T_world_robot_, command, draw_slip(options_.wheels, command, random), {}};
    next.slip.z() -= slip_ratio_ * command.turn_rad;
    next.counted = encoder_increment(options_.wheels, command, random);
    T_world_robot_ = next.at(1.0);
    drive_.steps.push_back(next);
  }

  const SimOptions& options_;
  std::uint64_t seed_;
  double max_turn_rad_;  // in a step
  double carried_at_step_;
  double slip_ratio_ = 0.0;  // of the turn that goes on
  std::uint64_t turns_ = 0;
  Pose2 T_world_robot_;
  Drive drive_;
};

}  // namespace

Pose2 DriveStep::at(double fraction) const {
  const ArcStep part{fraction * command.distance_m, fraction * command.turn_rad};
  const Pose2 rolled = arc_increment(part, ArcModel::kExact);
  return T_world_robot * Pose2{rolled.x_m + fraction * slip.x(), rolled.y_m + fraction * slip.y(),
                               rolled.theta_rad + fraction * slip.z()};
}

Stamp Drive::stamp(std::size_t step) const { return stamp_from_seconds(static_cast<double>(step) / rate_hz); }

Pose2 Drive::at(Stamp when) const {
  const auto nearest = static_cast<std::size_t>(std::max(0.0, std::round(to_seconds(when) * rate_hz)));
  const std::size_t before = nearest > 0 && stamp(nearest) > when ? nearest - 1 : nearest;
  const std::size_t step = std::min(before, steps.size() - 1);
  return steps[step].at(to_seconds(when - stamp(step)) / to_seconds(stamp(step + 1) - stamp(step)));
}

double lap_duration_s(const Path& path, const SimOptions& options) {
  double steps = 0.0;
  for (const PathSegment& segment : path) steps += steps_of(segment, options);
  return steps / options.wheels.rate_hz;
}

Drive drive(const Path& path, const SimOptions& options, std::uint64_t seed) {
  Driver driver(options, path.front().T_world_start, seed);
  driver.stand(options.path.stand_s);
  for (int lap = 0; lap < options.path.laps; ++lap) {
    for (const PathSegment& segment : path) driver.follow(segment);
  }
  return std::move(driver).finish();
}

}  // namespace waymark::sim
