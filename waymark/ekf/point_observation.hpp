#pragma once

#include <optional>

#include <Eigen/Core>

#include "waymark/core/observation.hpp"
#include "waymark/core/pose2.hpp"
#include "waymark/ekf/compressed_state.hpp"
#include "waymark/ekf/sensor_bias_states.hpp"

namespace waymark::ekf {

/// A robot and a point on the ground that it observes: world frame.
struct LinearizationPoint {
  Pose2 T_world_robot;
  Eigen::Vector2d p_world;
};

/// A new point by one observation of range and bearing: where it is in the world, the covariance of what the
/// observation adds to the robot's (m^2), and how biases are in it.
struct LocatedPoint {
  Eigen::Vector2d p_world;
  Eigen::Matrix2d noise;
  BiasTerms errors;
};

/// Whether an observation is one of range, bearing or both, with finite numbers and covariance, and no nearer
/// than kMinDistance_m.
[[nodiscard]] bool is_usable(const Observation& observation);

/// One observation of a point on the ground, linearised: nu = z - h taken at `here` (Vincke 10), Jacobians of
/// h at `at`, which is another point with first estimates only. Nothing where the observed point is at the
/// sensor itself. Landmark, noise and biases are for the caller to set.
[[nodiscard]] std::optional<LinearizedObservation> linearize(const Measurement& z,
                                                             const LinearizationPoint& here,
                                                             const LinearizationPoint& at,
                                                             const Pose2& T_robot_sensor);

/// How a sensor observes the points of a state: range, bearing or both, with its biases. Bound to the
/// state and the errors that it is made with. Every call is O(1), but for a compressed state whose landmark
/// has to be recalled.
class PointObservation {
 public:
  PointObservation(const CompressedState& state, const SensorBiasStates& errors, const Pose2& T_robot_sensor)
      : state_(state), errors_(errors), T_robot_sensor_(T_robot_sensor) {}

  /// Where the sensor is.
  [[nodiscard]] Pose2 T_world_sensor() const {
    return state_.active().pose().T_world_robot * T_robot_sensor_;
  }

  /// Innovation at the present estimate, Jacobians where the consistency mode wants them. `landmark` is its
  /// index in the state, `id` what its biases go by. Nothing where the landmark is believed to be at
  /// the sensor.
  [[nodiscard]] std::optional<LinearizedObservation> linearize(int landmark, LandmarkId id,
                                                               const Observation& observation) const;

  /// The same at what the state proposes (CompressedState::propose()).
  [[nodiscard]] std::optional<LinearizedObservation> linearize_at_proposal(
      const LinearizedObservation& before, const Measurement& z) const;

  /// The inverse model: where a point is of which range and bearing are observed from the present estimate.
  [[nodiscard]] LocatedPoint locate(LandmarkId id, const Observation& observation) const;

  /// What biases do to the part that was measured, its rows first: m and rad.
  [[nodiscard]] ObservationBias error_of(LandmarkId id, double range_m, const Measurement& z) const;

 private:
  const CompressedState& state_;
  const SensorBiasStates& errors_;
  Pose2 T_robot_sensor_;
};

}  // namespace waymark::ekf
