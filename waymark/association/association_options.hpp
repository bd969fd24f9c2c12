#pragma once

#include <algorithm>

#include "waymark/models/landmark_sensor.hpp"

namespace waymark {

/// Assumptions for data association of observations of unknown identity.
struct AssociationOptions {
  double false_alarm_probability = 0.02;  ///< Pfa: that something else is taken for it
  double clutter_per_scan = 1.0;          ///< observations of nothing
  double landmarks_per_m2 = 0.1;          ///< still unknown ones in a place not seen before
};

/// From these log-odds of existence on a landmark counts in the map.
inline constexpr double kConfirmedLogOdds = 6.0;
/// Observations do not raise the log-odds of existence above this.
inline constexpr double kMaxLogOdds = 12.0;
/// A landmark that was never confirmed is removed after this distance without an observation.
inline constexpr double kTentativeDistance_m = 5.0;

/// Parameters of data association. The log-odds of a landmark's existence start at 0, grow by log(Pd / Pfa)
/// when it is observed and change by log((1 - Pd) / (1 - Pfa)) when it should have been but was not;
/// below 0 the landmark is removed. Pd is the detection probability of the sensor, or 0.9 if that is
/// unknown.
class AssociationModel {
 public:
  AssociationModel(const AssociationOptions& options, const LandmarkSensor& sensor);

  [[nodiscard]] double seen() const { return seen_; }
  [[nodiscard]] double missed() const { return missed_; }
  /// The log-odds after an observation: at least those of a landmark that has just been met.
  [[nodiscard]] double after_observation(double log_odds) const {
    return log_odds < 0.0 ? 0.0 : std::min(kMaxLogOdds, log_odds + seen_);
  }

  /// Density of landmarks that are not known yet, per m^2.
  [[nodiscard]] double landmarks_per_m2() const { return options_.landmarks_per_m2; }

  /// log of the density, per metre of range and radian of bearing, of observations of nothing known: clutter
  /// is even over range and bearing, unknown landmarks over the ground.
  [[nodiscard]] double log_density_of_others(double range_m) const;

  /// log(q / (1 - q)), q the chance that a landmark is both there and seen.
  [[nodiscard]] double log_odds_of_observation(double existence_probability) const;

 private:
  AssociationOptions options_;
  double detected_;
  double seen_;
  double missed_;
  double clutter_density_;
};

}  // namespace waymark
