#pragma once

#include <vector>

#include <Eigen/Core>

#include "waymark/core/observation.hpp"
#include "waymark/core/sensor_bias.hpp"
#include "waymark/ekf/compressed_state.hpp"
#include "waymark/models/landmark_sensor.hpp"

namespace waymark::ekf {

/// What biases do to one observation z = h + e + v: e = sum of J times the pairs of the state.
struct ObservationBias {
  BiasTerms terms = {};
  Eigen::Matrix2d unmodelled = Eigen::Matrix2d::Zero();  ///< covariance of what no pair stands for
};

/// Errors of the sensor that outlive an observation, as states of the filter (the shaping filter of Bryson
/// and Henrikson 1968). The first pairs are what all observations share, a calibration: scale of ranges and
/// offset of bearings, then offset of ranges. The others are assigned to the landmarks that were seen last,
/// each a Gauss-Markov process along the way: what two observations of one landmark have in common falls with
/// exp(-d / bias_distance_m).
///
/// White noise in its place is wrong in one of two ways: as large as the errors are it hides how well
/// successive observations agree (NIS far below 1), as small as they scatter it takes what is repeated for
/// new information (NEES far above 3).
class SensorBiasStates {
 public:
  explicit SensorBiasStates(const SensorErrors& sensor);

  /// Pairs that the state must have.
  [[nodiscard]] int pairs() const { return static_cast<int>(slots_.size()) + first_slot_; }

  /// Before the first observation.
  void start(CompressedState& state) const;
  void drive(double travelled_m) { travelled_m_ += travelled_m; }
  void begin_scan() { ++scan_; }
  /// A landmark is about to be observed, for the first time in this scan: its pair drifts as far as it has
  /// to.
  void assign(CompressedState& state, LandmarkId landmark);
  /// What is in an observation of a landmark after assign(). Range-bearing: metres and radians.
  [[nodiscard]] ObservationBias of(LandmarkId landmark, double range_m) const;
  /// What all observations share.
  [[nodiscard]] CalibrationEstimate calibration(const CompressedState& state) const;

 private:
  struct BiasSlot {
    LandmarkId landmark;
    double travelled_m = 0.0;  ///< when last seen
    int scan = 0;              ///< the same
  };

  [[nodiscard]] int find(LandmarkId landmark) const;
  [[nodiscard]] int oldest() const;

  [[nodiscard]] bool offsets() const { return sensor_.shared_range_sigma_m > 0.0; }

  SensorErrors sensor_;
  int offset_pair_;
  int first_slot_;
  std::vector<BiasSlot> slots_;  // by pair, less first_slot_
  double travelled_m_ = 0.0;
  int scan_ = 0;
};

}  // namespace waymark::ekf
