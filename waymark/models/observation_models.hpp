#pragma once

#include <concepts>

#include <Eigen/Core>

#include "waymark/core/observation.hpp"
#include "waymark/core/pose2.hpp"

namespace waymark {

/// A measurement function linearised at a pose and a landmark.
template <int Dim>
struct Linearization {
  Eigen::Matrix<double, Dim, 1> predicted;   ///< h(T_world_robot, p_world)
  Eigen::Matrix<double, Dim, 3> H_pose;      ///< dh/d(x, y, theta) of the robot
  Eigen::Matrix<double, Dim, 2> H_landmark;  ///< dh/d(x, y) of the landmark
};

/// What a filter asks of a model of 2-D landmarks: the innovation wraps its angles, h() is defined away from
/// the sensor's own position (callers keep `kMinDistance_m`).
template <class M>
concept ObservationModel = requires(const typename M::Value& z, const Pose2& T, const Eigen::Vector2d& p) {
  { M::kDim } -> std::convertible_to<int>;
  { M::linearize(T, T, p) } -> std::same_as<Linearization<M::kDim>>;
  {
    M::innovation(z, Eigen::Matrix<double, M::kDim, 1>())
    } -> std::same_as<Eigen::Matrix<double, M::kDim, 1>>;
};

/// Nearer to the sensor than this the direction of a landmark means nothing.
inline constexpr double kMinDistance_m = 1e-3;

/// Where a landmark was observed, in the frame of the sensor.
[[nodiscard]] Eigen::Vector2d position_in_sensor(const RangeBearing& z);

/// Range and bearing from a sensor at T_robot_sensor on the robot:
/// d = p - x_sensor, z = (|d|, atan2(d_y, d_x) - theta_sensor). Jacobians 2x3 and 2x2.
struct RangeBearingModel {
  using Value = RangeBearing;
  static constexpr int kDim = 2;
  [[nodiscard]] static Linearization<2> linearize(const Pose2& T_world_robot, const Pose2& T_robot_sensor,
                                                  const Eigen::Vector2d& p_world);
  [[nodiscard]] static Eigen::Vector2d innovation(const Value& z, const Eigen::Vector2d& predicted);

  /// The landmark that was seen, with its Jacobians to the pose (2x3) and to the measurement (2x2).
  struct Inverse {
    Eigen::Vector2d p_world;
    Eigen::Matrix<double, 2, 3> G_pose;
    Eigen::Matrix2d G_measurement;
  };
  [[nodiscard]] static Inverse locate(const Pose2& T_world_robot, const Pose2& T_robot_sensor,
                                      const Value& z);
};

/// The first row of range-bearing.
struct RangeModel {
  using Value = Range;
  static constexpr int kDim = 1;
  [[nodiscard]] static Linearization<1> linearize(const Pose2& T_world_robot, const Pose2& T_robot_sensor,
                                                  const Eigen::Vector2d& p_world);
  [[nodiscard]] static Eigen::Matrix<double, 1, 1> innovation(const Value& z,
                                                              const Eigen::Matrix<double, 1, 1>& predicted);
};

/// The second row of range-bearing.
struct BearingModel {
  using Value = Bearing;
  static constexpr int kDim = 1;
  [[nodiscard]] static Linearization<1> linearize(const Pose2& T_world_robot, const Pose2& T_robot_sensor,
                                                  const Eigen::Vector2d& p_world);
  [[nodiscard]] static Eigen::Matrix<double, 1, 1> innovation(const Value& z,
                                                              const Eigen::Matrix<double, 1, 1>& predicted);
};

}  // namespace waymark
