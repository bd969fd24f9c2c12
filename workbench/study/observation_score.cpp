#include "workbench/study/observation_score.hpp"

#include <algorithm>
#include <cmath>

#include "waymark/core/angle.hpp"

namespace waymark::study {
namespace {

constexpr double kOutliers = 0.01;

double log_sum(double a, double b) {
  const double larger = std::max(a, b);
  return larger + std::log1p(std::exp(std::min(a, b) - larger));
}

}  // namespace

double log_likelihood(const Innovation& innovation, double log_field_density) {
  if (innovation.dof == 0) return log_field_density;
  return log_sum(std::log1p(-kOutliers) + innovation.log_density, std::log(kOutliers) + log_field_density);
}

double log_field_density(const Config& config, double longest_range_m) {
  const double log_range = std::log(longest_range_m);
  const double log_bearing = std::log(2.0 * kPi);
  switch (config.observe) {
    case Observe::kRangeBearing:
    case Observe::kMarkers:
      return -log_range - log_bearing;
    case Observe::kRange:
      return -log_range;
    case Observe::kBearing:
      return -log_bearing;
    case Observe::kPixel:
      return -std::log(static_cast<double>(config.camera.width_px) * config.camera.height_px);
  }
  return 0.0;
}

}  // namespace waymark::study
