#include "workbench/calibrate/log_calibration.hpp"

#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "waymark/core/angle.hpp"

namespace waymark::calibrate {
namespace {

constexpr int kMaxPasses = 10;
/// A pass that moves nothing by more of its standard deviation is the last.
constexpr double kSettled = 0.05;

/// Wide enough that what the log says decides.
std::vector<std::string> wide_priors(Subject subject) {
  std::vector<std::string> keys{"motion.speed_scale_sigma=0.3", "motion.turn_scale_sigma=0.3",
                                "motion.turn_bias_sigma_degps=2", "smooth.turn_per_m_sigma_deg=20",
                                // Stamps jitter, wheels give: on short intervals that outweighs the motion.
                                "smooth.keyframe_distance_m=0.1", "smooth.keyframe_turn_deg=10"};
  if (subject == Subject::kMount)
    keys.insert(keys.end(), {"smooth.mount_sigma_m=0.5", "smooth.mount_yaw_sigma_deg=20"});
  return keys;
}

/// What the odometry turns by itself: of wheels per metre, of anything else per second.
void keep_one_bias(SmoothOptions& options, OdometryKind odometry) {
  (odometry == OdometryKind::kWheels ? options.turn_bias_sigma_degps : options.turn_per_m_sigma_deg) = 0.0;
}

/// One run over the log.
struct Pass {
  Config config;
  LogInfo log;
  Recording recording;
  OdometryKind odometry{};
  smooth::Smoothed smoothed;
};

/// What the log lacks for a calibration, if anything.
Result<void> check(const std::string& input, const Recording& recording) {
  if (recording.error && recording.error->kind == Error::Kind::kFailed) return *recording.error;
  if (!recording.odometry && recording.error) return *recording.error;
  if (!recording.odometry)
    return Error{input + ": no odometry: wheel angles, velocities, steering or odometry poses are needed"};
  if (recording.observations.empty() && recording.error) return *recording.error;
  if (recording.observations.empty())
    return Error{input + ": no landmark was observed, so the true motion of the robot is not observable"};
  return {};
}

class Passes {
 public:
  Passes(std::string input, UserSettings user, Subject subject, const TimeSpan& span)
      : input_(std::move(input)), user_(std::move(user)), span_(span) {
    user_.defaults = wide_priors(subject);
    user_.assignments.emplace_back("smooth.run=true");
  }

  /// The next run, with what the one before found.
  Result<Pass> next(const std::function<bool(double)>& keep_going) {
    auto opened = open_input(input_, user_);
    if (!opened) return opened.error();
    auto recording = record(*opened->source, opened->config, span_, keep_going);
    if (!recording) return recording.error();
    if (auto usable = check(input_, *recording); !usable) return usable.error();
    Pass pass{opened->config, opened->source->info(), *std::move(recording), {}, {}};
    pass.odometry = *pass.recording.odometry;
    keep_one_bias(pass.config.smooth, pass.odometry);
    if (!before_) before_ = pass.config;
    auto smoothed = smooth::smooth(pass.recording, pass.config,
                                   {deviation(pass.config, *before_, pass.odometry), steps_});
    if (!smoothed) return smoothed.error();
    if (smoothed->observations == 0)
      return Error{input_ +
                   ": the filter mapped no landmark from two places; filter=fastslam can start from ranges "
                   "or bearings alone"};
    pass.smoothed = *std::move(smoothed);
    steps_ = pass.smoothed.steps;
    return pass;
  }

  [[nodiscard]] std::vector<CalibrationFinding> found(const Pass& pass) const {
    return findings(pass.smoothed, pass.config, *before_, pass.odometry);
  }

  void apply(const std::vector<CalibrationFinding>& found) {
    for (const smooth::CalibratedKey& key : keys_of(found))
      user_.assignments.push_back(fmt::format("{}={}", key.key, key.value));
  }

