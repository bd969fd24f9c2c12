#include "waymark/models/odometry.hpp"

#include <cmath>

namespace waymark {
namespace {

/// k(dth) = sin(dth/2)/(dth/2) and its derivative; series near zero where the quotient loses digits.
struct ChordRatio {
  double value;
  double derivative;
};

ChordRatio chord_ratio(double turn_rad, ArcModel model) {
  if (model == ArcModel::kArticle) return {1.0, 0.0};  // Vincke (4)
  if (std::abs(turn_rad) < 1e-4) return {1.0 - turn_rad * turn_rad / 24.0, -turn_rad / 12.0};
  const double k = std::sin(0.5 * turn_rad) / (0.5 * turn_rad);
  return {k, (std::cos(0.5 * turn_rad) - k) / turn_rad};
}

ArcStep scaled(ArcStep step, const OdometryOptions& options) {
  return {options.speed_scale * step.distance_m, options.turn_scale * step.turn_rad};
}

}  // namespace

Result<void> check(const WheelGeometry& wheels) {
  const auto missing = [](const char* key) {
    return Error{std::string(key) + " is unknown: give it in the log's log.yaml or by --set " + key + "=..."};
  };
  if (!(wheels.left_radius_m > 0.0)) return missing("wheels.left_radius_m");
  if (!(wheels.right_radius_m > 0.0)) return missing("wheels.right_radius_m");
  if (!(wheels.track_m > 0.0)) return missing("wheels.track_m");
  return {};
}

Result<void> check(const CarGeometry& car) {
  if (car.wheel_base_m > 0.0) return {};
  return Error{"car.wheel_base_m is unknown: give it in the log's log.yaml or by --set car.wheel_base_m=..."};
}

Pose2 arc_increment(const ArcStep& step, ArcModel model) {
  const double chord_m = step.distance_m * chord_ratio(step.turn_rad, model).value;
  // Vincke (4)
  return {chord_m * std::cos(0.5 * step.turn_rad), chord_m * std::sin(0.5 * step.turn_rad),
          wrap_angle(step.turn_rad)};
}

Eigen::Matrix<double, 3, 2> arc_jacobian(const ArcStep& step, ArcModel model) {
  const double c = std::cos(0.5 * step.turn_rad);
  const double s = std::sin(0.5 * step.turn_rad);
  const double ds = step.distance_m;
  const auto [k, k1] = chord_ratio(step.turn_rad, model);
  return Eigen::Matrix<double, 3, 2>{
      {k * c, ds * (k1 * c - 0.5 * k * s)}, {k * s, ds * (k1 * s + 0.5 * k * c)}, {0.0, 1.0}};
}

Eigen::Matrix3d slip_covariance(const ArcStep& step, const OdometryNoise& noise, ArcModel model) {
  const double distance = std::abs(step.distance_m);
  const double turn = std::abs(step.turn_rad);
  Eigen::Matrix3d S;
  S.leftCols<2>() = arc_jacobian(step, model);
  S.col(2) << -std::sin(0.5 * step.turn_rad), std::cos(0.5 * step.turn_rad), 0.0;
  const Eigen::Vector3d variances(noise.forward_var_m2_per_m * distance,
                                  noise.turn_var_rad2_per_rad * turn + noise.turn_var_rad2_per_m * distance,
                                  noise.lateral_var_m2_per_m * distance);
  return S * variances.asDiagonal() * S.transpose();
}

double arc_length_m(const Pose2& increment, ArcModel model) {
  const double chord_m = std::copysign(increment.position().norm(), increment.x_m);
  return chord_m / chord_ratio(increment.theta_rad, model).value;
}

Pose2 turned_more(const Pose2& increment, double turn_rad, ArcModel model) {
  const double after_rad = increment.theta_rad + turn_rad;
  const double longer = chord_ratio(after_rad, model).value / chord_ratio(increment.theta_rad, model).value;
  const Eigen::Vector2d p = longer * (rotation_matrix(0.5 * turn_rad) * increment.position());
  return {p.x(), p.y(), wrap_angle(after_rad)};
}

Motion turned_as_measured(const Motion& motion, double turn_rad, double turn_var_rad2, ArcModel model) {
  Motion turned = motion;
  turned.increment = turned_more(motion.increment, turn_rad - motion.increment.theta_rad, model);
  const double var = motion.covariance(2, 2);
  if (var <= 0.0) {
    turned.covariance(2, 2) = turn_var_rad2;
    return turned;
  }
  const Eigen::Vector3d with_turn = motion.covariance.col(2) / var;
  turned.covariance += (turn_var_rad2 - var) * with_turn * with_turn.transpose();
  return turned;
}

ArcStep wheel_step(const WheelAngles& increment, const WheelGeometry& wheels) {
  const double left_m = wheels.left_radius_m * increment.left_rad;
  const double right_m = wheels.right_radius_m * increment.right_rad;
  return {0.5 * (right_m + left_m), (right_m - left_m) / wheels.track_m};  // Vincke (5)
}

Eigen::Matrix2d wheel_jacobian(const WheelGeometry& wheels) {
  return Eigen::Matrix2d{{0.5 * wheels.left_radius_m, 0.5 * wheels.right_radius_m},
                         {-wheels.left_radius_m / wheels.track_m, wheels.right_radius_m / wheels.track_m}};
}

Motion wheel_motion(const WheelAngles& increment, const OdometryOptions& options) {
  const WheelGeometry& wheels = options.wheels;
  const ArcStep step = scaled(wheel_step(increment, wheels), options);
  const Eigen::Vector2d scale(options.speed_scale, options.turn_scale);
  const Eigen::Vector2d radius_m(wheels.left_radius_m, wheels.right_radius_m);
  const Eigen::Vector2d travel_m =
      radius_m.cwiseProduct(Eigen::Vector2d(increment.left_rad, increment.right_rad));
  const Eigen::Vector2d angle_var =
      options.noise.wheel_var_m2_per_m * travel_m.cwiseAbs().cwiseQuotient(radius_m.cwiseAbs2());
  const Eigen::Matrix<double, 3, 2> V =
      arc_jacobian(step, options.arc) * scale.asDiagonal() * wheel_jacobian(wheels);
  const Eigen::Matrix3d Q = V * angle_var.asDiagonal() * V.transpose();
  return {arc_increment(step, options.arc), Q + slip_covariance(step, options.noise, options.arc)};
}

ArcStep car_step(double rolled_m, double steer_rad, const CarGeometry& car) {
  const double curvature_per_m = std::tan(steer_rad) / car.wheel_base_m;
  const double distance_m = rolled_m / (1.0 - curvature_per_m * car.encoder_offset_m);
  return {distance_m, distance_m * curvature_per_m};
}

Eigen::Matrix2d car_jacobian(double rolled_m, double steer_rad, const CarGeometry& car) {
  const double t = std::tan(steer_rad);
  const double curvature_per_m = t / car.wheel_base_m;
  const double curvature_per_rad_m = (1.0 + t * t) / car.wheel_base_m;
  const double ratio = 1.0 / (1.0 - curvature_per_m * car.encoder_offset_m);
  const double steered_m = rolled_m * ratio * ratio * curvature_per_rad_m;
  return Eigen::Matrix2d{{ratio, steered_m * car.encoder_offset_m}, {ratio * curvature_per_m, steered_m}};
}

Motion steering_motion(const Steering& steering, double dt_s, const OdometryOptions& options) {
  constexpr double kStands_m = 1e-12;  // no step to spread an error over
  const double rolled_m = steering.v_mps * dt_s;
  if (std::abs(rolled_m) < kStands_m) return {};
  const ArcStep step = scaled(car_step(rolled_m, steering.steer_rad, options.car), options);
  const Eigen::Matrix2d J = Eigen::Vector2d(options.speed_scale, options.turn_scale).asDiagonal() *
                            car_jacobian(rolled_m, steering.steer_rad, options.car);
  // The mean over a step of an error that changes on the way: shorter steps see more of it.
  const Eigen::Vector2d variances(options.noise.wheel_var_m2_per_m * std::abs(rolled_m),
                                  options.noise.steer_var_rad2_m / std::abs(rolled_m));
  const Eigen::Matrix<double, 3, 2> V = arc_jacobian(step, options.arc) * J;
  const Eigen::Matrix3d Q = V * variances.asDiagonal() * V.transpose();
  return {arc_increment(step, options.arc), Q + slip_covariance(step, options.noise, options.arc)};
}

/// What the robot's origin does while a point `outer_m` beside it, on the outside of the turn, does the
/// step's distance; it stands when that point turns around it.
static double inward(const ArcStep& step, double outer_m) {
  return std::copysign(std::max(0.0, std::abs(step.distance_m) - outer_m * std::abs(step.turn_rad)),
                       step.distance_m);
}

Motion velocity_motion(const Velocity& velocity, double dt_s, const OdometryOptions& options) {
  ArcStep step = scaled({velocity.v_mps * dt_s, velocity.w_radps * dt_s}, options);
  step.distance_m = inward(step, options.outer_point_m);
  return {arc_increment(step, options.arc), slip_covariance(step, options.noise, options.arc)};
}

Motion odometry_pose_motion(const Pose2& T_odom_before, const Pose2& T_odom_after,
                            const OdometryOptions& options) {
  const Pose2 moved = T_odom_before.inverse() * T_odom_after;
  // The noise grows with the arc, of which only the chord is known.
  const ArcStep step = scaled({arc_length_m(moved, options.arc), moved.theta_rad}, options);
  const Pose2 increment{options.speed_scale * moved.x_m, options.speed_scale * moved.y_m,
                        wrap_angle(step.turn_rad)};
  return {increment, slip_covariance(step, options.noise, options.arc)};
}

}  // namespace waymark
