#include "waymark/ekf/sensor_bias_states.hpp"

#include <algorithm>
#include <cmath>

#include "waymark/core/angle.hpp"

namespace waymark::ekf {
namespace {

/// Landmarks whose biases are remembered at once. One more costs two rows of the state.
constexpr std::size_t kBiasSlots = 16;

Eigen::Vector2d deviations(double range_ratio, double bearing_deg, double range_m) {
  return {range_ratio * range_m, to_radians(bearing_deg)};
}

}  // namespace

SensorBiasStates::SensorBiasStates(const SensorErrors& sensor)
    : sensor_(sensor),
      offset_pair_(sensor.shares() ? 1 : 0),
      first_slot_(offset_pair_ + (offsets() ? 1 : 0)),
      slots_(sensor.lasts() ? kBiasSlots : 0) {}

void SensorBiasStates::start(CompressedState& state) const {
  for (int pair = 0; pair < pairs(); ++pair) state.propagate_bias(pair, 0.0);
}

int SensorBiasStates::find(LandmarkId landmark) const {
  const auto found = std::ranges::find_if(
      slots_, [landmark](const BiasSlot& slot) { return slot.scan > 0 && slot.landmark == landmark; });
  return found == slots_.end() ? -1 : static_cast<int>(found - slots_.begin());
}

/// A bias slot that this scan does not need, or -1.
int SensorBiasStates::oldest() const {
  const auto found = std::ranges::min_element(slots_, {}, &BiasSlot::scan);
  return found == slots_.end() || found->scan == scan_ ? -1 : static_cast<int>(found - slots_.begin());
}

void SensorBiasStates::assign(CompressedState& state, LandmarkId landmark) {
  const int known = find(landmark);
  const int index = known >= 0 ? known : oldest();
  if (index < 0) return;
  BiasSlot& slot = slots_[static_cast<std::size_t>(index)];
  const double rho = known < 0 ? 0.0 : std::exp(-(travelled_m_ - slot.travelled_m) / sensor_.bias_distance_m);
  if (rho < 1.0) state.propagate_bias(first_slot_ + index, rho);
  slot = {landmark, travelled_m_, scan_};
}

ObservationBias SensorBiasStates::of(LandmarkId landmark, double range_m) const {
  ObservationBias error;
  const auto take = [&](std::size_t term, int pair, const Eigen::Vector2d& sigma) {
    error.terms[term].pair = pair;
    error.terms[term].J.topRows<2>() = sigma.asDiagonal();
  };
  if (offsets()) take(2, offset_pair_, {sensor_.shared_range_sigma_m, 0.0});
  if (sensor_.shares())
    take(0, 0, deviations(sensor_.shared_range_sigma_ratio, sensor_.shared_bearing_sigma_deg, range_m));
  if (slots_.empty()) return error;
  const Eigen::Vector2d sigma =
      deviations(sensor_.bias_range_sigma_ratio, sensor_.bias_bearing_sigma_deg, range_m);
  const int slot = find(landmark);
  if (slot >= 0)
    take(1, first_slot_ + slot, sigma);
  else
    error.unmodelled = sigma.cwiseAbs2().asDiagonal();
  return error;
}

CalibrationEstimate SensorBiasStates::calibration(const CompressedState& state) const {
  CalibrationEstimate estimate;
  const auto tell = [&](CalibrationIndex index, double prior_sigma, int pair, int member) {
    if (!(prior_sigma > 0.0)) return;
    estimate.prior_sigmas[index] = prior_sigma;
    estimate.mean[index] = prior_sigma * state.active().biases(pair)[member];
    estimate.sigmas[index] =
        prior_sigma * std::sqrt(state.active().bias_covariance(pair, pair)(member, member));
  };
  tell(kRangeScale, sensor_.shared_range_sigma_ratio, 0, 0);
  tell(kBearingOffset, to_radians(sensor_.shared_bearing_sigma_deg), 0, 1);
  tell(kRangeOffset, sensor_.shared_range_sigma_m, offset_pair_, 0);
  return estimate;
}

}  // namespace waymark::ekf
