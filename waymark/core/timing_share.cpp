#include "waymark/core/timing_share.hpp"

#include <algorithm>
#include <cmath>

namespace waymark {
namespace {

constexpr double kReading_ns = 50.0;  // of a slow machine's monotonic clock
constexpr double kMaxCost = 0.005;    // of what is measured
constexpr double kMaxPassedOver = 63.0;

}  // namespace

void TimingShare::took(Duration spent, int readings) {
  ++timed_;
  total_ += spent;
  const double mean_ns = static_cast<double>(total_.count()) / static_cast<double>(timed_);
  const double runs = kReading_ns * readings / (kMaxCost * std::max(mean_ns, 1.0));
  const double most = 2.0 * std::min(std::max(runs - 1.0, 0.0), kMaxPassedOver);
  random_ = random_ * 1664525U + 1013904223U;  // Numerical Recipes; its upper bits are good
  pass_over_ = static_cast<int>(std::floor(static_cast<double>(random_ >> 8) * 0x1p-24 * (most + 1.0)));
  passed_over_ = 0;
}

}  // namespace waymark
