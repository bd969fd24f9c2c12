#include "workbench/sim/wheels.hpp"

#include <cmath>

namespace waymark::sim {

WheelAngles encoder_increment(const WheelOptions& wheels, const ArcStep& command, RandomStream& random) {
  const auto counted_rad = [&](double travel_m) {
    const double error_m = std::sqrt(wheels.var_m2_per_m * std::abs(travel_m)) * random.normal();
    return (travel_m + error_m) / wheels.radius_m;
  };
  const double half_turn_m = 0.5 * wheels.track_m * command.turn_rad;
  const double left_rad = counted_rad(command.distance_m - half_turn_m);
  return {left_rad, counted_rad(command.distance_m + half_turn_m)};
}

Eigen::Vector3d draw_slip(const WheelOptions& wheels, const ArcStep& command, RandomStream& random) {
  const double distance_m = std::abs(command.distance_m);
  const double turn_variance = wheels.slip_turn_var_rad2_per_rad * std::abs(command.turn_rad) +
                               wheels.slip_turn_var_rad2_per_m * distance_m;
  const double forward_m = std::sqrt(wheels.slip_forward_var_m2_per_m * distance_m) * random.normal();
  const double lateral_m = std::sqrt(wheels.slip_lateral_var_m2_per_m * distance_m) * random.normal();
  const double turn_rad = std::sqrt(turn_variance) * random.normal();
  const double chord_rad = 0.5 * command.turn_rad;
  return arc_jacobian(command, ArcModel::kExact) * Eigen::Vector2d(forward_m, turn_rad) +
         lateral_m * Eigen::Vector3d(-std::sin(chord_rad), std::cos(chord_rad), 0.0);
}

WheelGeometry geometry(const WheelOptions& wheels) {
  return {wheels.radius_m, wheels.radius_m, wheels.track_m};
}

OdometryNoise assumed_noise(const WheelOptions& wheels) {
  OdometryNoise noise{.wheel_var_m2_per_m = wheels.var_m2_per_m,
                      .forward_var_m2_per_m = wheels.slip_forward_var_m2_per_m,
                      .lateral_var_m2_per_m = wheels.slip_lateral_var_m2_per_m,
                      .turn_var_rad2_per_rad = wheels.slip_turn_var_rad2_per_rad,
                      .turn_var_rad2_per_m = wheels.slip_turn_var_rad2_per_m};
  if (wheels.odometry == SimulatedOdometry::kWheels) return noise;
  noise.wheel_var_m2_per_m = 0.0;
  noise.forward_var_m2_per_m += wheels.var_m2_per_m / 2.0;
  noise.turn_var_rad2_per_m += 2.0 * wheels.var_m2_per_m / (wheels.track_m * wheels.track_m);
  noise.turn_var_rad2_per_rad += wheels.var_m2_per_m / wheels.track_m;
  return noise;
}

}  // namespace waymark::sim
