#include "workbench/live/latency.hpp"

#include <algorithm>
#include <cmath>

namespace waymark::live {
namespace {

constexpr double kLeast_s = 1e-6;
constexpr double kLargest_s = 100.0;
constexpr double kBin = 1.02;
constexpr std::size_t kMostSeen = 256;

}  // namespace

LatencyHistogram::LatencyHistogram() : bins_(bin_of(kLargest_s) + 1, 0) {}

std::size_t LatencyHistogram::bin_of(double time_s) {
  const double clamped_s = std::clamp(time_s, kLeast_s, kLargest_s);
  return static_cast<std::size_t>(std::log(clamped_s / kLeast_s) / std::log(kBin));
}

void LatencyHistogram::add(double time_s) {
  ++bins_[bin_of(time_s)];
  ++count_;
  max_s_ = std::max(max_s_, time_s);
}

double LatencyHistogram::quantile_s(double part) const {
  if (count_ == 0) return 0.0;
  std::int64_t below = 0;
  for (std::size_t bin = 0; bin < bins_.size(); ++bin) {
    below += bins_[bin];
    if (static_cast<double>(below) >= part * static_cast<double>(count_))
      return std::min(max_s_, kLeast_s * std::pow(kBin, static_cast<double>(bin + 1)));
  }
  return max_s_;
}

std::int64_t LatencyHistogram::count_above(double time_s) const {
  std::int64_t above = 0;
  for (std::size_t bin = bin_of(time_s) + 1; bin < bins_.size(); ++bin) above += bins_[bin];
  return above;
}

void CorrectionLatency::keep(std::deque<Seen>& seen, Stamp stamp, Stamp arrived) {
  seen.push_back({stamp, arrived});
  if (seen.size() > kMostSeen) seen.pop_front();
}

void CorrectionLatency::odometry_arrived(Stamp stamp, Stamp arrived) { keep(odometry_, stamp, arrived); }

void CorrectionLatency::observation_arrived(Stamp stamp, Stamp arrived) {
  keep(observations_, stamp, arrived);
}

void CorrectionLatency::corrected(Stamp stamp, Stamp now) {
  const auto observed = std::ranges::find(observations_, stamp, &Seen::stamp);
  if (observed == observations_.end()) return;
  const auto after =
      std::ranges::find_if(odometry_, [stamp](const Seen& each) { return each.stamp >= stamp; });
  const Stamp both =
      after == odometry_.end() ? observed->arrived : std::max(observed->arrived, after->arrived);
  waits_.add(to_seconds(both - observed->arrived));
  latencies_.add(to_seconds(now - both));
  observations_.erase(observations_.begin(), observed + 1);
}

}  // namespace waymark::live
