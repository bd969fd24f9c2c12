#include "workbench/calibrate/moving_study.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "waymark/core/angle.hpp"

#include "workbench/run/recording.hpp"

namespace waymark::calibrate {
namespace {

constexpr int kMaxRuns = 6;
constexpr int kMaxSmoothings = 15;
/// What moves by less of its standard deviation has settled.
constexpr double kSettledPart = 0.2;
constexpr const char* kDelayKey = "sensor.delay_s";
constexpr const char* kShakingKey = "camera.jitter_deg";

/// One run over the log.
struct Run {
  Config config;
  Recording recording;
};

bool is_camera(const Config& config) { return config.observe == Observe::kMarkers; }

/// Corners that another program found have a noise of their own.
bool has_outlines(const Run& run) { return run.recording.counts.outlines > 0; }

/// Runs over one log with settings that change.
class Runs {
 public:
  Runs(std::string input, UserSettings user, std::function<bool(double)> keep_going)
      : input_(std::move(input)), user_(std::move(user)), keep_going_(std::move(keep_going)) {
    user_.assignments.emplace_back("smooth.run=true");
    const auto defaults = {
        // What is noise cannot be told from what is left over with weights that depend on it; outliers are
        // left out instead.
        "smooth.robust_dof=1000", "smooth.delay_sigma_s=0.1", "smooth.keyframe_distance_m=0.1",
        "smooth.keyframe_turn_deg=10"};
    user_.defaults.insert(user_.defaults.end(), defaults.begin(), defaults.end());
  }

  Result<Run> next() {
    auto opened = open_input(input_, user_);
    if (!opened) return opened.error();
    auto recording = record(*opened->source, opened->config, {}, keep_going_);
    if (!recording) return recording.error();
    if (recording->error) return *recording->error;
    return Run{std::move(opened->config), *std::move(recording)};
  }

  /// The next run is made with what was found.
  void keep(const std::vector<CalibrationFinding>& found, bool may_shift) {
    for (const CalibrationFinding& each : found)
      if (each.found.key != kDelayKey || may_shift)
        user_.assignments.push_back(fmt::format("{}={}", each.found.key, each.found.value));
  }

  [[nodiscard]] const std::string& input() const { return input_; }

