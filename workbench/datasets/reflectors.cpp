#include "workbench/datasets/reflectors.hpp"

#include <algorithm>

#include "waymark/core/angle.hpp"

namespace waymark {
namespace {

constexpr Eigen::Index kLongestGap = 1;
constexpr double kNearest_m = 0.5;
constexpr double kFarthest_m = 75.0;

double median(std::vector<double> values) {
  const auto middle = values.begin() + std::ssize(values) / 2;
  std::ranges::nth_element(values, middle);
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

/// Neighbouring bright beams.
struct BrightRun {
  std::vector<double> ranges_m;
  double beams = 0.0;  ///< sum of their numbers
  Eigen::Index last = 0;
};

std::vector<BrightRun> bright_runs(const Eigen::VectorXd& ranges_m, const Eigen::VectorXd& intensities) {
  std::vector<BrightRun> runs;
  for (Eigen::Index beam = 0; beam < ranges_m.size(); ++beam) {
    const bool in_range = ranges_m(beam) >= kNearest_m && ranges_m(beam) < kFarthest_m;
    if (intensities(beam) <= 0.0 || !in_range) continue;
    if (runs.empty() || beam - runs.back().last > kLongestGap + 1) runs.emplace_back();
    BrightRun& run = runs.back();
    run.ranges_m.push_back(ranges_m(beam));
    run.beams += static_cast<double>(beam);
    run.last = beam;
  }
  return runs;
}

}  // namespace

std::vector<RangeBearing> find_reflectors(const Eigen::VectorXd& ranges_m,
                                          const Eigen::VectorXd& intensities) {
  const double beam_rad = kPi / static_cast<double>(ranges_m.size() - 1);
  std::vector<RangeBearing> reflectors;
  for (const BrightRun& run : bright_runs(ranges_m, intensities)) {
    const double middle = run.beams / static_cast<double>(run.ranges_m.size());
    reflectors.push_back({median(run.ranges_m), middle * beam_rad - 0.5 * kPi});
  }
  return reflectors;
}

}  // namespace waymark
