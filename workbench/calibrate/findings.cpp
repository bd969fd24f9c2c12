#include "workbench/calibrate/findings.hpp"

#include <array>
#include <cmath>
#include <cstdlib>

#include "waymark/core/angle.hpp"

#include "workbench/calibrate/wheels.hpp"

namespace waymark::calibrate {
namespace {

constexpr std::array kScaleKeys{"motion.speed_scale", "motion.turn_scale"};

/// Left and right radius, track, and right by left radius: values, standard deviations, and whether the log
/// tells them.
std::vector<CalibrationFinding> wheel_findings(const smooth::Smoothed& smoothed, const Config& during,
                                               const Config& before) {
  const Calibration& c = smoothed.calibration.mean;
  const WheelGeometry used = with_scales(during.odometry);
  const WheelGeometry found = corrected(used, c);
  const WheelGeometry assumed = with_scales(before.odometry);
  Eigen::Matrix<double, 4, kCalibrationSize> J;
  J.topRows<3>() = log_jacobian(used, c);
  J.row(3) = J.row(1) - J.row(0);
  const Eigen::Vector4d relative =
      (J * smoothed.calibration_covariance * J.transpose()).diagonal().cwiseSqrt();
  const Eigen::Vector4d relative_before =
      (J * smoothed.calibration.prior_sigmas.cwiseAbs2().asDiagonal() * J.transpose()).diagonal().cwiseSqrt();
  std::vector<CalibrationFinding> list;
  const auto add = [&](const char* key, double value, double value_before, bool is_key) {
    const auto i = static_cast<Eigen::Index>(list.size());
    list.push_back({{key, value, value * relative[i], relative[i] > kObservableRatio * relative_before[i]},
                    value_before,
                    is_key});
  };
  add("wheels.left_radius_m", found.left_radius_m, assumed.left_radius_m, true);
  add("wheels.right_radius_m", found.right_radius_m, assumed.right_radius_m, true);
  add("wheels.track_m", found.track_m, assumed.track_m, true);
  add("right radius / left radius", found.right_radius_m / found.left_radius_m,
      assumed.right_radius_m / assumed.left_radius_m, false);
  return list;
}

}  // namespace

double value_of(const Config& config, const std::string& key) {
  Config copy = config;
  return std::strtod(describe(copy).value(key).c_str(), nullptr);
}

std::vector<CalibrationFinding> findings(const smooth::Smoothed& smoothed, const Config& during,
                                         const Config& before, OdometryKind odometry) {
  std::vector<CalibrationFinding> list;
  CalibrationEstimate rest = smoothed.calibration;
  if (odometry == OdometryKind::kWheels) {
    list = wheel_findings(smoothed, during, before);
    rest.sigmas[kSpeedScale] = rest.sigmas[kTurnScale] = 0.0;
  }
  for (const smooth::CalibratedKey& key : smooth::calibrated_keys(rest, during))
    list.push_back({key, value_of(before, key.key)});
  return list;
}

std::vector<smooth::CalibratedKey> keys_of(const std::vector<CalibrationFinding>& findings) {
  std::vector<smooth::CalibratedKey> keys;
  for (const CalibrationFinding& finding : findings)
    if (finding.is_key) keys.push_back(finding.found);
  if (!keys.empty() && keys.front().key.starts_with("wheels."))
    for (const char* key : kScaleKeys) keys.push_back({key, 1.0});
  return keys;
}

Calibration deviation(const Config& during, const Config& to, OdometryKind odometry) {
  const OdometryOptions& a = during.odometry;
  const OdometryOptions& b = to.odometry;
  Calibration c = Calibration::Zero();
  if (odometry == OdometryKind::kWheels) {
    c = deviation(with_scales(a), with_scales(b));
  } else {
    c[kSpeedScale] = b.speed_scale / a.speed_scale - 1.0;
    c[kTurnScale] = b.turn_scale / a.turn_scale - 1.0;
  }
  c[kTurnBias] = to_radians(b.turn_bias_degps - (1.0 + c[kTurnScale]) * a.turn_bias_degps);
  c[kRangeScale] = to.sensor.range_scale / during.sensor.range_scale - 1.0;
  c[kRangeOffset] = (to.sensor.range_offset_m - during.sensor.range_offset_m) / during.sensor.range_scale;
  c[kBearingOffset] = to_radians(during.sensor.yaw_deg - to.sensor.yaw_deg);
  c[kMountX] = to.sensor.x_m - during.sensor.x_m;
  c[kMountY] = to.sensor.y_m - during.sensor.y_m;
  c[kDelay] = to.sensor.delay_s - during.sensor.delay_s;
  return c;
}

}  // namespace waymark::calibrate
