#include "waymark/models/observation_models.hpp"

#include <cmath>

namespace waymark {

static_assert(ObservationModel<RangeBearingModel> && ObservationModel<RangeModel> &&
              ObservationModel<BearingModel>);

Eigen::Vector2d position_in_sensor(const RangeBearing& z) {
  return z.range_m * Eigen::Vector2d(std::cos(z.bearing_rad), std::sin(z.bearing_rad));
}

Linearization<2> RangeBearingModel::linearize(const Pose2& T_world_robot, const Pose2& T_robot_sensor,
                                              const Eigen::Vector2d& p_world) {
  const Eigen::Vector2d arm = T_world_robot.rotation() * T_robot_sensor.position();
  const Eigen::Vector2d d = p_world - T_world_robot.position() - arm;
  const double range = d.norm();
  const double heading = T_world_robot.theta_rad + T_robot_sensor.theta_rad;
  Linearization<2> result;
  result.predicted = {range, wrap_angle(std::atan2(d.y(), d.x()) - heading)};
  result.H_landmark.row(0) = d.transpose() / range;
  result.H_landmark.row(1) = perpendicular(d).transpose() / (range * range);
  // The sensor turns about the robot's origin: d(x_sensor)/d(theta) = J arm.
  result.H_pose.leftCols<2>() = -result.H_landmark;
  result.H_pose.col(2) = -result.H_landmark * perpendicular(arm);
  result.H_pose(1, 2) -= 1.0;
  return result;
}

Eigen::Vector2d RangeBearingModel::innovation(const Value& z, const Eigen::Vector2d& predicted) {
  return {z.range_m - predicted.x(), wrap_angle(z.bearing_rad - predicted.y())};
}

RangeBearingModel::Inverse RangeBearingModel::locate(const Pose2& T_world_robot, const Pose2& T_robot_sensor,
                                                     const Value& z) {
  const Pose2 T_world_sensor = T_world_robot * T_robot_sensor;
  const double direction = T_world_sensor.theta_rad + z.bearing_rad;
  const Eigen::Vector2d ray(std::cos(direction), std::sin(direction));
  Inverse result;
  result.p_world = T_world_sensor.position() + z.range_m * ray;
  result.G_pose.leftCols<2>().setIdentity();
  result.G_pose.col(2) = perpendicular(result.p_world - T_world_robot.position());
  result.G_measurement.col(0) = ray;
  result.G_measurement.col(1) = z.range_m * perpendicular(ray);
  return result;
}

Linearization<1> RangeModel::linearize(const Pose2& T_world_robot, const Pose2& T_robot_sensor,
                                       const Eigen::Vector2d& p_world) {
  const auto both = RangeBearingModel::linearize(T_world_robot, T_robot_sensor, p_world);
  return {both.predicted.head<1>(), both.H_pose.topRows<1>(), both.H_landmark.topRows<1>()};
}

Eigen::Matrix<double, 1, 1> RangeModel::innovation(const Value& z,
                                                   const Eigen::Matrix<double, 1, 1>& predicted) {
  return Eigen::Matrix<double, 1, 1>(z.range_m - predicted(0));
}

Linearization<1> BearingModel::linearize(const Pose2& T_world_robot, const Pose2& T_robot_sensor,
                                         const Eigen::Vector2d& p_world) {
  const auto both = RangeBearingModel::linearize(T_world_robot, T_robot_sensor, p_world);
  return {both.predicted.tail<1>(), both.H_pose.bottomRows<1>(), both.H_landmark.bottomRows<1>()};
}

Eigen::Matrix<double, 1, 1> BearingModel::innovation(const Value& z,
                                                     const Eigen::Matrix<double, 1, 1>& predicted) {
  return Eigen::Matrix<double, 1, 1>(wrap_angle(z.bearing_rad - predicted(0)));
}

}  // namespace waymark
