#include "waymark/calibrate/sensor_noise.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>
#include <fmt/format.h>

#include "waymark/core/angle.hpp"
#include "waymark/slam/recording.hpp"

namespace waymark::calibrate {
namespace {

constexpr int kMostRuns = 12;
constexpr double kOutlier = 4.0;

/// One number of a sighting: where on its axis, its error, and how much of the variance was followed.
struct Sample {
  double at;
  double error;
  double followed;
};

std::vector<Sample> samples_of(const std::vector<smooth::SmoothedSighting>& sightings, bool ranges) {
  std::vector<Sample> samples;
  for (const auto& [measured, rest] : sightings) {
    if (const auto* z = std::get_if<RangeBearing>(&measured)) {
      const Eigen::Index i = ranges ? 0 : 1;
      samples.push_back({ranges ? z->range_m : z->bearing_rad, -rest.residual[i], rest.followed[i]});
    } else if (const auto* range = std::get_if<Range>(&measured); range != nullptr && ranges) {
      samples.push_back({range->range_m, -rest.residual[0], rest.followed[0]});
    } else if (const auto* bearing = std::get_if<Bearing>(&measured); bearing != nullptr && !ranges) {
      samples.push_back({bearing->bearing_rad, -rest.residual[0], rest.followed[0]});
    }
  }
  return samples;
}

NoiseBin bin_of(std::span<const Sample> samples) {
  NoiseBin bin;
  bin.count = static_cast<int>(samples.size());
  const auto n = static_cast<double>(samples.size());
  double variance = 0.0, left = 0.0;
  for (const Sample& sample : samples) {
    bin.at += sample.at / n;
    bin.mean += sample.error / n;
    variance += (sample.error * sample.error + sample.followed) / n;
    left += sample.error * sample.error / n;
  }
  bin.sigma.value = std::sqrt(variance);
  // Only what is left over is random: the part of n that was not followed.
  bin.sigma.sigma =
      left > 0.0 ? variance / (2.0 * bin.sigma.value) * std::sqrt(2.0 / (n * left / variance)) : 0.0;
  return bin;
}

/// Removes what lies beyond so many standard deviations of all, until nothing does.
int drop_outliers(std::vector<Sample>& samples) {
  const std::size_t before = samples.size();
  for (std::size_t last = 0; last != samples.size();) {
    last = samples.size();
    if (last == 0) break;
    const double limit = kOutlier * bin_of(samples).sigma.value;
    std::erase_if(samples, [limit](const Sample& each) { return std::abs(each.error) > limit; });
  }
  return static_cast<int>(before - samples.size());
}

std::vector<NoiseBin> bins_of(std::vector<Sample> samples) {
  constexpr std::size_t kMostBins = 8;
  constexpr std::size_t kLeastCount = 20;
  std::ranges::sort(samples, {}, &Sample::at);
  const std::size_t count = std::clamp<std::size_t>(samples.size() / kLeastCount, 1, kMostBins);
  std::vector<NoiseBin> bins;
  for (std::size_t i = 0; i < count && !samples.empty(); ++i) {
    const std::size_t first = i * samples.size() / count, end = (i + 1) * samples.size() / count;
    bins.push_back(bin_of(std::span(samples).subspan(first, end - first)));
  }
  return bins;
}

}  // namespace

std::optional<RangeNoise> fit_range_noise(const std::vector<NoiseBin>& bins) {
  if (bins.empty()) return std::nullopt;
  Eigen::Matrix2d A = Eigen::Matrix2d::Zero();
  Eigen::Vector2d b = Eigen::Vector2d::Zero();
  for (const NoiseBin& bin : bins) {
    const Eigen::Vector2d row(1.0, bin.at);
    const double weight = 1.0 / std::max(1e-18, bin.sigma.sigma * bin.sigma.sigma);
    A += weight * row * row.transpose();
    b += weight * bin.sigma.value * row;
  }
  const Value constant{b[0] / A(0, 0), std::sqrt(1.0 / A(0, 0))};
  if (bins.size() < 3) return RangeNoise{constant, {}};
  const Eigen::Matrix2d P = A.inverse();
  const Eigen::Vector2d line = P * b;
  if (line[1] < 0.0) return RangeNoise{constant, {}};
  if (line[0] <= 0.0) return RangeNoise{{}, {b[1] / A(1, 1), std::sqrt(1.0 / A(1, 1))}};
  return RangeNoise{{line[0], std::sqrt(P(0, 0))}, {line[1], std::sqrt(P(1, 1))}};
}

SensorNoise noise_of(const std::vector<smooth::SmoothedSighting>& sightings) {
  SensorNoise noise;
  auto ranges = samples_of(sightings, true), bearings = samples_of(sightings, false);
  noise.outliers = drop_outliers(ranges) + drop_outliers(bearings);
  noise.ranges = bins_of(ranges);
  noise.bearings = bins_of(bearings);
  noise.range = fit_range_noise(noise.ranges);
  if (!bearings.empty()) {
    const Value sigma = bin_of(bearings).sigma;
    noise.bearing_sigma_deg = Value{to_degrees(sigma.value), to_degrees(sigma.sigma)};
  }
  return noise;
}

namespace {

/// Runs over one log with settings that change.
class Runs {
 public:
  Runs(std::string input, UserSettings user, std::function<bool(double)> keep_going)
      : input_(std::move(input)), user_(std::move(user)), keep_going_(std::move(keep_going)) {
    user_.assignments.emplace_back("smooth.run=true");
    // What is noise cannot be told from what is left over with weights that depend on it; outliers are left
    // out instead.
    user_.defaults.emplace_back("smooth.robust_dof=1000");
  }

