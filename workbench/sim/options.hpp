#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "waymark/core/result.hpp"
#include "waymark/models/camera.hpp"

#include "workbench/config/schema.hpp"

namespace waymark::sim {

enum class Shape : std::uint8_t { kSquare, kLShape, kFigureEight, kRandom, kLoop };
enum class SimulatedOdometry : std::uint8_t { kWheels, kVelocity, kPose };
enum class Spread : std::uint8_t { kPath, kArea };
enum class SensorKind : std::uint8_t { kRangeBearing, kRange, kBearing };
enum class SceneKind : std::uint8_t { kNone, kRoom, kCorridor };

/// The closed path that the robot is told to drive.
struct PathOptions {
  Shape shape = Shape::kSquare;
  double side_m = 6.0;
  int laps = 1;
  int waypoints = 8;
  double corner_radius_m = 0.0;
  double speed_mps = 0.3;
  double turn_rate_max_degps = 45.0;
  double stand_s = 0.0;
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
  SimulatedOdometry odometry = SimulatedOdometry::kWheels;
  double rate_hz = 50.0;
  double radius_m = 0.0975;
  double track_m = 0.331;
  double var_m2_per_m = 2e-5;
  double slip_forward_var_m2_per_m = 1e-5;
  double slip_lateral_var_m2_per_m = 1e-5;
  double slip_turn_var_rad2_per_rad = 1e-4;
  double slip_turn_var_rad2_per_m = 1e-5;
};

/// A gyro on the robot; none at a rate of 0. Its bias begins with a draw and walks.
struct GyroOptions {
  double rate_hz = 0.0;
  double noise_deg_per_sqrt_s = 0.02;
  double bias_sigma_degps = 0.5;
  double bias_walk_degps_per_sqrt_s = 0.001;
};

/// What sees landmarks, and how badly.
struct SensorOptions {
  SensorKind observe = SensorKind::kRangeBearing;
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

/// What there is to be seen by a camera: a hall around the path, or a corridor along it.
struct RoomOptions {
  SceneKind scene = SceneKind::kNone;
  double margin_m = 2.0;
  double height_m = 2.5;
  int blocks = 24;
  int walkers = 1;
  double walker_speed_mps = 1.0;
  int markers = 0;
  double marker_size_m = 0.2;
};

/// A camera, and how badly it sees.
struct CameraSimulatorOptions {
  int width_px = 320;
  int height_px = 240;
  double rate_hz = 30.0;
  double field_of_view_deg = 60.0;
  Distortion distortion{.k1 = -0.12, .k2 = 0.03, .p1 = 0.0005, .p2 = -0.0003};
  CameraMount mount{.x_m = 0.1, .z_m = 0.5};
  double lens_blur_px = 0.5;
  double exposure_ms = 5.0;
  double noise_grey = 2.0;
  double brightness = 1.0;
  double drift_ratio = 0.1;
  double drift_period_s = 20.0;
  double jump_ratio = 0.25;
  double jump_interval_s = 10.0;
  double covered_from_s = 0.0;
  double covered_for_s = 0.0;
  double drop_probability = 0.0;
  double vibration_pitch_deg = 0.05;
  double vibration_roll_deg = 0.05;
  double vibration_height_m = 0.001;
};

/// What goes wrong beyond noise. Nothing by default.
struct FaultOptions {
  double false_first_share = 0.0;
  double outlier_share = 0.0;
  double landmark_carried_at_s = 0.0;
  double landmark_carried_m = 2.0;
  double robot_carried_at_s = 0.0;
  double robot_carried_m = 2.0;
  double robot_carried_deg = 90.0;
  double turn_slip_ratio = 0.0;
  double gyro_stuck_at_s = 0.0;
  bool omit = false;
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
  GyroOptions gyro;
  SensorOptions sensor;
  RoomOptions room;
  CameraSimulatorOptions camera_simulator;
  TruthOptions truth;
  FaultOptions faults;
};

/// Adds every option as a key under `sim.`.
void describe(Schema& schema, SimOptions& options);

/// The camera as a filter is to be told of it.
[[nodiscard]] CameraOptions camera_of(const CameraSimulatorOptions& options);

/// Every value within its limits and all of them possible together; otherwise names the key and what would be
/// right.
Result<void> validate(const SimOptions& options);

/// A named world, which is configs/sim/NAME.yaml, built in, or one in a file that ends with .yaml and sets
/// `sim.` keys. An unknown name is an error that names the nearest. docs/rooms.md and the files themselves
/// describe the worlds.
Result<SimOptions> scenario(std::string_view name);
/// In the order of the alphabet.
[[nodiscard]] const std::vector<std::string>& scenario_names();

}  // namespace waymark::sim
