#include "waymark/vision/frame_budget.hpp"

#include <algorithm>
#include <cmath>

#include "waymark/core/function_blocks.hpp"

namespace waymark::vision {
namespace {

double nanoseconds(Duration d) { return static_cast<double>(d.count()); }

Duration duration_from_nanoseconds(double ns) { return Duration(std::llround(ns)); }

}  // namespace

WorkCosts work_costs(kernels::Instructions instructions) {
  if (instructions == kernels::Instructions::kSimd) return {};
  return {.window_ns = 450.0, .peak_ns = 9.0 * 450.0, .pixel_ns = 40.0};
}

void FrameBudget::start(Duration most) {
  left_ns_ = nanoseconds(most);
  refused_ns_ = 0.0;
  if (kind_ == BudgetKind::kClock) last_ = thread_cpu_time();
}

bool FrameBudget::allows(double cost_ns) {
  double needed_ns = cost_ns;
  if (kind_ == BudgetKind::kClock) {
    const Duration now = thread_cpu_time();
    left_ns_ -= nanoseconds(now - last_);
    last_ = now;
    needed_ns *= ns_per_cost_;
  }
  const bool allowed = needed_ns <= left_ns_;
  if (!allowed && refused_ns_ == 0.0) refused_ns_ = needed_ns;
  return allowed;
}

Duration FrameBudget::left() const { return duration_from_nanoseconds(std::max(left_ns_, 0.0)); }

Duration FrameBudget::refused() const { return duration_from_nanoseconds(refused_ns_); }

void FrameBudget::spend(double cost_ns) {
  if (kind_ == BudgetKind::kWork) {
    left_ns_ -= cost_ns;
    return;
  }
  // Rises at once and falls slowly: the next step may be as dear as the dearest.
  constexpr double kFall = 0.05;
  const Duration now = thread_cpu_time();
  const double taken_ns = nanoseconds(now - last_), ns_per_cost = taken_ns / cost_ns;
  left_ns_ -= taken_ns;
  last_ = now;
  ns_per_cost_ += (ns_per_cost > ns_per_cost_ ? 1.0 : kFall) * (ns_per_cost - ns_per_cost_);
}

}  // namespace waymark::vision