  Result<smooth::Smoothed> run() {
    auto opened = open_input(input_, user_);
    if (!opened) return opened.error();
    if (!first_) first_ = opened->config;
    const auto recording = record(*opened->source, opened->config, {}, keep_going_);
    if (!recording) return recording.error();
    if (recording->error) return *recording->error;
    ++count_;
    auto smoothed = smooth::smooth(*recording, opened->config);
    if (!smoothed) return smoothed.error();
    if (smoothed->remainders.empty())
      return Error{input_ + ": no landmark was seen often enough to tell what is noise"};
    return smoothed;
  }

  void keep(std::vector<std::string> settings) {
    std::ranges::move(settings, std::back_inserter(user_.assignments));
  }

  [[nodiscard]] int count() const { return count_; }
  [[nodiscard]] const Config& first() const { return *first_; }

 private:
  std::string input_;
  UserSettings user_;
  std::function<bool(double)> keep_going_;
  std::optional<Config> first_;
  int count_ = 0;
};

std::vector<std::pair<std::string, Value>> keys_of(const SensorNoise& noise) {
  std::vector<std::pair<std::string, Value>> keys;
  if (noise.range) {
    keys.emplace_back("sensor.range_sigma_m", noise.range->sigma_m);
    keys.back().second.value = std::max(1e-6, keys.back().second.value);
    keys.emplace_back("sensor.range_sigma_ratio", noise.range->sigma_ratio);
  }
  if (noise.bearing_sigma_deg) keys.emplace_back("sensor.bearing_sigma_deg", *noise.bearing_sigma_deg);
  return keys;
}

std::vector<std::string> settings_of(const SensorNoise& noise) {
  std::vector<std::string> settings;
  for (const auto& [key, value] : keys_of(noise)) settings.push_back(fmt::format("{}={}", key, value.value));
  return settings;
}

bool is_same(const SensorNoise& a, const SensorNoise& b) {
  constexpr double kSame = 0.02;
  const auto near = [](double x, double y) { return std::abs(x - y) <= kSame * std::max(x, y); };
  const auto at_middle = [](const SensorNoise& noise) {
    const NoiseBin& bin = noise.ranges[noise.ranges.size() / 2];
    return noise.range->sigma_m.value + noise.range->sigma_ratio.value * bin.at;
  };
  return (!a.range || !b.range || near(at_middle(a), at_middle(b))) &&
         (!a.bearing_sigma_deg || !b.bearing_sigma_deg ||
          near(a.bearing_sigma_deg->value, b.bearing_sigma_deg->value));
}

/// Runs until the noise that comes out is the noise that went in.
Result<SensorNoise> settle_noise(Runs& runs) {
  SensorNoise last;
  for (int i = 0; i < kMostRuns; ++i) {
    const auto smoothed = runs.run();
    if (!smoothed) return smoothed.error();
    SensorNoise noise = noise_of(smoothed->remainders);
    noise.settled = i > 0 && is_same(noise, last);
    last = std::move(noise);
    if (last.settled) break;
    runs.keep(settings_of(last));
  }
  return last;
}

}  // namespace

Result<SensorNoise> calibrate_noise(const std::string& input, const UserSettings& user,
                                    const std::function<bool(double)>& keep_going) {
  Runs runs(input, user, keep_going);
  auto noise = settle_noise(runs);
  if (!noise) return noise.error();
  if (!noise->settled) noise->notes.emplace_back("what was found still moved with the last run");
  noise->runs = runs.count();
  noise->input = input;
  noise->before = runs.first();
  return noise;
}

std::string to_yaml(const SensorNoise& noise) {
  std::string yaml = "# What the log says about its landmark sensor; for --config.\n";
  for (const auto& [key, value] : keys_of(noise))
    yaml += fmt::format("{}: {:.6g}  # +- {:.2g}\n", key, value.value, value.sigma);
  return yaml;
}

}  // namespace waymark::calibrate