 private:
  std::string input_;
  UserSettings user_;
  TimeSpan span_;
  std::optional<Config> before_;
  std::vector<std::size_t> steps_;  // the same in every pass: another choice would be other data
};

bool has_settled(const CalibrationEstimate& estimate) {
  for (Eigen::Index i = 0; i < kCalibrationSize; ++i)
    if (std::abs(estimate.mean[i]) > kSettled * estimate.sigmas[i]) return false;
  return true;
}

double turned_rad(const Trajectory& path) {
  double sum_rad = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i)
    sum_rad += std::abs(wrap_angle(path[i].pose.theta_rad - path[i - 1].pose.theta_rad));
  return sum_rad;
}

double driven_m(const Trajectory& path) {
  double sum_m = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i)
    sum_m += (path[i].pose.position() - path[i - 1].pose.position()).norm();
  return sum_m;
}

/// What the motion does not excite, and what else a reader of the figures must know.
std::vector<std::string> notes_on(const LogCalibration& result, const Pass& pass) {
  std::vector<std::string> notes;
  if (pass.recording.error)
    notes.push_back("only part of the log was read: " + pass.recording.error->message);
  std::vector<std::string> unobservable;
  for (const CalibrationFinding& finding : result.findings)
    if (finding.found.is_unobservable) unobservable.push_back(finding.found.key);
  if (!unobservable.empty())
    notes.push_back(fmt::format(
        "not observable in this log, and kept at the prior: {}; the robot drove {:.1f} m and turned by "
        "{:.0f} degrees in total",
        fmt::join(unobservable, ", "), driven_m(result.smoothed), to_degrees(turned_rad(result.smoothed))));
  if (pass.smoothed.calibration.sigmas[kSpeedScale] == 0.0)
    notes.emplace_back(
        "the scale of distances was not estimated: it is not observable without ranges of known scale");
  if (!result.settled)
    notes.push_back(
        fmt::format("not converged: results still changed after {} runs over the log", result.passes));
  return notes;
}

std::optional<DriftPair> compare(const LogCalibration& result, const eval::TruthTrack& reference,
                                 const eval::AssociateOptions& options) {
  const auto before = drift_of(result.dead_reckoning_before, reference, options);
  const auto after = drift_of(result.dead_reckoning_after, reference, options);
  return before && after ? std::optional(DriftPair{*before, *after}) : std::nullopt;
}

void add_worth(LogCalibration& result) {
  result.drift = compare(result, eval::TruthTrack::from_trajectory(result.smoothed), {});
  eval::AssociateOptions options;
  if (result.log.truth_sensor_m) options.truth_sensor_m = *result.log.truth_sensor_m;
  if (!result.truth.empty()) result.drift_from_truth = compare(result, result.truth, options);
}

eval::TruthTrack truth_of(const Recording& recording) {
  std::vector<eval::TruthSample> samples;
  for (const auto& [stamp, truth] : recording.truth) samples.push_back({stamp, truth});
  return eval::TruthTrack(std::move(samples));
}

}  // namespace

Result<LogCalibration> calibrate_log(const std::string& input, const UserSettings& user, Subject subject,
                                     const TimeSpan& span,
                                     const std::function<bool(int, double)>& keep_going) {
  Passes passes(input, user, subject, span);
  LogCalibration result;
  result.input = input;
  while (true) {
    auto pass = passes.next([&](double part) { return !keep_going || keep_going(result.passes, part); });
    if (!pass) return pass.error();
    if (result.passes++ == 0) result.dead_reckoning_before = pass->recording.dead_reckoning;
    result.findings = passes.found(*pass);
    result.settled = has_settled(pass->smoothed.calibration);
    if (!result.settled && result.passes < kMaxPasses) {
      passes.apply(result.findings);
      continue;
    }
    result.log = pass->log;
    result.config = pass->config;
    result.dead_reckoning_after = std::move(pass->recording.dead_reckoning);
    result.smoothed = std::move(pass->smoothed.trajectory);
    result.truth = truth_of(pass->recording);
    result.notes = notes_on(result, *pass);
    add_worth(result);
    return result;
  }
}

std::string to_yaml(const LogCalibration& calibration) {
  return smooth::calibration_yaml(keys_of(calibration.findings));
}

}  // namespace waymark::calibrate
