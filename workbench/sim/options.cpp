#include "workbench/sim/options.hpp"

#include <cmath>
#include <filesystem>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "waymark/core/angle.hpp"
#include "waymark/core/names.hpp"

#include "workbench/config/flat_yaml.hpp"
#include "workbench/config/known_settings_text.hpp"
#include "workbench/config/read_file.hpp"
#include "workbench/sim/marker_pattern.hpp"

namespace waymark::sim {
namespace {

constexpr ValueLimits kProbability{0.0, 1.0};
constexpr ValueLimits kVariance{0.0, 1.0};

void describe(Schema& schema, PathOptions& o) {
  schema.choice("sim.path", o.shape, {"square", "l-shape", "figure-eight", "random", "loop"},
                "shape of the closed path");
  schema.real("sim.side_m", o.side_m, {0.5, 1000.0},
              "side of the square that the path fits into, m; a loop is a third as wide as long");
  schema.integer("sim.laps", o.laps, {1, 1000}, "number of laps around the path");
  schema.integer("sim.waypoints", o.waypoints, {3, 1000}, "number of corners of a random path");
  schema.real("sim.corner_radius_m", o.corner_radius_m, {0.0, 100.0},
              "radius of the corners of the path, m; 0: the robot turns on the spot");
  schema.real("sim.speed_mps", o.speed_mps, {0.01, 10.0}, "speed on straight lines, m/s");
  schema.real("sim.turn_rate_max_degps", o.turn_rate_max_degps, {1.0, 720.0},
              "maximum turn rate, degrees per second");
  schema.real("sim.stand_s", o.stand_s, {0.0, 1e6}, "time for which the robot stands before it drives, s");
}

void describe(Schema& schema, WorldOptions& o) {
  schema.integer("sim.landmarks", o.landmarks, {0, 10000}, "number of landmarks in the world");
  schema.choice(
      "sim.landmark_spread", o.spread, {"path", "area"},
      "where landmarks stand: on both sides of the path, or anywhere in a square about the origin (area)");
  schema.real("sim.landmark_area_m", o.area_m, {0.5, 10000.0}, "side of that square, m");
  schema.real("sim.landmark_min_offset_m", o.min_offset_m, {0.0, 100.0},
              "minimum distance of a landmark from the path, m");
  schema.real("sim.landmark_max_offset_m", o.max_offset_m, {0.1, 100.0},
              "maximum distance of a landmark from the path, m; for sim.landmark_spread=path");
  schema.real("sim.landmark_separation_m", o.separation_m, {0.0, 100.0},
              "minimum distance between landmarks, m; halved until all of them find room");
}

void describe(Schema& schema, WheelOptions& o) {
  schema.choice("sim.odometry", o.odometry, {"wheels", "velocity", "pose"}, "kind of odometry in the log");
  schema.real("sim.odometry_rate_hz", o.rate_hz, {1.0, 1000.0}, "odometry readings per second");
  schema.real("sim.wheel_radius_m", o.radius_m, {0.001, 10.0}, "radius of both wheels, m");
  schema.real("sim.wheel_track_m", o.track_m, {0.01, 10.0}, "distance between the wheels, m");
  schema.real("sim.wheel_var_m2_per_m", o.var_m2_per_m, kVariance,
              "variance of the encoder of each wheel, m^2 per metre rolled");
  schema.real("sim.slip_forward_var_m2_per_m", o.slip_forward_var_m2_per_m, kVariance,
              "variance of slip along the path, m^2 per metre driven");
  schema.real("sim.slip_lateral_var_m2_per_m", o.slip_lateral_var_m2_per_m, kVariance,
              "variance of sideways slip, m^2 per metre driven");
  schema.real("sim.slip_turn_var_rad2_per_rad", o.slip_turn_var_rad2_per_rad, kVariance,
              "variance of heading slip, rad^2 per radian turned");
  schema.real("sim.slip_turn_var_rad2_per_m", o.slip_turn_var_rad2_per_m, kVariance,
              "variance of heading slip, rad^2 per metre driven");
}

void describe(Schema& schema, GyroOptions& o) {
  schema.real("sim.gyro_rate_hz", o.rate_hz, {0.0, 1000.0}, "readings of a gyro per second; 0: no gyro");
  schema.real("sim.gyro_noise_deg_per_sqrt_s", o.noise_deg_per_sqrt_s, {0.0, 10.0},
              "white noise of the gyro, as its turn's standard deviation after a second, degrees");
  schema.real("sim.gyro_bias_sigma_degps", o.bias_sigma_degps, {0.0, 100.0},
              "standard deviation of the gyro's bias at the start, degrees per second");
  schema.real("sim.gyro_bias_walk_degps_per_sqrt_s", o.bias_walk_degps_per_sqrt_s, {0.0, 10.0},
              "standard deviation by which the gyro's bias changes in a second, degrees per second");
}

void describe(Schema& schema, SensorOptions& o) {
  schema.choice("sim.observe", o.observe, {"range-bearing", "range", "bearing"},
                "what the landmark sensor measures");
  schema.real("sim.sensor_rate_hz", o.rate_hz, {0.1, 1000.0}, "scans per second");
  schema.real("sim.sensor_x_m", o.x_m, {-10.0, 10.0},
              "position of the sensor ahead of the robot's origin, m");
  schema.real("sim.sensor_y_m", o.y_m, {-10.0, 10.0}, "position of the sensor left of the robot's origin, m");
  schema.real("sim.sensor_yaw_deg", o.yaw_deg, {-180.0, 180.0},
              "yaw of the sensor on the robot, degrees, positive to the left");
  schema.real("sim.range_min_m", o.range_min_m, {0.0, 1000.0}, "minimum range of an observation, m");
  schema.real("sim.range_max_m", o.range_max_m, {0.01, 1000.0}, "maximum range of an observation, m");
  schema.real("sim.field_of_view_deg", o.field_of_view_deg, {0.1, 360.0},
              "full field of view of the sensor, degrees");
  schema.real("sim.range_sigma_m", o.range_sigma_m, {0.0, 10.0}, "standard deviation of ranges, m");
  schema.real("sim.range_sigma_ratio", o.range_sigma_ratio, {0.0, 1.0},
              "additional standard deviation of ranges per metre of range");
  schema.real("sim.bearing_sigma_deg", o.bearing_sigma_deg, {0.0, 90.0},
              "standard deviation of bearings, degrees");
  schema.real("sim.drop_probability", o.drop_probability, kProbability,
              "probability that a visible landmark is not observed");
  schema.real("sim.false_probability", o.false_probability, kProbability,
              "probability per scan of a false observation; half of them have the identity of a landmark");
  schema.real("sim.clutter_probability", o.clutter_probability, kProbability,
              "probability per observed landmark of an additional false observation without identity");
  schema.real("sim.misread_probability", o.misread_probability, kProbability,
              "probability that an observation has the identity of another landmark");
  schema.boolean("sim.identities", o.identities, "observations have identities");
}

void describe(Schema& schema, RoomOptions& o) {
  schema.choice("sim.scene", o.scene, {"none", "room", "corridor"}, "what a camera sees; none: no images");
  schema.real("sim.margin_m", o.margin_m, {0.8, 20.0}, "distance from the path to the walls, m");
  schema.real("sim.room_height_m", o.height_m, {1.0, 10.0}, "height of the room, m");
  schema.integer("sim.blocks", o.blocks, {0, 500}, "number of pieces of furniture, as many as find room");
  schema.integer("sim.walkers", o.walkers, {0, 50}, "number of people who walk about");
  schema.real("sim.walker_speed_mps", o.walker_speed_mps, {0.0, 10.0}, "speed of the people, m/s");
  schema.integer("sim.markers", o.markers, {0, kMarkerPatterns},
                 "number of ArUco markers (dictionary 4x4_50) on the walls");
  schema.real("sim.marker_size_m", o.marker_size_m, {0.02, 1.0}, "side of their black squares, m");
}

void describe(Schema& schema, Distortion& o) {
  schema.real("sim.camera_k1", o.k1, {-10.0, 10.0},
              "radial distortion, second order (plumb bob model, as in ROS)");
  schema.real("sim.camera_k2", o.k2, {-10.0, 10.0}, "radial distortion, fourth order");
  schema.real("sim.camera_p1", o.p1, {-1.0, 1.0}, "first coefficient of tangential distortion");
  schema.real("sim.camera_p2", o.p2, {-1.0, 1.0}, "second coefficient of tangential distortion");
  schema.real("sim.camera_k3", o.k3, {-10.0, 10.0}, "radial distortion, sixth order");
}

void describe(Schema& schema, CameraMount& o) {
  schema.real("sim.camera_x_m", o.x_m, {-10.0, 10.0},
              "position of the camera ahead of the robot's origin, m");
  schema.real("sim.camera_y_m", o.y_m, {-10.0, 10.0}, "position of the camera left of the robot's origin, m");
  schema.real("sim.camera_z_m", o.z_m, {0.01, 10.0}, "height of the camera above the ground, m");
  schema.real("sim.camera_roll_deg", o.roll_deg, {-180.0, 180.0},
              "rotation of the camera about the robot's x axis (forward), degrees");
  schema.real("sim.camera_pitch_deg", o.pitch_deg, {-90.0, 90.0},
              "rotation of the camera about the robot's y axis (left), degrees, positive looks down");
  schema.real("sim.camera_yaw_deg", o.yaw_deg, {-180.0, 180.0},
              "rotation of the camera about the robot's z axis (up), degrees, positive looks left");
}

void describe(Schema& schema, CameraSimulatorOptions& o) {
  schema.integer("sim.image_width_px", o.width_px, {16, 4096}, "width of the images, pixels");
  schema.integer("sim.image_height_px", o.height_px, {16, 4096}, "height of the images, pixels");
  schema.real("sim.image_rate_hz", o.rate_hz, {0.1, 1000.0}, "images per second");
  schema.real("sim.camera_field_of_view_deg", o.field_of_view_deg, {5.0, 150.0},
              "horizontal field of view of the camera, without the distortion, degrees");
  describe(schema, o.distortion);
  describe(schema, o.mount);
  schema.real("sim.lens_blur_px", o.lens_blur_px, {0.0, 1.0}, "standard deviation of the lens blur, px");
  schema.real("sim.exposure_ms", o.exposure_ms, {0.0, 100.0}, "exposure time, ms; more blurs what moves");
  schema.real("sim.noise_grey", o.noise_grey, {0.0, 100.0},
              "standard deviation of the noise of a pixel, grey levels");
  schema.real("sim.brightness", o.brightness, {0.0, 100.0}, "factor on the grey values of all images");
  schema.real("sim.brightness_drift_ratio", o.drift_ratio, {0.0, 1.0},
              "amplitude of a slow change of brightness, relative");
  schema.real("sim.brightness_drift_period_s", o.drift_period_s, {0.1, 1e6}, "period of that change, s");
  schema.real("sim.brightness_jump_ratio", o.jump_ratio, {0.0, 1.0},
              "maximum sudden change of brightness, up or down, relative");
  schema.real("sim.brightness_jump_interval_s", o.jump_interval_s, {0.1, 1e6},
              "time between sudden changes, s");
  schema.real("sim.lens_covered_from_s", o.covered_from_s, {0.0, 1e6},
              "time from which the lens is covered and images are black, s");
  schema.real("sim.lens_covered_for_s", o.covered_for_s, {0.0, 1e6},
              "duration for which the lens is covered, s; 0: never");
  schema.real("sim.image_drop_probability", o.drop_probability, kProbability,
              "probability that an image is lost");
  schema.real("sim.vibration_pitch_deg", o.vibration_pitch_deg, {0.0, 10.0},
              "standard deviation of the vibration of the camera in pitch, degrees");
  schema.real("sim.vibration_roll_deg", o.vibration_roll_deg, {0.0, 10.0},
              "standard deviation of the vibration of the camera in roll, degrees");
  schema.real("sim.vibration_height_m", o.vibration_height_m, {0.0, 1.0},
              "standard deviation of the vibration of the camera in height, m");
}

void describe(Schema& schema, TruthOptions& o) {
  schema.real("sim.truth_rate_hz", o.rate_hz, {0.0, 1000.0},
              "true poses per second; 0: only at the corners of the path");
  schema.boolean("sim.truth_heading", o.heading, "true poses include the heading");
}

void describe(Schema& schema, FaultOptions& o) {
  schema.real("sim.false_first_share", o.false_first_share, kProbability,
              "share of the landmarks whose first observation is false; above 0: at least one of them");
  schema.real("sim.outlier_share", o.outlier_share, kProbability,
              "share of false observations: a range times 0.3 to 3, or a bearing 30 to 180 degrees off");
  schema.real("sim.landmark_carried_at_s", o.landmark_carried_at_s, {0.0, 1e6},
              "time at which a landmark that is seen before and after is carried elsewhere, s; 0: never");
  schema.real("sim.landmark_carried_m", o.landmark_carried_m, {0.0, 1000.0}, "how far, m");
  schema.real("sim.robot_carried_at_s", o.robot_carried_at_s, {0.0, 1e6},
              "time at which the robot is lifted and put down elsewhere, s; 0: never");
  schema.real("sim.robot_carried_m", o.robot_carried_m, {0.0, 1000.0}, "how far, m, in any direction");
  schema.real("sim.robot_carried_deg", o.robot_carried_deg, {0.0, 180.0},
              "and how much it is turned, degrees, either way");
  schema.real("sim.turn_slip_ratio", o.turn_slip_ratio, {0.0, 0.9},
              "maximum part of a turn that the wheels make without the robot; drawn for every turn");
  schema.real("sim.gyro_stuck_at_s", o.gyro_stuck_at_s, {0.0, 1e6},
              "time from which the gyro repeats its last reading, s; 0: never");
  schema.boolean(
      "sim.omit_false", o.omit,
      "leave out false observations, and those of a carried landmark: what the log would be without");
}

constexpr std::string_view kFolder = "sim/";
constexpr std::string_view kFileEnding = ".yaml";

/// Keys of other things than the world, unless they are mistyped ones of it.
Result<void> check_world_keys(const Schema& schema, const std::string& yaml, const std::string& name) {
  const auto entries = flatten_yaml(yaml, name);
  if (!entries) return entries.error();
  for (const FlatYamlEntry& entry : *entries)
    if (!entry.key.starts_with("sim.") && schema.close_keys(entry.key, 1).empty())
      return Error{fmt::format("{}:{}: a world has only keys `sim.*`; give {} by --config", name, entry.line,
                               entry.key)};
  return {};
}

Result<SimOptions> read_options(const std::string& yaml, const std::string& name) {
  SimOptions options;
  Schema schema;
  describe(schema, options);
  if (auto valid = check_world_keys(schema, yaml, name); !valid) return valid.error();
  if (auto done = schema.load_text(yaml, name); !done) return done.error();
  return options;
}

// The limits are those of the keys, so each value is set to itself.
Result<void> validate_limits(SimOptions options) {
  Schema schema;
  describe(schema, options);
  for (const std::string& key : schema.keys()) {
    if (auto set = schema.set(key, schema.value(key), "simulation"); !set) return set;
  }
  return {};
}

// Light must reach the corners, half a pixel beyond the last.
Result<void> validate_lens(const CameraSimulatorOptions& camera_simulator) {
  const Camera camera(camera_of(camera_simulator));
  for (const double u : {-1.0, static_cast<double>(camera_simulator.width_px)})
    for (const double v : {-1.0, static_cast<double>(camera_simulator.height_px)})
      if (!camera.ray({u, v}))
        return Error{
            "simulation: the distortion (sim.camera_k1, k2, p1, p2 and k3) is not invertible at the corners "
            "of the image; bring it nearer to 0 or lower sim.camera_field_of_view_deg"};
  return {};
}

}  // namespace

void describe(Schema& schema, SimOptions& options) {
  describe(schema, options.path);
  describe(schema, options.world);
  describe(schema, options.wheels);
  describe(schema, options.gyro);
  describe(schema, options.sensor);
  describe(schema, options.room);
  describe(schema, options.camera_simulator);
  describe(schema, options.truth);
  describe(schema, options.faults);
}

CameraOptions camera_of(const CameraSimulatorOptions& options) {
  CameraOptions camera{.width_px = options.width_px, .height_px = options.height_px};
  camera.fu_px = 0.5 * options.width_px / std::tan(0.5 * to_radians(options.field_of_view_deg));
  camera.fv_px = camera.fu_px;
  camera.cu_px = 0.5 * (options.width_px - 1);
  camera.cv_px = 0.5 * (options.height_px - 1);
  camera.distortion = options.distortion;
  camera.mount = options.mount;
  return camera;
}

Result<void> validate(const SimOptions& options) {
  if (auto limits = validate_limits(options); !limits) return limits;
  const auto& [path, world, wheels, gyro, sensor, room, camera_simulator, truth, faults] = options;
  if (auto lens = validate_lens(camera_simulator); !lens) return lens;
  if (room.scene == SceneKind::kCorridor && path.shape != Shape::kSquare && path.shape != Shape::kLoop)
    return Error{"simulation: sim.scene=corridor needs sim.path=square or sim.path=loop"};
  if (room.scene != SceneKind::kNone && room.markers > 0 && world.landmarks > 0)
    return Error{
        "simulation: sim.markers and sim.landmarks cannot be used together, since their identities would be "
        "the same; set one of them to 0"};
  if (world.spread == Spread::kPath && world.max_offset_m < world.min_offset_m + 0.1) {
    return Error{
        fmt::format("simulation: sim.landmark_max_offset_m is {}; it must be at least {}, 0.1 m above "
                    "sim.landmark_min_offset_m",
                    world.max_offset_m, world.min_offset_m + 0.1)};
  }
  if (sensor.range_max_m <= sensor.range_min_m) {
    return Error{
        fmt::format("simulation: sim.range_max_m is {}; it must be above sim.range_min_m, which is {}",
                    sensor.range_max_m, sensor.range_min_m)};
  }
  return {};
}

Result<SimOptions> scenario(std::string_view name) {
  if (name.ends_with(kFileEnding)) {
    const auto text = read_file(std::filesystem::path(name));
    return text ? read_options(*text, std::string(name)) : text.error();
  }
  for (const SettingsText& each : known_settings_texts())
    if (each.name.starts_with(kFolder) && each.name.substr(kFolder.size()) == name)
      return read_options(each.yaml, fmt::format("configs/{}.yaml", each.name));
  const std::string near = nearest_name(name, scenario_names());
  return Error{fmt::format("unknown scenario '{}'{}; known are {}, or give a file.yaml", name,
                           near.empty() ? "" : fmt::format(", did you mean '{}'?", near),
                           fmt::join(scenario_names(), ", "))};
}

const std::vector<std::string>& scenario_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const SettingsText& each : known_settings_texts())
      if (each.name.starts_with(kFolder)) all.emplace_back(each.name.substr(kFolder.size()));
    return all;
  }();
  return names;
}

}  // namespace waymark::sim
