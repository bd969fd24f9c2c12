#include "waymark/slam/jump_filter.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>

#include "waymark/core/angle.hpp"

namespace waymark {
namespace {

const ReadingStep kClose(0.05, 0.05, 0.1);          // m, m, rad
const ReadingStep kAcceleration(10.0, 10.0, 20.0);  // m/s^2, m/s^2, rad/s^2
const ReadingStep kAtOnce(1.0, 1.0, 2.0);           // m/s, m/s, rad/s
constexpr double kWindow_s = 0.25;
constexpr double kGoesOn_s = 2.0;
constexpr Duration kReturns = std::chrono::seconds(5);  // how long readings may be far off and come back

const Eigen::Array2d kSpeedAtOnce(1.0, 3.0);  // m/s, rad/s
const Eigen::Array2d kSpeedAtFirst(50.0, 30.0);
constexpr int kBelieved = 3;  // readings in a row

Pose2 shifted(const Pose2& shift, const Pose2& raw) { return shift * raw; }
WheelAngles shifted(const WheelAngles& shift, const WheelAngles& raw) {
  return {shift.left_rad + raw.left_rad, shift.right_rad + raw.right_rad};
}

Pose2 shift_between(const Pose2& raw, const Pose2& value) { return value * raw.inverse(); }
WheelAngles shift_between(const WheelAngles& raw, const WheelAngles& value) {
  return {value.left_rad - raw.left_rad, value.right_rad - raw.right_rad};
}

ReadingStep size_of(const Pose2& from, const Pose2& to, const Eigen::Array2d&) {
  const Pose2 moved = from.inverse() * to;
  return {moved.x_m, moved.y_m, moved.theta_rad};
}
ReadingStep size_of(const WheelAngles& from, const WheelAngles& to, const Eigen::Array2d& radius_m) {
  return {radius_m[0] * (to.left_rad - from.left_rad), radius_m[1] * (to.right_rad - from.right_rad), 0.0};
}

Pose2 after(const Pose2& from, const ReadingStep& size, const Eigen::Array2d&) {
  return from * Pose2{size[0], size[1], wrap_angle(size[2])};
}
WheelAngles after(const WheelAngles& from, const ReadingStep& size, const Eigen::Array2d& radius_m) {
  return {from.left_rad + size[0] / radius_m[0], from.right_rad + size[1] / radius_m[1]};
}

Eigen::Array2d angles(const WheelAngles& raw) { return {raw.left_rad, raw.right_rad}; }
/// Poses have no range.
Eigen::Array2d angles(const Pose2&) { return Eigen::Array2d::Zero(); }

/// What an angle wraps by that was between these so far and is `raw` now: a turn, or the range of a binary
/// counter. Empty: most of neither was seen.
std::optional<double> wraps_by(double lowest, double highest, double raw) {
  constexpr double kTurn = 2.0 * kPi;
  constexpr double kSlack = 0.01;
  constexpr double kSmallestCounter = 256.0;
  const auto all_within = [&](double least, double most) {
    return std::min(lowest, raw) >= least - kSlack && std::max(highest, raw) <= most + kSlack;
  };
  if (all_within(-kPi, kPi)) return kTurn;
  const double range = highest - lowest;
  const bool is_turn = all_within(0.0, kTurn);
  const double whole = is_turn ? kTurn : std::exp2(std::ceil(std::log2(range)));
  const bool is_known = range >= 0.75 * whole && (is_turn || whole >= kSmallestCounter);
  return is_known ? std::optional(whole) : std::nullopt;
}

bool agree(const Eigen::Array2d& a, const Eigen::Array2d& b) {
  return ((a - b).abs() <= 0.5 * b.abs() + kSpeedAtOnce).all();
}

}  // namespace

template <class Value>
auto JumpFilter<Value>::reading(Stamp stamp, const Value& raw, const std::optional<Value>& shift) const
    -> Reading {
  return {stamp, raw, shift ? shifted(*shift, raw) : raw, shift};
}

template <class Value>
auto JumpFilter<Value>::step(const Reading& from, const Reading& to) const -> Step {
  return {size_of(from.value, to.value, radius_m_), to_seconds(to.stamp - from.stamp)};
}

template <class Value>
ReadingStep JumpFilter<Value>::expected(double duration_s) const {
  const auto& [size, over_s] = closed_.sum;
  return over_s > 0.0 ? ReadingStep(duration_s / over_s * size) : size;
}

template <class Value>
ReadingStep JumpFilter<Value>::tolerance(double duration_s) const {
  return kClose + 2.0 * open_.largest.max(closed_.largest) +
         (kAcceleration * duration_s * duration_s).min((2.0 * fastest_).max(kAtOnce) * duration_s);
}

template <class Value>
bool JumpFilter<Value>::is_possible(const Step& step) const {
  return ((step.size - expected(step.duration_s)).abs() <= tolerance(step.duration_s)).all();
}

/// Whether the step goes on at the speed of the one on trial.
template <class Value>
bool JumpFilter<Value>::goes_on(const Step& step) const {
  if (!trial_ || !trial_->step || trial_->step->duration_s <= 0.0) return false;
  const ReadingStep same = step.duration_s / trial_->step->duration_s * trial_->step->size;
  return ((step.size - same).abs() <= 0.5 * same.abs() + tolerance(step.duration_s)).all();
}

/// By how much the wheels go on in a raw reading that wrapped; empty: none did.
template <class Value>
std::optional<Value> JumpFilter<Value>::unwrapping(const Value& raw, double duration_s) const {
  if constexpr (std::is_same_v<Value, WheelAngles>) {
    const Eigen::Array2d change = angles(raw) - angles(last_->raw);
    Eigen::Array2d missing = Eigen::Array2d::Zero();
    for (const int wheel : {0, 1})
      if (const auto range = wraps_by(lowest_[wheel], highest_[wheel], angles(raw)[wheel]);
          range && std::abs(change[wheel]) > 0.5 * *range)
        missing[wheel] = -std::copysign(*range, change[wheel]);
    if (missing.isZero(0.0)) return std::nullopt;
    const WheelAngles whole{missing[0], missing[1]};
    const auto shift = last_->shift ? shifted(*last_->shift, whole) : whole;
    const bool possible = is_possible({size_of(last_->value, shifted(shift, raw), radius_m_), duration_s});
    return possible ? std::optional(shift) : std::nullopt;
  }
  return std::nullopt;
}

template <class Value>
auto JumpFilter<Value>::judge(Stamp stamp, const Value& raw) const -> Judgement {
  if (!last_) return {Kind::kPossible, reading(stamp, raw, std::nullopt), {}};
  const Reading here = reading(stamp, raw, last_->shift);
  const Step told = step(*last_, here);
  if (const auto shift = unwrapping(raw, told.duration_s))
    return {Kind::kWrap, reading(stamp, raw, shift), told};
  if (is_possible(told)) return {Kind::kPossible, here, told};
  if (trial_ && stamp - trial_->before.stamp <= kReturns) {
    const Reading back = reading(stamp, raw, trial_->before.shift);
    if (is_possible(step(trial_->before, back))) return {Kind::kReturn, back, told};
  }
  if (goes_on(told)) return {Kind::kFast, reading(stamp, raw, trial_->before_step.shift), told};
  const Value moved_on = after(last_->value, expected(std::min(told.duration_s, kGoesOn_s)), radius_m_);
  return {Kind::kReset, {stamp, raw, moved_on, shift_between(raw, moved_on)}, told};
}

template <class Value>
auto JumpFilter<Value>::continued(Stamp stamp, const Value& raw) const -> Continued {
  const Judgement judged = judge(stamp, raw);
  if (judged.kind != Kind::kReset) return {judged.reading.value};
  return {judged.reading.value, fastest_ * judged.step.duration_s};
}

template <class Value>
const Value& JumpFilter<Value>::add(Stamp stamp, const Value& raw) {
  const Judgement judged = judge(stamp, raw);
  lowest_ = last_ ? lowest_.min(angles(raw)) : angles(raw);
  highest_ = last_ ? highest_.max(angles(raw)) : angles(raw);
  if (last_) settle(judged);
  last_ = judged.reading;
  return last_->value;
}

/// Counts what a reading is, and what it makes of those before.
template <class Value>
void JumpFilter<Value>::settle(const Judgement& judged) {
  const Stamp stamp = judged.reading.stamp;
  if (trial_) ++trial_->readings;
  switch (judged.kind) {
    case Kind::kWrap:
      jumps_.wraps.add(stamp);
      [[fallthrough]];
    case Kind::kPossible:
      learn(step(*last_, judged.reading));
      if (trial_) trial_->step.reset();
      break;
    case Kind::kReturn:
      jumps_.resets = trial_->resets;
      jumps_.outliers.add(trial_->first, trial_->readings - 1);
      trial_.reset();
      break;
    case Kind::kFast:
      jumps_.resets = trial_->resets_before;
      learn(*trial_->step);
      learn(judged.step);
      trial_.reset();
      break;
    case Kind::kReset:
      if (!trial_ || stamp - trial_->before.stamp > kReturns)
        trial_ = {.before = *last_, .first = stamp, .resets = jumps_.resets, .readings = 1};
      trial_->before_step = *last_;
      trial_->resets_before = jumps_.resets;
      trial_->step = judged.step;
      jumps_.resets.add(stamp);
      break;
  }
}

template <class Value>
void JumpFilter<Value>::learn(const Step& step) {
  open_.sum.size += step.size;
  open_.sum.duration_s += step.duration_s;
  open_.largest = open_.largest.max(step.size.abs());
  if (open_.sum.duration_s < kWindow_s) return;
  closed_ = std::exchange(open_, {});
  fastest_ = fastest_.max(expected(1.0).abs());
}

template class JumpFilter<WheelAngles>;
template class JumpFilter<Pose2>;

bool SpeedFilter::accept(Stamp stamp, const Eigen::Array2d& speed) {
  const bool is_possible = last_ ? ((speed - *last_).abs() <= kSpeedAtOnce + 2.0 * fastest_).all()
                                 : (speed.abs() <= kSpeedAtFirst).all();
  if (is_possible) {
    suspects_ = 0;
    trust(speed);
    return true;
  }
  if (suspects_ == 0 || !agree(speed, suspect_)) {
    suspects_ = 0;
    before_ = jumps_;
  }
  suspect_ = speed;
  jumps_.outliers.add(stamp);
  if (++suspects_ < kBelieved) return false;
  jumps_ = before_;
  suspects_ = 0;
  trust(speed);
  return true;
}

void SpeedFilter::trust(const Eigen::Array2d& speed) {
  last_ = speed;
  fastest_ = fastest_.max(speed.abs());
}

}  // namespace waymark
