#include "waymark/ekf/point_observation.hpp"

#include <cmath>

#include "waymark/core/angle.hpp"
#include "waymark/models/observation_models.hpp"

namespace waymark::ekf {
namespace {

bool is_range(double range_m) { return std::isfinite(range_m) && range_m > kMinDistance_m; }

bool has_finite_numbers(const Measurement& z) {
  if (const auto* both = std::get_if<RangeBearing>(&z))
    return is_range(both->range_m) && std::isfinite(both->bearing_rad);
  if (const auto* range = std::get_if<Range>(&z)) return is_range(range->range_m);
  const auto* bearing = std::get_if<Bearing>(&z);
  return bearing != nullptr && std::isfinite(bearing->bearing_rad);
}

/// The second row of one-dimensional ones is there for nothing.
Eigen::Matrix2d noise_of(const Observation& observation) {
  Eigen::Matrix2d R = *observation.covariance;
  if (!std::holds_alternative<RangeBearing>(observation.value)) R(0, 1) = R(1, 0) = 0.0, R(1, 1) = 1.0;
  return R;
}

/// z - h at one point, Jacobians at another.
template <ObservationModel Model>
LinearizedObservation linearize_as(const typename Model::Value& z, const Linearization<Model::kDim>& expected,
                                   const Linearization<Model::kDim>& jacobians) {
  LinearizedObservation linearization;
  linearization.rows = Model::kDim;
  linearization.nu.head<Model::kDim>() = Model::innovation(z, expected.predicted);  // Vincke (10)
  linearization.H_pose.topRows<Model::kDim>() = jacobians.H_pose;
  linearization.H_landmark.topLeftCorner<Model::kDim, 2>() = jacobians.H_landmark;
  return linearization;
}

}  // namespace

bool is_usable(const Observation& observation) {
  return observation.covariance.has_value() && observation.covariance->allFinite() &&
         has_finite_numbers(observation.value);
}

std::optional<LinearizedObservation> linearize(const Measurement& z, const LinearizationPoint& here,
                                               const LinearizationPoint& at, const Pose2& T_robot_sensor) {
  const auto distance_m = [&](const LinearizationPoint& view) {
    return (view.p_world - view.T_world_robot * T_robot_sensor.position()).norm();
  };
  const bool is_same = here.T_world_robot == at.T_world_robot && here.p_world == at.p_world;
  if (!(distance_m(here) > kMinDistance_m)) return std::nullopt;
  if (!is_same && !(distance_m(at) > kMinDistance_m)) return std::nullopt;
  const auto as = [&]<class Model>(Model, const typename Model::Value& value) {
    const auto expected = Model::linearize(here.T_world_robot, T_robot_sensor, here.p_world);
    if (is_same) return linearize_as<Model>(value, expected, expected);
    return linearize_as<Model>(value, expected,
                               Model::linearize(at.T_world_robot, T_robot_sensor, at.p_world));
  };
  if (const auto* range = std::get_if<Range>(&z)) return as(RangeModel{}, *range);
  if (const auto* bearing = std::get_if<Bearing>(&z)) return as(BearingModel{}, *bearing);
  return as(RangeBearingModel{}, std::get<RangeBearing>(z));
}

std::optional<LinearizedObservation> PointObservation::linearize(int landmark, LandmarkId id,
                                                                 const Observation& observation) const {
  const LinearizationPoint here{state_.active().pose().T_world_robot, state_.landmark(landmark).head<2>()};
  const LinearizationPoint at{state_.active().linearization_pose(),
                              state_.linearization_landmark(landmark).head<2>()};
  auto linearization = ekf::linearize(observation.value, here, at, T_robot_sensor_);
  if (!linearization) return std::nullopt;
  const double range_m = (here.p_world - here.T_world_robot.position()).norm();
  const ObservationBias error = error_of(id, range_m, observation.value);
  linearization->landmark = landmark;
  linearization->errors = error.terms;
  linearization->nu -= state_.active().expected(error.terms);
  linearization->R = noise_of(observation) + error.unmodelled;
  return linearization;
}

std::optional<LinearizedObservation> PointObservation::linearize_at_proposal(
    const LinearizedObservation& before, const Measurement& z) const {
  const Proposal proposal = state_.proposal();
  const LinearizationPoint there{proposal.pose(), proposal.landmark(before.landmark).head<2>()};
  auto linearization = ekf::linearize(z, there, there, T_robot_sensor_);
  if (!linearization) return std::nullopt;
  linearization->landmark = before.landmark;
  linearization->errors = before.errors;
  linearization->nu -= proposal.expected(before.errors);
  linearization->R = before.R;
  return linearization;
}

LocatedPoint PointObservation::locate(LandmarkId id, const Observation& observation) const {
  const auto& z = std::get<RangeBearing>(observation.value);
  ObservationBias error = errors_.of(id, z.range_m);
  const Eigen::Vector2d expected_error = state_.active().expected(error.terms);
  const auto inverse = RangeBearingModel::locate(
      state_.active().pose().T_world_robot, T_robot_sensor_,
      {z.range_m - expected_error[0], wrap_angle(z.bearing_rad - expected_error[1])});
  const Eigen::Matrix2d& G = inverse.G_measurement;
  for (BiasTerm& term : error.terms) term.J.topRows<2>() = (-G * term.J.topRows<2>()).eval();
  return {inverse.p_world, G * (*observation.covariance + error.unmodelled) * G.transpose(), error.terms};
}

ObservationBias PointObservation::error_of(LandmarkId id, double range_m, const Measurement& z) const {
  ObservationBias error = errors_.of(id, range_m);
  if (std::holds_alternative<RangeBearing>(z)) return error;
  const int row = std::holds_alternative<Bearing>(z) ? 1 : 0;
  for (BiasTerm& term : error.terms) {
    term.J.row(0) = term.J.row(row).eval();
    term.J.row(1).setZero();
  }
  error.unmodelled = Eigen::Vector2d(error.unmodelled(row, row), 0.0).asDiagonal().toDenseMatrix().eval();
  return error;
}

}  // namespace waymark::ekf
