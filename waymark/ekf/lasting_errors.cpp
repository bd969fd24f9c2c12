#include "waymark/ekf/lasting_errors.hpp"

#include <algorithm>
#include <cmath>

#include "waymark/core/angle.hpp"

namespace waymark::ekf {
namespace {

/// Landmarks whose lasting errors are remembered at once. One more costs two rows of the state.
constexpr std::size_t kLoans = 16;

Eigen::Vector2d deviations(double range_ratio, double bearing_deg, double range_m) {
  return {range_ratio * range_m, to_radians(bearing_deg)};
}

}  // namespace

LastingErrors::LastingErrors(const SensorErrors& sensor)
    : sensor_(sensor),
      offset_pair_(sensor.shares() ? 1 : 0),
      first_loan_(offset_pair_ + (offsets() ? 1 : 0)),
      loans_(sensor.lasts() ? kLoans : 0) {}

void LastingErrors::start(CompressedState& state) const {
  for (int pair = 0; pair < pairs(); ++pair) state.relax_errors(pair, 0.0);
}

int LastingErrors::find(LandmarkId landmark) const {
  const auto found = std::ranges::find_if(
      loans_, [landmark](const Loan& loan) { return loan.scan > 0 && loan.landmark == landmark; });
  return found == loans_.end() ? -1 : static_cast<int>(found - loans_.begin());
}

/// A loan that this scan does not need, or -1.
int LastingErrors::oldest() const {
  const auto found = std::ranges::min_element(loans_, {}, &Loan::scan);
  return found == loans_.end() || found->scan == scan_ ? -1 : static_cast<int>(found - loans_.begin());
}

void LastingErrors::sight(CompressedState& state, LandmarkId landmark) {
  const int known = find(landmark);
  const int index = known >= 0 ? known : oldest();
  if (index < 0) return;
  Loan& loan = loans_[static_cast<std::size_t>(index)];
  const double rho = known < 0 ? 0.0 : std::exp(-(way_m_ - loan.way_m) / sensor_.lasting_way_m);
  if (rho < 1.0) state.relax_errors(first_loan_ + index, rho);
  loan = {landmark, way_m_, scan_};
}

SightingError LastingErrors::of(LandmarkId landmark, double range_m) const {
  SightingError error;
  const auto take = [&](std::size_t term, int pair, const Eigen::Vector2d& sigma) {
    error.terms[term].pair = pair;
    error.terms[term].J.topRows<2>() = sigma.asDiagonal();
  };
  if (offsets()) take(2, offset_pair_, {sensor_.shared_range_sigma_m, 0.0});
  if (sensor_.shares())
    take(0, 0, deviations(sensor_.shared_range_sigma_ratio, sensor_.shared_bearing_sigma_deg, range_m));
  if (loans_.empty()) return error;
  const Eigen::Vector2d sigma =
      deviations(sensor_.lasting_range_sigma_ratio, sensor_.lasting_bearing_sigma_deg, range_m);
  const int loan = find(landmark);
  if (loan >= 0)
    take(1, first_loan_ + loan, sigma);
  else
    error.unmodelled = sigma.cwiseAbs2().asDiagonal();
  return error;
}

CalibrationEstimate LastingErrors::calibration(const CompressedState& state) const {
  CalibrationEstimate estimate;
  const auto tell = [&](CalibrationIndex index, double prior_sigma, int pair, int member) {
    if (!(prior_sigma > 0.0)) return;
    estimate.prior_sigmas[index] = prior_sigma;
    estimate.mean[index] = prior_sigma * state.active().errors(pair)[member];
    estimate.sigmas[index] =
        prior_sigma * std::sqrt(state.active().errors_covariance(pair, pair)(member, member));
  };
  tell(kRangeScale, sensor_.shared_range_sigma_ratio, 0, 0);
  tell(kBearingOffset, to_radians(sensor_.shared_bearing_sigma_deg), 0, 1);
  tell(kRangeOffset, sensor_.shared_range_sigma_m, offset_pair_, 0);
  return estimate;
}

}  // namespace waymark::ekf
