#include "workbench/sim/gyro.hpp"

#include <algorithm>
#include <cmath>

#include "waymark/core/angle.hpp"
#include "waymark/core/random.hpp"

namespace waymark::sim {
namespace {

// Random streams, beside those of the drive, the scans and the faults.
constexpr std::uint32_t kBiasAtStart = 7;
constexpr std::uint32_t kReading = 8;

double mean_rate_radps(const Drive& drive, Stamp about, double over_s) {
  const Duration half = duration_from_seconds(0.5 * over_s);
  const Stamp from = std::max(Stamp{}, about - half);
  const Stamp to = std::min(drive.end(), about + half);
  return wrap_angle(drive.at(to).theta_rad - drive.at(from).theta_rad) / to_seconds(to - from);
}

}  // namespace

std::vector<Event> gyro_readings(const GyroOptions& options, const FaultOptions& faults, const Drive& drive,
                                 std::uint64_t seed) {
  std::vector<Event> readings;
  if (options.rate_hz <= 0.0) return readings;
  const double interval_s = 1.0 / options.rate_hz;
  const double noise_degps = options.noise_deg_per_sqrt_s / std::sqrt(interval_s);
  const double walk_degps = options.bias_walk_degps_per_sqrt_s * std::sqrt(interval_s);
  double bias_degps =
      options.bias_sigma_degps * RandomStream(seed, StreamPurpose::kSimulation, 0, kBiasAtStart).normal();
  for (std::uint64_t i = 0;; ++i) {
    const double stamp_s = static_cast<double>(i) * interval_s;
    const Stamp stamp = stamp_from_seconds(stamp_s);
    if (stamp > drive.end()) return readings;
    if (faults.gyro_stuck_at_s > 0.0 && stamp_s > faults.gyro_stuck_at_s) {
      readings.emplace_back(stamp, readings.back().content);
      continue;
    }
    RandomStream random(seed, StreamPurpose::kSimulation, i, kReading);
    const double error_radps = to_radians(bias_degps + noise_degps * random.normal());
    readings.emplace_back(stamp, YawRate{mean_rate_radps(drive, stamp, interval_s) + error_radps});
    bias_degps += walk_degps * random.normal();
  }
}

}  // namespace waymark::sim
