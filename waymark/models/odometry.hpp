#pragma once

#include <Eigen/Core>

#include "waymark/core/event.hpp"
#include "waymark/core/motion.hpp"
#include "waymark/core/result.hpp"

namespace waymark {

/// The two wheels of a differential drive. Zero means unknown: the log or the config has to say.
struct WheelGeometry {
  double left_radius_m = 0.0;
  double right_radius_m = 0.0;
  double track_m = 0.0;
};

/// A car steered by its front wheels, whose speed is measured at one rear wheel. Its origin is the middle of
/// the rear axle. A wheel base of zero means unknown.
struct CarGeometry {
  double wheel_base_m = 0.0;      ///< from the rear axle to the front one
  double encoder_offset_m = 0.0;  ///< how far left of the middle the wheel with the encoder is
};

/// Noise of odometry increments. All are variances per metre or radian travelled, so they do not depend
/// on the length of a step, and all vanish when the robot stands still.
struct OdometryNoise {
  double wheel_var_m2_per_m = 1e-4;     ///< each measured wheel's own error, per metre that the wheel rolls
  double forward_var_m2_per_m = 1e-4;   ///< slip along the heading
  double lateral_var_m2_per_m = 1e-5;   ///< sideways slip
  double turn_var_rad2_per_rad = 4e-3;  ///< slip in turning
  double turn_var_rad2_per_m = 1e-4;    ///< turning while driving straight
  double steer_var_rad2_m = 1e-4;       ///< of a steering angle, times the way on which its error lasts
};

/// When the robot counts as standing, so that the turn rate of its odometry is a bias: its speed and turn
/// rate are below these. A speed of 0 disables this.
struct StandingOptions {
  double below_mps = 0.0;
  double below_radps = 0.02;
};

/// Whether an increment has the length of the chord of its arc (exact), or of the arc itself (the 2012
/// article's k = 1).
enum class ArcModel { kExact, kArticle };

struct OdometryOptions {
  WheelGeometry wheels;
  CarGeometry car;
  OdometryNoise noise;
  StandingOptions standing;
  ArcModel arc = ArcModel::kExact;
  double speed_scale = 1.0;      ///< true distance per measured distance
  double turn_scale = 1.0;       ///< true turn per measured turn
  double turn_bias_degps = 0.0;  ///< that is missing in the measured turn while the robot moves
  double outer_point_m = 0.0;    ///< speeds are reported of a point so far out on the outside of a turn
  double response_s =
      0.0;  ///< how much later than its stamp a motion happens: the stamps of commands are early
};

/// The wheels are known and possible.
[[nodiscard]] Result<void> check(const WheelGeometry& wheels);
/// The same of the car.
[[nodiscard]] Result<void> check(const CarGeometry& car);

/// Distance along the path and turn: what a differential drive does in one step.
struct ArcStep {
  double distance_m = 0.0;
  double turn_rad = 0.0;
};

/// The increment of an arc of length ds that turns by dth, starting along +x (Vincke et al. 2012
/// \cite vincke2012, equations 4 and 6): x = ds k cos(dth/2), y = ds k sin(dth/2), k = sin(dth/2)/(dth/2), or
/// 1 in the article's form.
[[nodiscard]] Pose2 arc_increment(const ArcStep& step, ArcModel model);
/// d(x, y, theta)/d(ds, dth) of the above, 3x2.
[[nodiscard]] Eigen::Matrix<double, 3, 2> arc_jacobian(const ArcStep& step, ArcModel model);

/// The distance along the path of an increment, negative backwards.
[[nodiscard]] double arc_length_m(const Pose2& increment, ArcModel model);

/// How far the robot slips from what its odometry measures in one step: in distance and turn the way of the
/// arc itself, so that a turn error moves the end point too; sideways across the chord.
[[nodiscard]] Eigen::Matrix3d slip_covariance(const ArcStep& step, const OdometryNoise& noise,
                                              ArcModel model);

/// The same arc if it turned so much more.
[[nodiscard]] Pose2 turned_more(const Pose2& increment, double turn_rad, ArcModel model);

/// The same way with a turn that is known otherwise, with that variance: the covariance is that of the motion
/// given its turn, and what the turn's own error makes of it.
[[nodiscard]] Motion turned_as_measured(const Motion& motion, double turn_rad, double turn_var_rad2,
                                        ArcModel model);

/// Encoder increments to distance and turn (Vincke et al. 2012 \cite vincke2012, equation 5) and its Jacobian
/// to (left, right) angles.
[[nodiscard]] ArcStep wheel_step(const WheelAngles& increment, const WheelGeometry& wheels);
[[nodiscard]] Eigen::Matrix2d wheel_jacobian(const WheelGeometry& wheels);

/// Motion from encoder increments: independent errors per wheel (Chong and Kleeman 1997
/// \cite chong1997) plus slip.
[[nodiscard]] Motion wheel_motion(const WheelAngles& increment, const OdometryOptions& options);

/// What the middle of a car's rear axle does while the measured wheel rolls so far at a steering angle
/// (Guivant and Nebot 2001 \cite guivant2001, section V): ds = rolled / (1 - tan(steer) H / L), dth = ds
/// tan(steer) / L. With H of a wheel left of the middle, which rolls less in a left turn.
[[nodiscard]] ArcStep car_step(double rolled_m, double steer_rad, const CarGeometry& car);
/// d(ds, dth)/d(rolled, steer) of the above.
[[nodiscard]] Eigen::Matrix2d car_jacobian(double rolled_m, double steer_rad, const CarGeometry& car);

/// Motion from a speed and a steering angle held for `dt_s` >= 0, with the errors of both.
[[nodiscard]] Motion steering_motion(const Steering& steering, double dt_s, const OdometryOptions& options);

/// Motion from a velocity held for `dt_s` >= 0. The noise acts on the distance and turn that result.
[[nodiscard]] Motion velocity_motion(const Velocity& velocity, double dt_s, const OdometryOptions& options);

/// Motion between two poses of the robot's own dead reckoning.
[[nodiscard]] Motion odometry_pose_motion(const Pose2& T_odom_before, const Pose2& T_odom_after,
                                          const OdometryOptions& options);

}  // namespace waymark
