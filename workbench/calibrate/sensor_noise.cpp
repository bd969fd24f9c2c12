#include "workbench/calibrate/sensor_noise.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include <Eigen/LU>

namespace waymark::calibrate {
namespace {

constexpr double kOutlierSigmas = 4.0;
/// A part of the noise that is less surely there is left out.
constexpr double kObservable_sigmas = 2.0;

/// One number of an observation: where on its axis, its error, and how it was weighed and followed.
struct Sample {
  double at;
  double error;
  double followed;  ///< variance
  double stated;    ///< variance

  /// The part of the error that is left over.
  [[nodiscard]] double redundancy() const { return std::max(0.0, 1.0 - followed / stated); }
};

Sample sample_of(double at, const smooth::ObservationResidual& rest, Eigen::Index i) {
  return {at, -rest.residual[i], rest.followed[i], rest.stated[i]};
}

std::vector<Sample> samples_of(const std::vector<smooth::SmoothedObservation>& observations, bool ranges) {
  std::vector<Sample> samples;
  for (const auto& [measured, rest] : observations) {
    if (const auto* z = std::get_if<RangeBearing>(&measured))
      samples.push_back(sample_of(ranges ? z->range_m : z->bearing_rad, rest, ranges ? 0 : 1));
    else if (const auto* range = std::get_if<Range>(&measured); range != nullptr && ranges)
      samples.push_back(sample_of(range->range_m, rest, 0));
    else if (const auto* bearing = std::get_if<Bearing>(&measured); bearing != nullptr && !ranges)
      samples.push_back(sample_of(bearing->bearing_rad, rest, 0));
  }
  return samples;
}

VarianceFactor variance_factor(std::span<const Sample> samples) {
  constexpr double kLeast = 1e-6;
  VarianceFactor factor;
  double left = 0.0;
  for (const Sample& sample : samples) {
    left += sample.error * sample.error / sample.stated;
    factor.stated += sample.stated / static_cast<double>(samples.size());
    factor.redundancy += sample.redundancy();
  }
  if (factor.redundancy > kLeast) factor.value = std::max(kLeast, left / factor.redundancy);
  return factor;
}

NoiseBin bin_of(std::span<const Sample> samples) {
  NoiseBin bin;
  bin.count = static_cast<int>(samples.size());
  const auto n = static_cast<double>(samples.size());
  for (const Sample& sample : samples) {
    bin.at += sample.at / n;
    bin.mean += sample.error / n;
  }
  const VarianceFactor factor = variance_factor(samples);
  bin.sigma.value = std::sqrt(factor.value * factor.stated);
  if (factor.redundancy > 0.0) bin.sigma.sigma = bin.sigma.value / std::sqrt(2.0 * factor.redundancy);
  return bin;
}

/// Removes what lies beyond so many standard deviations of what is left over, until nothing does.
int drop_outliers(std::vector<Sample>& samples) {
  const std::size_t before = samples.size();
  for (std::size_t last = 0; last != samples.size();) {
    last = samples.size();
    const double limit = kOutlierSigmas * kOutlierSigmas * variance_factor(samples).value;
    std::erase_if(samples, [limit](const Sample& each) {
      return each.error * each.error > limit * each.stated * std::max(0.1, each.redundancy());
    });
  }
  return static_cast<int>(before - samples.size());
}

std::vector<NoiseBin> bins_of(std::vector<Sample> samples) {
  constexpr std::size_t kMaxBins = 8;
  constexpr std::size_t kMinCount = 20;
  std::ranges::sort(samples, {}, &Sample::at);
  const std::size_t count = std::clamp<std::size_t>(samples.size() / kMinCount, 1, kMaxBins);
  std::vector<NoiseBin> bins;
  for (std::size_t i = 0; i < count && !samples.empty(); ++i) {
    const std::size_t first = i * samples.size() / count, end = (i + 1) * samples.size() / count;
    bins.push_back(bin_of(std::span(samples).subspan(first, end - first)));
  }
  return bins;
}

/// A bin is known to a part of its standard deviation: of that which a fit says, since bins that came out
/// small by chance would count most by their own.
double weight_of(const NoiseBin& bin, const std::optional<RangeNoise>& fit) {
  const double part = bin.sigma.sigma / std::max(1e-9, bin.sigma.value);
  const double sigma = fit ? fit->sigma_m.value + bin.at * fit->sigma_ratio.value : 1.0;
  return 1.0 / std::max(1e-18, part * part * sigma * sigma);
}

RangeNoise fit_range_noise_once(const std::vector<NoiseBin>& bins, const std::optional<RangeNoise>& before) {
  Eigen::Matrix2d A = Eigen::Matrix2d::Zero();
  Eigen::Vector2d b = Eigen::Vector2d::Zero();
  for (const NoiseBin& bin : bins) {
    const Eigen::Vector2d row(1.0, bin.at);
    const double weight = weight_of(bin, before);
    A += weight * row * row.transpose();
    b += weight * bin.sigma.value * row;
  }
  const Value constant{b[0] / A(0, 0), std::sqrt(1.0 / A(0, 0))};
  if (bins.size() < 3) return {constant, {}};
  const Eigen::Matrix2d P = A.inverse();
  const Eigen::Vector2d line = P * b;
  if (line[1] < kObservable_sigmas * std::sqrt(P(1, 1))) return {constant, {}};
  if (line[0] <= 0.0) return {{}, {b[1] / A(1, 1), std::sqrt(1.0 / A(1, 1))}};
  return {{line[0], std::sqrt(P(0, 0))}, {line[1], std::sqrt(P(1, 1))}};
}

}  // namespace

std::optional<RangeNoise> fit_range_noise(const std::vector<NoiseBin>& bins) {
  if (bins.empty()) return std::nullopt;
  constexpr int kRounds = 4;
  RangeNoise noise = fit_range_noise_once(bins, std::nullopt);
  for (int round = 0; round < kRounds; ++round) noise = fit_range_noise_once(bins, noise);
  return noise;
}

SensorNoise noise_of(const std::vector<smooth::SmoothedObservation>& observations) {
  SensorNoise noise;
  auto ranges = samples_of(observations, true), bearings = samples_of(observations, false);
  noise.outliers = drop_outliers(ranges) + drop_outliers(bearings);
  noise.ranges = bins_of(ranges);
  noise.bearings = bins_of(bearings);
  noise.range = fit_range_noise(noise.ranges);
  noise.range_variance = variance_factor(ranges);
  noise.bearing_variance = variance_factor(bearings);
  if (!bearings.empty()) noise.bearing_sigma_rad = bin_of(bearings).sigma;
  return noise;
}

std::array<VarianceFactor, 3> odometry_variance_of(const std::vector<smooth::IntervalResidual>& intervals) {
  std::array<VarianceFactor, 3> factors;
  for (Eigen::Index i = 0; i < 3; ++i) {
    std::vector<Sample> samples;
    for (const auto& interval : intervals)
      samples.push_back({0.0, interval.residual[i], interval.followed[i], interval.stated[i]});
    drop_outliers(samples);
    factors[static_cast<std::size_t>(i)] = variance_factor(samples);
  }
  return factors;
}

}  // namespace waymark::calibrate
