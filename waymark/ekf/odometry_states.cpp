#include "waymark/ekf/odometry_states.hpp"

#include "waymark/core/angle.hpp"

namespace waymark {

OdometryErrors OdometryStateOptions::sigmas() const {
  return {speed_scale_sigma, turn_scale_sigma, to_radians(turn_bias_sigma_degps)};
}

void describe(Schema& schema, OdometryStateOptions& o) {
  schema.boolean(
      "ekf.calibrate_odometry", o.estimate,
      "estimate what is always wrong with the odometry: scales of speed and turning, and a turning "
      "rate that is missing; the result is in calibration.yaml");
  schema.real("ekf.speed_scale_sigma", o.speed_scale_sigma, {0.0, 1.0},
              "standard deviation of the true distance per measured distance then; 0: it is 1");
  schema.real("ekf.turn_scale_sigma", o.turn_scale_sigma, {0.0, 1.0},
              "the same of the true turn per measured turn");
  schema.real("ekf.turn_bias_sigma_degps", o.turn_bias_sigma_degps, {0.0, 100.0},
              "the same of what the odometry turns too little while the robot moves, degrees per second");
}

namespace ekf {

void OdometryStates::start(CompressedState& state) const {
  for (int pair = first_pair_; pair < first_pair_ + pairs(); ++pair) state.relax_errors(pair, 0.0);
}

OdometryErrors OdometryStates::mean(const CompressedState& state) const {
  const Eigen::Vector2d scales = state.errors(first_pair_);
  const Eigen::Vector2d rate = state.errors(first_pair_ + 1);
  return options_.sigmas().cwiseProduct(OdometryErrors(scales[0], scales[1], rate[0]));
}

void OdometryStates::predict(CompressedState& state, const Motion& motion) const {
  if (!options_.estimate) {
    state.predict(motion);
    return;
  }
  const CorrectedIncrement step = corrected(motion.increment, motion.duration_s, mean(state));
  const Eigen::Matrix3d J = step.J * options_.sigmas().asDiagonal();
  ErrorTerms terms;
  terms[0] = {first_pair_, J.leftCols<2>()};
  terms[1].pair = first_pair_ + 1;
  terms[1].J.col(0) = J.col(2);
  state.predict({step.increment, motion.covariance, motion.duration_s}, terms);
}

std::optional<Gaussian<3>> OdometryStates::estimate(const CompressedState& state) const {
  if (!options_.estimate) return std::nullopt;
  const OdometryErrors sigmas = options_.sigmas();
  Eigen::Matrix3d P;
  P.topLeftCorner<2, 2>() = state.errors_covariance(first_pair_, first_pair_);
  P.topRightCorner<2, 1>() = state.errors_covariance(first_pair_, first_pair_ + 1).col(0);
  P.bottomLeftCorner<1, 2>() = P.topRightCorner<2, 1>().transpose();
  P(2, 2) = state.errors_covariance(first_pair_ + 1, first_pair_ + 1)(0, 0);
  return Gaussian<3>{mean(state), sigmas.asDiagonal() * P * sigmas.asDiagonal()};
}

}  // namespace ekf
}  // namespace waymark
