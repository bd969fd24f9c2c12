#pragma once

#include <optional>
#include <string>

#include "workbench/run/config.hpp"
#include "workbench/run/log_sample.hpp"

namespace waymark {

/// How well odometry and observations of a log fit each other.
struct Fit {
  /// Median over pairs of observations of one landmark, two to five seconds apart: from where the second
  /// should be, by the first and the odometry between them, to where it is, m.
  double apart_m = 0.0;
  double noise_m = 0.0;   ///< what the noise of the sensor makes of it
  double moved_m = 0.0;   ///< median distance between the two observations, in the robot's frame
  std::string mistake;    ///< what the log would have to have wrong to fit far better; empty: nothing known
  double mended_m = 0.0;  ///< what the median would be then

  /// The odometry explains little of how landmarks move past the robot.
  [[nodiscard]] bool contradicts() const { return apart_m > 2.0 * noise_m && apart_m > 0.4 * moved_m; }
};

/// Compares odometry and observations of range and bearing with identities. Where they contradict each other,
/// it tries mistakes that logs are known for: signs, wheels or axes exchanged, degrees, lengths in other
/// units, bearings told in the world frame, the mount of the sensor. Of two mistakes that have the same
/// effect on the motion relative to landmarks (clockwise bearings, wheels exchanged) it names both. Nothing
/// if there are fewer than 30 pairs, or the wheels or the car are not known. O(events), once for each of 20
/// mistakes where something is wrong.
[[nodiscard]] std::optional<Fit> fit_of(const LogSample& sample, const Config& config);

/// What is wrong, for a person; nothing if they fit, or if they do not and what is wrong is not known and not
/// sure.
[[nodiscard]] std::optional<std::string> describe(const Fit& fit);

}  // namespace waymark