 private:
  std::string input_;
  UserSettings user_;
  std::function<bool(double)> keep_going_;
};

CalibrationFinding finding(const char* key, const Value& found, const Config& before) {
  return {{key, found.value, found.sigma}, value_of(before, key)};
}

/// The standard deviation that a factor on its variance leads to.
Value scaled(double sigma, const VarianceFactor& factor) {
  const double found = sigma * std::sqrt(factor.value);
  return {found, factor.redundancy > 0.0 ? found / std::sqrt(2.0 * factor.redundancy) : 0.0};
}

/// What bearings err by beyond the noise of pixels, which ranges tell.
Value shaking_deg(const SensorNoise& noise, double stated_deg) {
  const double stated_rad2 = std::pow(to_radians(stated_deg), 2);
  const double of_pixels_rad2 = std::max(0.0, noise.bearing_variance.stated - stated_rad2);
  const double all_rad2 = noise.bearing_variance.value * noise.bearing_variance.stated;
  const double shaking_rad = std::sqrt(std::max(0.0, all_rad2 - noise.range_variance.value * of_pixels_rad2));
  const double sigma_rad2 = all_rad2 * std::sqrt(2.0 / std::max(1.0, noise.bearing_variance.redundancy));
  return {to_degrees(shaking_rad),
          to_degrees(std::min(std::sqrt(sigma_rad2), 0.5 * sigma_rad2 / shaking_rad))};
}

/// A camera that shakes moves all of an image, as a robot that turns does: little of it is left over. It is
/// told where it is more than was assumed, and else stays.
CalibrationFinding shaking(const SensorNoise& noise, double stated_deg, const Config& before) {
  const Value found = shaking_deg(noise, stated_deg);
  CalibrationFinding shaking = finding(kShakingKey, found, before);
  if (found.value > shaking.before) return shaking;
  shaking.found.value = shaking.before;
  shaking.found.is_unobservable = true;
  return shaking;
}

std::vector<CalibrationFinding> marker_noise(const SensorNoise& noise, const Run& run, const Config& before) {
  const markers::MarkerOptions& stated = run.config.markers;
  const CalibrationFinding pixels =
      has_outlines(run)
          ? finding("markers.corner_sigma_px", scaled(stated.corner_sigma_px, noise.range_variance), before)
          : finding("markers.side_sigma_px", scaled(stated.side_sigma_px, noise.range_variance), before);
  return {pixels, shaking(noise, stated.jitter_deg, before)};
}

std::vector<CalibrationFinding> sensor_noise(const SensorNoise& noise, const Config& before) {
  constexpr double kLeast_m = 1e-6;
  std::vector<CalibrationFinding> found;
  if (noise.range) {
    const auto& [sigma_m, sigma_ratio] = *noise.range;
    found.push_back(
        finding("sensor.range_sigma_m", {std::max(kLeast_m, sigma_m.value), sigma_m.sigma}, before));
    found.push_back(finding("sensor.range_sigma_ratio", sigma_ratio, before));
  }
  if (const auto& bearing = noise.bearing_sigma_rad)
    found.push_back(finding("sensor.bearing_sigma_deg",
                            {to_degrees(bearing->value), to_degrees(bearing->sigma)}, before));
  return found;
}

std::vector<CalibrationFinding> findings_of(const SensorNoise& noise, const Run& run,
                                            const smooth::Smoothed& smoothed, const Config& before) {
  auto found = is_camera(run.config) ? marker_noise(noise, run, before) : sensor_noise(noise, before);
  CalibrationEstimate delay = smoothed.calibration;
  delay.sigmas.head<kDelay>().setZero();  // the rest is `calibrate odometry` and `calibrate mount`
  for (const smooth::CalibratedKey& key : smooth::calibrated_keys(delay, run.config))
    found.push_back({key, value_of(before, key.key)});
  return found;
}

bool is_same(const std::vector<CalibrationFinding>& a, const std::vector<CalibrationFinding>& b) {
  return std::ranges::equal(a, b, [](const CalibrationFinding& x, const CalibrationFinding& y) {
    return x.found.key == y.found.key &&
           std::abs(x.found.value - y.found.value) <= kSettledPart * std::max(x.found.sigma, y.found.sigma);
  });
}

/// Puts noise in force; another delay needs another run.
Config with_noise(Config config, const std::vector<CalibrationFinding>& found) {
  Schema schema = describe(config);
  for (const CalibrationFinding& each : found)
    if (each.found.key != kDelayKey)
      static_cast<void>(schema.set(each.found.key, fmt::format("{}", each.found.value), "found"));
  return config;
}

/// The covariance that a run with other noise would have given an observation.
Eigen::Matrix2d restated(const Observation& seen, const Run& run, const Config& to) {
  if (!is_camera(to)) return noise_covariance(to.sensor, seen.value);
  const auto& [old_options, new_options] = std::pair(run.config.markers, to.markers);
  const double larger = has_outlines(run) ? new_options.corner_sigma_px / old_options.corner_sigma_px
                                          : new_options.side_sigma_px / old_options.side_sigma_px;
  Eigen::Matrix2d R = *seen.covariance;
  R(1, 1) -= std::pow(to_radians(old_options.jitter_deg), 2);
  R *= larger * larger;
  R(1, 1) += std::pow(to_radians(new_options.jitter_deg), 2);
  return R;
}

void restate(Run& run, const Config& to) {
  for (Recording::ObservationRecord& landmark_observation : run.recording.observations)
    landmark_observation.observation.covariance = restated(landmark_observation.observation, run, to);
  run.config = to;
}

/// Finds noise and delay from one log.
class Settling {
 public:
  explicit Settling(Runs& runs) : runs_(runs) {}

