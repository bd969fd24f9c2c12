#include "workbench/run/recording_figures.hpp"

#include <algorithm>

namespace waymark {

StepTimes step_times(const std::vector<Recording::TimedCost>& steps) {
  if (steps.empty()) return {};
  std::vector<double> us;
  us.reserve(steps.size());
  double sum = 0.0;
  for (const auto& step : steps) sum += us.emplace_back(1e6 * to_seconds(step.cpu));
  std::ranges::sort(us);
  const auto quantile = [&us](double q) {
    return us[std::min(us.size() - 1, static_cast<std::size_t>(q * static_cast<double>(us.size())))];
  };
  return {sum / static_cast<double>(us.size()), quantile(0.5), quantile(0.99), quantile(0.999), us.back()};
}

std::int64_t deadline_misses(const Recording& recording) {
  if (!recording.frame_budget) return 0;
  return std::ranges::count_if(recording.steps,
                               [&](const auto& step) { return step.cpu > *recording.frame_budget; });
}

std::optional<double> nis_per_dof(const std::vector<Recording::TimedInnovation>& innovations) {
  double nis = 0.0;
  double dof = 0.0;
  for (const auto& [stamp, innovation] : innovations) {
    if (innovation.outcome != Outcome::kMatched) continue;
    nis += innovation.nis;
    dof += innovation.dof;
  }
  return dof > 0.0 ? std::optional(nis / dof) : std::nullopt;
}

}  // namespace waymark
