#include "workbench/live/stream_state.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace waymark::live {
namespace {

constexpr double kLeastAge_s = 1e-5;
constexpr double kAgesPerOctave = 4.0;

}  // namespace

StreamState::StreamState(std::string name) { summary_.name = std::move(name); }

void StreamState::count_arrival(Stamp stamp, Stamp arrived, bool is_motion) {
  const std::lock_guard lock(mutex_);
  summary_.brings_motion |= is_motion;
  ++summary_.received;
  summary_.fault.clear();
  const double age_s = std::max(to_seconds(arrived - stamp), kLeastAge_s);
  const auto bin = static_cast<std::size_t>(kAgesPerOctave * std::log2(age_s / kLeastAge_s));
  ++ages_[std::min(bin, kAges - 1)];
  if (last_arrival_) {
    const double period_s = to_seconds(arrived - *last_arrival_);
    period_s_ = period_s_ ? 0.9 * *period_s_ + 0.1 * period_s : period_s;
  }
  last_arrival_ = arrived;
}

void StreamState::count_bad(std::int64_t count) {
  const std::lock_guard lock(mutex_);
  summary_.bad += count;
}

void StreamState::count_lost(std::int64_t count) {
  const std::lock_guard lock(mutex_);
  summary_.lost += count;
}

void StreamState::count_replaced() {
  const std::lock_guard lock(mutex_);
  ++summary_.replaced;
}

void StreamState::count_dropped() {
  const std::lock_guard lock(mutex_);
  ++summary_.dropped;
}

void StreamState::set_clock_steps(int steps) {
  const std::lock_guard lock(mutex_);
  summary_.clock_steps = steps;
}

void StreamState::fail(std::string fault) {
  const std::lock_guard lock(mutex_);
  summary_.fault = std::move(fault);
}

void StreamState::connect() {
  const std::lock_guard lock(mutex_);
  summary_.reconnects += was_connected_ ? 1 : 0;
  was_connected_ = true;
  summary_.fault.clear();
}

void StreamState::end() {
  const std::lock_guard lock(mutex_);
  summary_.ended = true;
}

StreamSummary StreamState::summary(Stamp now) const {
  const std::lock_guard lock(mutex_);
  StreamSummary summary = summary_;
  summary.rate_hz = period_s_ && *period_s_ > 0.0 ? 1.0 / *period_s_ : 0.0;
  summary.age_p50_s = age_quantile_s(0.5);
  summary.age_p99_s = age_quantile_s(0.99);
  if (last_arrival_) summary.silent_s = to_seconds(now - *last_arrival_);
  return summary;
}

bool StreamState::has_ended() const {
  const std::lock_guard lock(mutex_);
  return summary_.ended;
}

/// The upper end of the bin that it lies in.
double StreamState::age_quantile_s(double part) const {
  const auto total = std::accumulate(ages_.begin(), ages_.end(), std::int64_t{0});
  if (total == 0) return 0.0;
  std::int64_t below = 0;
  std::size_t bin = 0;
  for (; bin + 1 < kAges; ++bin) {
    below += ages_[bin];
    if (static_cast<double>(below) >= part * static_cast<double>(total)) break;
  }
  return kLeastAge_s * std::exp2(static_cast<double>(bin + 1) / kAgesPerOctave);
}

}  // namespace waymark::live
