#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "waymark/core/config.hpp"
#include "waymark/core/result.hpp"

namespace waymark::sim {

enum class Shape : std::uint8_t { kSquare, kLShape, kFigureEight, kRandom };
enum class OdometryKind : std::uint8_t { kWheels, kVelocity, kPose };
enum class Spread : std::uint8_t { kPath, kArea };
enum class Observe : std::uint8_t { kRangeBearing, kRange, kBearing };

/// The closed path that the robot is told to drive.
struct PathOptions {
  Shape shape = Shape::kSquare;
  double side_m = 6.0;
  int laps = 1;
  int waypoints = 8;
  double corner_radius_m = 0.0;
  double speed_mps = 0.3;
  double turn_rate_max_degps = 45.0;
};

/// Where landmarks stand.
struct WorldOptions {
  int landmarks = 24;
  Spread spread = Spread::kPath;
  double area_m = 30.0;
  double min_offset_m = 1.0;
  double max_offset_m = 3.0;
  double separation_m = 0.5;
};

/// A differential drive: what the encoders report and how far the robot slips from what its wheels did.
/// The variances are those of the motion model in the filters: encoder errors per wheel and metre rolled,
/// slip in the robot frame per metre driven and per radian turned.
struct WheelOptions {
  OdometryKind odometry = OdometryKind::kWheels;
  double rate_hz = 50.0;
  double radius_m = 0.0975;
  double track_m = 0.331;
  double var_m2_per_m = 2e-5;
  double slip_forward_var_m2_per_m = 1e-5;
  double slip_lateral_var_m2_per_m = 1e-5;
  double slip_turn_var_rad2_per_rad = 1e-4;
  double slip_turn_var_rad2_per_m = 1e-5;
};

/// What sees landmarks, and how badly.
struct SensorOptions {
  Observe observe = Observe::kRangeBearing;
  double rate_hz = 15.0;
  double x_m = 0.0;
  double y_m = 0.0;
  double yaw_deg = 0.0;
  double range_min_m = 0.336;
  double range_max_m = 5.36;
  double field_of_view_deg = 49.56;
  double range_sigma_m = 0.05;
  double range_sigma_ratio = 0.0;
  double bearing_sigma_deg = 1.5;
  double drop_probability = 0.0;
  double false_probability = 0.0;
  double clutter_probability = 0.0;
  double misread_probability = 0.0;
  bool identities = true;
};

/// How much of the truth the log holds.
struct TruthOptions {
  double rate_hz = 10.0;
  bool heading = true;
};

/// A simulated log, complete but for its seed.
struct SimOptions {
  PathOptions path;
  WorldOptions world;
  WheelOptions wheels;
  SensorOptions sensor;
  TruthOptions truth;
};

/// Adds every option as a key under `sim.`.
void describe(Schema& schema, SimOptions& options);

/// Every value within its limits and all of them possible together; otherwise names the key and what would be
/// right.
Result<void> validate(const SimOptions& options);

/// The options of a named world; an unknown name is an error that names the nearest.
///
/// `study` serves every comparison: two laps of the 6 m square at 0.3 m/s, 24 landmarks 1 to 3 m off the
/// path, a sensor of 0.336 to 5.36 m and 49.56 degrees at 15 frames/s with 0.05 m and 1.5 degrees of noise,
/// and wheels by which dead reckoning ends a lap 1.6 m from the truth (median over seeds).
///
/// `forest` is for filters that are not told which landmark they see: 100 trunks all over 30 x 30 m, at least
/// 1 m apart and 0.5 m from the path, two laps of a random path at 1 m/s with the wheels of the study, a
/// sensor of 10 m and 180 degrees at 5 scans/s with 0.1 m and 1 degree of noise, one in twenty sightings
/// missing and one in twenty accompanied by a false one, no identities.
///
/// `report-square` and `report-l-shape` are the worlds of the FastSLAM report on a Pioneer 3-DX.
Result<SimOptions> scenario(std::string_view name);
[[nodiscard]] const std::vector<std::string>& scenario_names();

}  // namespace waymark::sim
