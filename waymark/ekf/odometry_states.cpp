#include "waymark/ekf/odometry_states.hpp"

#include "waymark/core/angle.hpp"

namespace waymark {

OdometryErrors OdometryStateOptions::sigmas() const {
  return {speed_scale_sigma, turn_scale_sigma, to_radians(turn_bias_sigma_degps)};
}

namespace ekf {

void OdometryStates::start(CompressedState& state) const {
  for (int pair = first_pair_; pair < first_pair_ + pairs(); ++pair) state.propagate_bias(pair, 0.0);
}

OdometryErrors OdometryStates::mean(const CompressedState& state) const {
  const Eigen::Vector2d scales = state.active().biases(first_pair_);
  const Eigen::Vector2d rate = state.active().biases(first_pair_ + 1);
  return options_.sigmas().cwiseProduct(OdometryErrors(scales[0], scales[1], rate[0]));
}

void OdometryStates::predict(CompressedState& state, const Motion& motion) const {
  if (!options_.estimate) {
    state.predict(motion);
    return;
  }
  const CorrectedIncrement step = corrected(motion.increment, motion.duration_s, mean(state));
  const Eigen::Matrix3d J = step.J * options_.sigmas().asDiagonal();
  BiasTerms terms;
  terms[0] = {first_pair_, J.leftCols<2>()};
  terms[1].pair = first_pair_ + 1;
  terms[1].J.col(0) = J.col(2);
  state.predict({step.increment, motion.covariance, motion.duration_s}, terms);
}

CalibrationEstimate OdometryStates::calibration(const CompressedState& state) const {
  CalibrationEstimate estimate;
  if (!options_.estimate) return estimate;
  static_assert(kSpeedScale == 0 && kTurnScale == 1 && kTurnBias == 2);
  const OdometryErrors prior_sigmas = options_.sigmas();
  const Eigen::Vector2d scales = state.active().bias_covariance(first_pair_, first_pair_).diagonal();
  const double rate = state.active().bias_covariance(first_pair_ + 1, first_pair_ + 1)(0, 0);
  estimate.mean.head<3>() = mean(state);
  estimate.prior_sigmas.head<3>() = prior_sigmas;
  estimate.sigmas.head<3>() =
      prior_sigmas.cwiseProduct(OdometryErrors(scales[0], scales[1], rate).cwiseSqrt());
  return estimate;
}

}  // namespace ekf
}  // namespace waymark
