#include "waymark/association/association_options.hpp"

#include <algorithm>
#include <cmath>

namespace waymark {
namespace {

// A sensor without limits would leave clutter without density.
constexpr double kMinViewVolume = 1e-3;

// Of a sensor that does not say.
constexpr double kUsuallyDetected = 0.9;

}  // namespace

AssociationModel::AssociationModel(const AssociationOptions& options, const LandmarkSensor& sensor)
    : options_(options),
      detected_(sensor.detection_probability > 0.0 ? sensor.detection_probability : kUsuallyDetected),
      seen_(std::log(detected_ / options.false_alarm_probability)),
      missed_(std::log((1.0 - detected_) / (1.0 - options.false_alarm_probability))) {
  const double volume =
      (sensor.max_range_m - sensor.min_range_m) * to_radians(std::min(sensor.field_of_view_deg, 360.0));
  clutter_density_ = options.clutter_per_scan / std::max(volume, kMinViewVolume);
}

double AssociationModel::log_density_of_others(double range_m) const {
  return std::log(clutter_density_ + options_.landmarks_per_m2 * range_m);
}

double AssociationModel::log_odds_of_observation(double existence_probability) const {
  const double q = existence_probability * detected_;
  return std::log(q / (1.0 - q));
}

}  // namespace waymark