  /// Runs until what comes out is what went in.
  Result<MovingStudy> settle() {
    while (!study_.settled && study_.runs < kMaxRuns) {
      auto run = runs_.next();
      if (!run) return run.error();
      ++study_.runs;
      if (!before_) before_ = run->config;
      if (auto done = settle(*run); !done) return done.error();
      // Other stamps are other data, which by chance say something else again: after a few, noise is to
      // settle.
      constexpr int kMaxShifts = 3;
      runs_.keep(study_.findings, study_.runs <= kMaxShifts);
    }
    return std::move(study_);
  }

 private:
  /// Smooths one run until its noise stays. Settled is that at once if neither noise nor delay moves.
  Result<void> settle(Run& run) {
    for (int i = 0; i < kMaxSmoothings; ++i) {
      auto found = look(run);
      if (!found) return found.error();
      const bool is_what_went_in = is_same(*found, std::exchange(study_.findings, *found));
      study_.settled = i == 0 && study_.runs > 1 && is_what_went_in;
      if (is_what_went_in) break;
      restate(run, with_noise(run.config, study_.findings));
    }
    return {};
  }

  Result<std::vector<CalibrationFinding>> look(const Run& run) {
    smooth::Before before;
    for (std::size_t i = 0; i < 3; ++i)
      before.odometry_noise[static_cast<Eigen::Index>(i)] = study_.odometry_noise[i].value;
    before.calibration[kDelay] = before_->sensor.delay_s - run.config.sensor.delay_s;
    const auto smoothed = smooth::smooth(run.recording, run.config, before);
    if (!smoothed) return smoothed.error();
    if (smoothed->observation_residuals.empty())
      return Error{runs_.input() + ": no landmark was observed often enough to estimate the noise"};
    study_.noise = noise_of(smoothed->observation_residuals);
    const auto factors = odometry_variance_of(smoothed->interval_residuals);
    for (std::size_t i = 0; i < 3; ++i)
      study_.odometry_noise[i] = scaled(study_.odometry_noise[i].value, factors[i]);
    return findings_of(study_.noise, run, *smoothed, *before_);
  }

  Runs& runs_;
  std::optional<Config> before_;
  MovingStudy study_;
};

/// Half as much again, or less by as much, and surely so.
bool is_far_off(const Value& times) {
  constexpr double kFar = 1.5;
  constexpr double kSure_sigmas = 4.0;
  return (times.value > kFar || times.value < 1.0 / kFar) &&
         std::abs(times.value - 1.0) > kSure_sigmas * times.sigma;
}

bool is_unobservable(const MovingStudy& study, const char* key) {
  return std::ranges::any_of(study.findings, [key](const CalibrationFinding& each) {
    return each.found.key == key && each.found.is_unobservable;
  });
}

std::vector<std::string> notes_on(const MovingStudy& study) {
  std::vector<std::string> notes;
  if (study.noise.outliers > 0)
    notes.push_back(
        fmt::format("{} residuals beyond 4 sigma were left out as outliers", study.noise.outliers));
  if (!study.settled)
    notes.push_back(fmt::format("not converged: results still changed after {} runs", study.runs));
  if (is_unobservable(study, kDelayKey))
    notes.push_back(
        fmt::format("{} is not observable in this log: the robot must turn, stop and start", kDelayKey));
  if (is_unobservable(study, kShakingKey))
    notes.push_back(fmt::format("{} was not changed: a smaller value cannot be told from turns of the robot",
                                kShakingKey));
  // Sideways little is left over to tell.
  const auto& [ahead, sideways, turning] = study.odometry_noise;
  if (is_far_off(ahead) || is_far_off(turning))
    notes.push_back(
        fmt::format("the noise of the odometry is {:.2f} times that of the config along the path and {:.2f} "
                    "times in turns: `waymark tune` estimates it",
                    ahead.value, turning.value));
  return notes;
}

}  // namespace

Result<MovingStudy> study_moving(const std::string& input, const UserSettings& user,
                                 const std::function<bool(double)>& keep_going) {
  Runs runs(input, user, keep_going);
  auto study = Settling(runs).settle();
  if (!study) return study.error();
  study->input = input;
  study->notes = notes_on(*study);
  return study;
}

std::string to_yaml(const MovingStudy& study) { return smooth::calibration_yaml(keys_of(study.findings)); }

}  // namespace waymark::calibrate
