#pragma once

#include <optional>

#include "waymark/core/observation.hpp"
#include "waymark/fastslam/belief.hpp"
#include "waymark/kernels/particle_existence.hpp"
#include "waymark/kernels/particle_observations.hpp"
#include "waymark/models/landmark_sensor.hpp"

namespace waymark::fastslam {

/// The kind of a measurement; nothing for one that particles cannot use.
[[nodiscard]] std::optional<kernels::ObservationKind> kind_of(const Measurement& value);

/// Of how many numbers such a measurement is.
[[nodiscard]] int dimension(kernels::ObservationKind kind);

/// Whether an observation brings what must be there before anything else is asked: a kind that particles can
/// use, numbers that are finite as floats, and noise.
[[nodiscard]] bool is_usable(const Observation& observation);

/// Observations of a landmark that are nearer to each other than this are as good as one.
inline constexpr double kMinTravelled_m = 1e-3;

/// Ratio by which a Gauss-Markov bias counts for more than white noise of its variance. The bias decays by
/// exp(-w / l) over a distance w, l = `bias_distance_m`. Observations a distance w apart then bring the
/// information of independent ones of coth(w / (2 l)) times the variance.
[[nodiscard]] double bias_variance_factor(double travelled_since_m, double bias_distance_m);

/// What the observations of one sensor tell particles.
class SensorModel {
 public:
  /// `noise_inflation`, on the standard deviations of observations.
  SensorModel(const LandmarkSensor& sensor, double noise_inflation);

  [[nodiscard]] const LandmarkSensor& sensor() const { return sensor_; }
  [[nodiscard]] const kernels::SensorMount& mount() const { return mount_; }
  /// What the sensor sees for certain.
  [[nodiscard]] kernels::SensorView view() const;
  /// By how many times the variance of an observation is larger than it says.
  [[nodiscard]] double inflation() const { return inflation_; }

  /// A usable observation, as unsure as it is at such a distance from the last one of the same landmark. The
  /// particles have no states for errors that outlive an observation: they count by what it brings anew, see
  /// bias_variance_factor().
  [[nodiscard]] kernels::LandmarkMeasurement seen(const Observation& observation, double travelled_since_m,
                                                  const kernels::RangeErrors& range_errors) const;

  /// The same, of a gathered landmark. Valid as LandmarkStore::view() is.
  [[nodiscard]] kernels::LandmarkObservation landmark_observation(const Observation& observation,
                                                                  int landmark, const Belief& belief) const;

 private:
  LandmarkSensor sensor_;
  double inflation_;
  kernels::SensorMount mount_;
};

}  // namespace waymark::fastslam
