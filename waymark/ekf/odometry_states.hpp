#pragma once

#include "waymark/core/motion.hpp"
#include "waymark/core/sensor_bias.hpp"
#include "waymark/ekf/compressed_state.hpp"
#include "waymark/ekf/odometry_state_options.hpp"
#include "waymark/models/odometry_errors.hpp"

namespace waymark {

namespace ekf {

/// The errors of the odometry as states: constants with a prior, in two pairs of biases, the fourth
/// value of which stands for nothing.
class OdometryStates {
 public:
  OdometryStates(const OdometryStateOptions& options, int first_pair)
      : options_(options), first_pair_(first_pair) {}

  /// Pairs that the state must have.
  [[nodiscard]] int pairs() const { return options_.estimate ? 2 : 0; }
  /// Before the first motion.
  void start(CompressedState& state) const;
  /// Moves the robot as the estimate corrects the odometry.
  void predict(CompressedState& state, const Motion& motion) const;
  [[nodiscard]] CalibrationEstimate calibration(const CompressedState& state) const;

 private:
  [[nodiscard]] OdometryErrors mean(const CompressedState& state) const;

  OdometryStateOptions options_;
  int first_pair_;
};

}  // namespace ekf
}  // namespace waymark
