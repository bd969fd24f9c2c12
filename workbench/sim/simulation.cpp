#include "workbench/sim/simulation.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "waymark/core/random.hpp"

#include "workbench/config/robot_keys.hpp"
#include "workbench/sim/faults.hpp"
#include "workbench/sim/gyro.hpp"
#include "workbench/sim/landmark_sensor.hpp"
#include "workbench/sim/path.hpp"
#include "workbench/sim/rooms.hpp"
#include "workbench/sim/wall_markers.hpp"
#include "workbench/sim/wheels.hpp"
#include "workbench/sim/world.hpp"

namespace waymark::sim {
namespace {

constexpr double kEventsMax = 1e7;
// A filter must not believe in a sensor without any noise.
constexpr double kRangeSigmaMin_m = 1e-3;
constexpr double kBearingSigmaMin_deg = 1e-2;
// What the exposure of a driving camera leaves of its direction in rendered rooms, away from the ends of
// turns.
constexpr double kJitter_deg = 6e-3;

using Settings = std::vector<std::pair<std::string, std::string>>;

Settings sensor_settings(const SimOptions& options) {
  const WheelGeometry wheels = geometry(options.wheels);
  const OdometryNoise noise = assumed_noise(options.wheels);
  const LandmarkSensor sensor = model_of(options.sensor);
  const std::vector<std::pair<std::string, double>> values{
      {"wheels.left_radius_m", wheels.left_radius_m},
      {"wheels.right_radius_m", wheels.right_radius_m},
      {"wheels.track_m", wheels.track_m},
      {"motion.wheel_var_m2_per_m", noise.wheel_var_m2_per_m},
      {"motion.forward_var_m2_per_m", noise.forward_var_m2_per_m},
      {"motion.lateral_var_m2_per_m", noise.lateral_var_m2_per_m},
      {"motion.turn_var_rad2_per_rad", noise.turn_var_rad2_per_rad},
      {"motion.turn_var_rad2_per_m", noise.turn_var_rad2_per_m},
      {"sensor.x_m", sensor.x_m},
      {"sensor.y_m", sensor.y_m},
      {"sensor.yaw_deg", sensor.yaw_deg},
      {"sensor.range_sigma_m", std::max(sensor.range_sigma_m, kRangeSigmaMin_m)},
      {"sensor.range_sigma_ratio", sensor.range_sigma_ratio},
      {"sensor.bearing_sigma_deg", std::max(sensor.bearing_sigma_deg, kBearingSigmaMin_deg)},
      {"sensor.min_range_m", sensor.min_range_m},
      {"sensor.max_range_m", sensor.max_range_m},
      {"sensor.field_of_view_deg", sensor.field_of_view_deg},
      {"sensor.detection_probability", sensor.detection_probability},
  };
  Settings settings;
  for (const auto& [key, value] : values) settings.emplace_back(key, fmt::format("{}", value));
  return settings;
}

Settings camera_settings(CameraOptions camera) {
  Schema schema;
  describe(schema, camera);
  Settings settings;
  for (const std::string& key : schema.keys()) settings.emplace_back(key, schema.value(key));
  return settings;
}

bool has_images(const SimOptions& options) { return options.room.scene != SceneKind::kNone; }

Settings settings_of(const SimOptions& options) {
  Settings settings = sensor_settings(options);
  if (!has_images(options)) return settings;
  std::ranges::move(camera_settings(camera_of(options.camera_simulator)), std::back_inserter(settings));
  if (options.room.markers > 0) {
    settings.emplace_back("observe", "markers");
    settings.emplace_back("markers.dictionary", "4x4_50");
    settings.emplace_back("markers.size_m", fmt::format("{}", options.room.marker_size_m));
    settings.emplace_back("camera.jitter_deg", fmt::format("{}", kJitter_deg));
  }
  return settings;
}

void add_wheels(std::vector<Event>& events, const Drive& drive) {
  WheelAngles sum;
  events.emplace_back(drive.stamp(0), sum);
  for (std::size_t i = 0; i < drive.steps.size(); ++i) {
    sum.left_rad += drive.steps[i].counted.left_rad;
    sum.right_rad += drive.steps[i].counted.right_rad;
    events.emplace_back(drive.stamp(i + 1), sum);
  }
}

// A velocity holds from its stamp on, so each is what the wheels are about to count.
void add_velocities(std::vector<Event>& events, const Drive& drive, const WheelGeometry& wheels) {
  for (std::size_t i = 0; i < drive.steps.size(); ++i) {
    const ArcStep counted = wheel_step(drive.steps[i].counted, wheels);
    const double dt_s = to_seconds(drive.stamp(i + 1) - drive.stamp(i));
    events.emplace_back(drive.stamp(i), Velocity{counted.distance_m / dt_s, counted.turn_rad / dt_s});
  }
  events.emplace_back(drive.end(), Velocity{});
}

void add_odometry_poses(std::vector<Event>& events, const Drive& drive, const WheelGeometry& wheels) {
  Pose2 T_odom_robot;
  events.emplace_back(drive.stamp(0), OdometryPose{T_odom_robot});
  for (std::size_t i = 0; i < drive.steps.size(); ++i) {
    T_odom_robot = T_odom_robot * arc_increment(wheel_step(drive.steps[i].counted, wheels), ArcModel::kExact);
    events.emplace_back(drive.stamp(i + 1), OdometryPose{T_odom_robot});
  }
}

void add_odometry(std::vector<Event>& events, const Drive& drive, const WheelOptions& options) {
  switch (options.odometry) {
    case SimulatedOdometry::kWheels:
      return add_wheels(events, drive);
    case SimulatedOdometry::kVelocity:
      return add_velocities(events, drive, geometry(options));
    case SimulatedOdometry::kPose:
      return add_odometry_poses(events, drive, geometry(options));
  }
}

std::vector<Event> make_scans(const Drive& drive, const SimOptions& options,
                              const std::vector<TrueLandmark>& landmarks,
                              const std::optional<CarriedLandmark>& carried, std::uint64_t seed) {
  std::vector<Event> scans;
  for (std::uint64_t i = 0;; ++i) {
    const Stamp stamp = scan_stamp(options.sensor, i);
    if (stamp > drive.end()) return scans;
    RandomStream random(seed, StreamPurpose::kSimulation, i, 1);
    scans.emplace_back(stamp,
                       scan(options.sensor, drive.at(stamp), places_at(landmarks, carried, stamp), random));
  }
}

void add_scans(std::vector<Event>& events, std::vector<Event> scans, bool identities) {
  for (Event& each : scans) {
    auto& seen = std::get<Observations>(each.content);
    if (!identities)
      for (Observation& observation : seen) observation.id.reset();
    if (!seen.empty()) events.push_back(std::move(each));
  }
}

Event truth_event(const Drive& drive, Stamp stamp, bool heading) {
  const Pose2 pose = drive.at(stamp);
  return {stamp, Truth{pose.x_m, pose.y_m, heading ? std::optional(pose.theta_rad) : std::nullopt}};
}

void add_truth(std::vector<Event>& events, const Drive& drive, const TruthOptions& options) {
  std::vector<Stamp> stamps{drive.stamp(0)};
  if (options.rate_hz > 0.0) {
    const auto next_s = [&] { return static_cast<double>(stamps.size()) / options.rate_hz; };
    while (next_s() < to_seconds(drive.end())) stamps.push_back(stamp_from_seconds(next_s()));
  } else {
    for (const std::size_t corner : drive.corners) stamps.push_back(drive.stamp(corner));
  }
  if (stamps.back() < drive.end()) stamps.push_back(drive.end());
  for (const Stamp stamp : stamps) events.push_back(truth_event(drive, stamp, options.heading));
}

void add_images(std::vector<Event>& events, const CameraSimulator& camera_simulator) {
  for (std::size_t i = 0; i < camera_simulator.size(); ++i)
    if (!camera_simulator.is_lost(i)) events.emplace_back(camera_simulator.stamp(i), Image{});
}

Result<void> check_size(const Path& path, const SimOptions& options) {
  const double duration_s = options.path.stand_s + options.path.laps * lap_duration_s(path, options);
  const double events = duration_s * (options.wheels.rate_hz + options.gyro.rate_hz + options.sensor.rate_hz +
                                      options.truth.rate_hz + options.camera_simulator.rate_hz);
  if (events <= kEventsMax) return {};
  return Error{
      fmt::format("simulation: the drive would take {:.0f} s and {:.2g} events, but at most {:.2g} events "
                  "are possible; lower sim.laps, sim.side_m or a rate, or raise sim.speed_mps",
                  duration_s, events, kEventsMax)};
}

}  // namespace

Result<std::unique_ptr<Simulation>> Simulation::make(std::string name, const SimOptions& options,
                                                     std::uint64_t seed, int threads) {
  if (auto valid = validate(options); !valid) return valid.error();
  const Path path = make_path(options.path, seed);
  if (auto size = check_size(path, options); !size) return size.error();

  const Drive driven = drive(path, options, seed);
  const std::vector<TrueLandmark> placed = place_landmarks(options.world, path, seed);
  const auto carried = carry_landmark(options.faults, options.sensor, driven, placed, seed);
  std::vector<Event> scans = make_scans(driven, options, placed, carried, seed);
  make_false(scans, options.faults, carried, placed, seed);
  LogInfo info{std::move(name),
               "simulation",
               settings_of(options),
               places_at(placed, options.faults.omit ? std::nullopt : carried, driven.end()),
               options.sensor.identities,
               false,
               {}};
  std::vector<Event> events;
  add_odometry(events, driven, options.wheels);
  std::ranges::move(gyro_readings(options.gyro, options.faults, driven, seed), std::back_inserter(events));
  add_scans(events, std::move(scans), options.sensor.identities);
  add_truth(events, driven, options.truth);
  std::unique_ptr<CameraSimulator> camera_simulator;
  if (has_images(options)) {
    info.only_pixels = std::ranges::none_of(
        events, [](const Event& event) { return std::holds_alternative<Observations>(event.content); });
    for (const WallMarker& marker : place_markers(options.room, path, seed))
      info.landmarks.push_back({{LandmarkId::Family::kMarker, marker.number},
                                marker.centre_m.x(),
                                marker.centre_m.y(),
                                marker.centre_m.z()});
    camera_simulator = std::make_unique<CameraSimulator>(
        options.camera_simulator, build_scene(options.room, path, seed), driven, seed, threads);
    add_images(events, *camera_simulator);
  }
  return std::unique_ptr<Simulation>(
      new Simulation(std::move(info), std::move(events), std::move(camera_simulator)));
}

Result<std::optional<Event>> Simulation::next() {
  auto event = EventList::next();
  if (event && *event)
    if (auto* image = std::get_if<Image>(&(**event).content))
      image->pixels = std::make_shared<const GreyImage>(
          camera_simulator_->take(camera_simulator_->number((**event).stamp)));
  return event;
}

}  // namespace waymark::sim
