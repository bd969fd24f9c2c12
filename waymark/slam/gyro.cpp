#include "waymark/slam/gyro.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "waymark/core/angle.hpp"

namespace waymark {
namespace {

constexpr double square(double value) { return value * value; }

// Of MEMS gyros, by their data sheets (MPU-6050, BMI088, ICM-20602, LSM6DS3): white noise of 0.004 to 0.03
// degrees per second and root Hz; a zero rate that drifts by 0.02 degrees per second and kelvin, so by 0.2
// over ten kelvins since its driver zeroed it, and by 0.01 in a minute. One that was never zeroed is off by
// up to 6 degrees per second.
const double kNoise_rad2_per_s = square(to_radians(0.03));
const double kLeastNoise_rad2_per_s = square(to_radians(0.004));
const double kBiasVar = square(to_radians(0.2));
const double kBiasWalkVar_per_s = square(to_radians(0.01)) / 60.0;
constexpr double kLargestBias_radps = 0.1;

constexpr double kCompareOver_s = 0.5;
constexpr double kApart_rad = 0.1;
constexpr double kApartSigmas = 4.0;
// In a window: a turn, which no bias makes alone, and none.
constexpr double kTurns_rad = kLargestBias_radps * kCompareOver_s;
constexpr double kStraight_rad = 0.01;
const double kStandingBelow_radps = StandingOptions{}.below_radps;
// Enough to tell signs and units apart, whatever the noise.
constexpr double kTrial_rad = 0.3;
constexpr double kTrialAlone_rad = 0.5;
// A live gyro hardly repeats a reading ten times: its noise is some of its steps.
constexpr int kStuckRepeats = 10;
// Readings by which the usual noise counts.
constexpr double kPriorReadings = 10.0;

/// What makes rates in rad/s of those that turn so far per turn, by sign and by unit; half as far and twice
/// as far leave room for wheels that slip.
std::optional<double> factor_of(double ratio) {
  for (const double unit : {1.0, kPi / 180.0})
    if (const double turn = unit * std::abs(ratio); turn > 0.5 && turn < 2.0)
      return std::copysign(unit, ratio);
  return std::nullopt;
}

}  // namespace

Gyro::Gyro(ArcModel arc, Duration max_hold)
    : arc_(arc), track_(max_hold), bias_var_(kBiasVar), noise_rad2_per_s_(kNoise_rad2_per_s) {}

Gyro::Turns& Gyro::Turns::operator+=(const Turns& more) {
  gyro_rad += more.gyro_rad;
  odometry_rad += more.odometry_rad;
  odometry_var_rad2 += more.odometry_var_rad2;
  moved_m += more.moved_m;
  duration_s += more.duration_s;
  return *this;
}

/// An encoder that trembles by a tick, and rounded poses, are no motion.
bool Gyro::Turns::stands() const {
  return moved_m <= 2e-3 * duration_s && std::abs(odometry_rad) <= 2e-3 * duration_s;
}

double Gyro::unbiased(const Turns& turns) const { return turns.gyro_rad - bias_radps_ * turns.duration_s; }

double Gyro::apart(const Turns& turns) const { return unbiased(turns) - turns.odometry_rad; }

double Gyro::variance(const Turns& turns) const {
  return turns.odometry_var_rad2 + noise_rad2_per_s_ * turns.duration_s +
         (bias_var_ + kBiasWalkVar_per_s * since_learnt_s_) * square(turns.duration_s);
}

bool Gyro::contradict(const Turns& turns) const {
  return std::abs(apart(turns)) > kApart_rad + kApartSigmas * std::sqrt(variance(turns));
}

/// By someone, while its wheels stand.
bool Gyro::is_turned(const Turns& turns) const {
  return std::abs(unbiased(turns)) > kStandingBelow_radps * turns.duration_s +
                                         kApartSigmas * std::sqrt(noise_rad2_per_s_ * turns.duration_s);
}

/// Of the gyro's turn in a step: what the variance of the whole turn since the bias was learnt, N t + B t^2 +
/// W t^3 / 3, grows by, so that it is right for the heading although steps are taken as independent.
double Gyro::step_variance(double dt_s) const {
  const double t = since_learnt_s_;
  return dt_s * (noise_rad2_per_s_ + 2.0 * bias_var_ * t + kBiasWalkVar_per_s * t * t);
}

void Gyro::add(Stamp stamp, YawRate rate) {
  const bool repeats = last_stamp_ && rate.w_radps == last_radps_;
  repeats_ = repeats ? repeats_ + 1 : 0;
  if (!repeats) {
    findings_.is_constant = !last_stamp_.has_value();
    since_change_ = {};
    held_rad_ = 0.0;
    is_stuck_ = false;
  }
  if (last_stamp_ && stood_ > 2) learn_noise(stamp, findings_.factor * (rate.w_radps - last_radps_));
  ++findings_.readings;
  last_stamp_ = stamp;
  last_radps_ = rate.w_radps;
  track_.add(stamp, rate);
}

/// By the differences of readings, which have no bias.
void Gyro::learn_noise(Stamp stamp, double change_radps) {
  const double told = 0.5 * square(change_radps) * to_seconds(stamp - *last_stamp_);
  const double count = kPriorReadings + noise_readings_++;
  noise_rad2_per_s_ = std::max(kLeastNoise_rad2_per_s, (count * noise_rad2_per_s_ + told) / (count + 1.0));
}

Motion Gyro::hold_heading(const Motion& odometry, const Step& step, const Event* next) {
  const auto told_rad = track_.turn_rad(step.from, step.to, next);
  const double dt_s = to_seconds(step.to - step.from);
  if (!told_rad || dt_s <= 0.0) return odometry;
  since_learnt_s_ += dt_s;
  const Turns turns{findings_.factor * *told_rad, odometry.increment.theta_rad, odometry.covariance(2, 2),
                    odometry.increment.position().norm(), dt_s};
  const bool was_believed = findings_.is_believed;
  if (!step.is_measured) return was_believed ? held(odometry, turns, 1.0) : odometry;
  window_ += turns;
  since_change_ += turns;
  const double gain = gain_of(turns);
  notice_stuck(step.from);
  if (window_.duration_s >= kCompareOver_s) close_window(step.from);
  return held(odometry, turns, was_believed && !is_stuck_ ? gain : 0.0);
}

/// The part that the gyro has in the turn of a step. One that stands has the odometry's, which is zero.
double Gyro::gain_of(const Turns& turns) const {
  if (turns.stands()) return is_turned(turns) ? 1.0 : 0.0;
  if (!findings_.odometry_turns || slips_ || contradict(window_)) return 1.0;
  return turns.odometry_var_rad2 / (turns.odometry_var_rad2 + step_variance(turns.duration_s));
}

Motion Gyro::held(const Motion& odometry, const Turns& turns, double gain) {
  const double more_rad = gain * apart(turns);
  held_rad_ += more_rad;
  const Pose2 made_up{0.0, 0.0, std::exchange(owed_rad_, 0.0)};
  Motion motion = odometry;
  if (gain > 0.0)
    motion = turned_as_measured(odometry, turns.odometry_rad + more_rad,
                                gain * step_variance(turns.duration_s), arc_);
  motion.increment = made_up.theta_rad == 0.0 ? motion.increment : motion.increment * made_up;
  motion.covariance(2, 2) += square(made_up.theta_rad);  // landmarks may have mended some of it
  return motion;
}

/// What was held since the reading repeats itself was wrong.
void Gyro::notice_stuck(Stamp stamp) {
  if (is_stuck_ || !findings_.is_believed || repeats_ < kStuckRepeats) return;
  const double apart_rad = std::abs(apart(since_change_));
  if (!contradict(since_change_) || apart_rad < 0.5 * std::abs(since_change_.odometry_rad)) return;
  is_stuck_ = true;
  findings_.stuck.add(stamp);
  owed_rad_ -= held_rad_;
}

void Gyro::close_window(Stamp stamp) {
  const bool slips = findings_.is_believed && findings_.odometry_turns && !is_stuck_ && contradict(window_);
  if (slips && !slips_) findings_.slips.add(stamp);
  slips_ = slips;
  stood_ = window_.stands() ? stood_ + 1 : 0;
  // Readings of both may be late: what counts has stood before and after.
  if (stood_ > 2) learn_standing(last_window_);
  if (!findings_.has_stood && stood_ == 0 && std::abs(window_.odometry_rad) < kStraight_rad) learn(window_);
  last_window_ = window_;
  if (!findings_.is_believed) put_on_trial(window_);
  window_ = {};
}

void Gyro::learn_standing(const Turns& turns) {
  const double most_radps = findings_.has_stood ? kStandingBelow_radps : kLargestBias_radps;
  if (std::abs(apart(turns)) > most_radps * turns.duration_s) return;  // someone turns the robot
  bias_var_ += kBiasWalkVar_per_s * since_learnt_s_;
  learn(turns);
  findings_.has_stood = true;
  since_learnt_s_ = 0.0;
}

/// One step of a Kalman filter whose state is the bias.
void Gyro::learn(const Turns& turns) {
  const double dt_s = turns.duration_s;
  if (std::abs(apart(turns)) > kLargestBias_radps * dt_s) return;
  const double R = (turns.odometry_var_rad2 + noise_rad2_per_s_ * dt_s) / square(dt_s);
  const double K = bias_var_ / (bias_var_ + R);
  bias_radps_ += K * apart(turns) / dt_s;
  bias_var_ *= 1.0 - K;
}

void Gyro::put_on_trial(const Turns& turns) {
  const double gyro_rad = unbiased(turns);
  if (turns.stands() && !is_turned(turns)) return;
  if (std::abs(turns.odometry_rad) > kStraight_rad) {
    trial_.turned_rad += std::abs(turns.odometry_rad);
    trial_.products_rad2 += gyro_rad * turns.odometry_rad;
    trial_.squares_rad2 += square(turns.odometry_rad);
  } else if (std::abs(gyro_rad) > kTurns_rad) {
    trial_.alone += turns;
    trial_.alone_rad += std::abs(gyro_rad);
  }
  if (trial_.turned_rad >= kTrial_rad) {
    findings_.ratio = trial_.products_rad2 / trial_.squares_rad2;
    if (const auto factor = factor_of(*findings_.ratio)) believe(*factor);
  } else if (trial_.turned_rad == 0.0 && trial_.alone_rad >= kTrialAlone_rad) {
    findings_.odometry_turns = false;
    believe(1.0);
  }
}

/// The odometry stated how unsure its turns are, so a filter has made up for them by now, unless it told
/// none.
void Gyro::believe(double factor) {
  findings_.is_believed = true;
  findings_.factor = factor;
  bias_radps_ *= factor;
  bias_var_ = findings_.has_stood ? square(factor) * bias_var_ : bias_var_;
  if (noise_readings_ > 0) noise_rad2_per_s_ *= square(factor);
  for (Turns* turns : {&trial_.alone, &last_window_, &since_change_}) turns->gyro_rad *= factor;
  if (!findings_.odometry_turns) owed_rad_ = apart(trial_.alone);
}

GyroFindings Gyro::findings() const {
  GyroFindings findings = findings_;
  findings.bias_radps = bias_radps_;
  findings.bias_sigma_radps = std::sqrt(bias_var_ + kBiasWalkVar_per_s * since_learnt_s_);
  return findings;
}

}  // namespace waymark
