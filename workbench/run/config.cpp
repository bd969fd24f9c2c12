#include "workbench/run/config.hpp"

#include <algorithm>
#include <optional>
#include <string_view>

#include "workbench/config/camera_keys.hpp"
#include "workbench/config/filter_keys.hpp"
#include "workbench/config/robot_keys.hpp"
#include "workbench/logs/image_loader.hpp"
#include "workbench/run/article_methods.hpp"
#include "workbench/run/open_source.hpp"
#include "workbench/sim/simulation.hpp"

namespace waymark {
namespace {

constexpr std::string_view kSimulationPrefix = "sim:";

Result<void> apply(Schema& schema, const std::vector<std::string>& assignments, const char* who) {
  for (const auto& assignment : assignments)
    if (auto done = schema.set_assignment(assignment, who); !done) return done;
  return {};
}

Result<void> apply(Schema& schema, const LogInfo& log) {
  if (log.only_pixels)
    if (auto done = schema.set("observe", "pixel", log.name); !done) return done;
  for (const auto& [key, value] : log.settings)
    if (auto done = schema.set(key, value, log.name); !done) return done;
  return {};
}

/// What a filter does best where observations have no identity.
const char* without_identities(FilterKind filter) { return filter == FilterKind::kEkf ? "jcbb" : "ml"; }

bool sets_mount(const Schema& schema) {
  return std::ranges::any_of(schema.keys(), [&schema](const std::string& key) {
    return key.starts_with("camera.mount_") && schema.was_set(key);
  });
}

/// The scenario that an input names, if it is a simulation.
std::optional<std::string> scenario_of(const std::string& input) {
  if (!input.starts_with(kSimulationPrefix)) return std::nullopt;
  return input.substr(kSimulationPrefix.size());
}

/// A scenario's world, changed by the user.
Result<std::unique_ptr<Source>> simulate(const std::string& scenario, const sim::SimOptions& world,
                                         const UserSettings& user) {
  Config config;
  config.sim = world;
  Schema schema = describe(config);
  if (auto done = apply(schema, user); !done) return done.error();
  auto simulation = sim::Simulation::make(scenario, config.sim, config.seed, config.threads);
  if (!simulation) return simulation.error();
  return std::unique_ptr<Source>(std::move(*simulation));
}

Result<std::unique_ptr<Source>> open_log(const std::string& input, const UserSettings& user) {
  Config config;
  Schema schema = describe(config);
  if (auto done = apply(schema, user); !done) return done.error();
  config.input.seed = config.seed;
  if (sets_mount(schema)) config.input.bag.mount = config.camera.mount;
  return open_source(input, config.input);
}

/// Does the user say what markers there are, and not what else to observe?
bool wants_markers(const UserSettings& user) {
  Config config;
  Schema schema = describe(config);
  return apply(schema, user) && !schema.was_set("observe") &&
         (schema.was_set("markers.dictionary") || schema.was_set("markers.size_m") ||
          schema.was_set("markers.sizes_m"));
}

/// Range and bearing of markers are measured from the camera.
void put_sensor_at_camera(Config& config) {
  const CameraMount& mount = config.camera.mount;
  config.sensor.x_m = mount.x_m;
  config.sensor.y_m = mount.y_m;
  config.sensor.yaw_deg = mount.yaw_deg;
}

}  // namespace

Result<void> apply(Schema& schema, const UserSettings& user) {
  for (const auto& file : user.files)
    if (auto done = schema.load_file(file); !done) return done;
  for (const auto& [flag, key, value] : user.flags)
    if (auto done = schema.set_by_flag(flag, key, value); !done) return done;
  return apply(schema, user.assignments, "--set");
}

const char* filter_name(FilterKind kind) { return kind == FilterKind::kEkf ? "EKF-SLAM" : "FastSLAM"; }

Schema describe(Config& config) {
  Schema schema;
  schema.choice("filter", config.filter, {"ekf", "fastslam"},
                "filter that estimates path and map: EKF-SLAM or FastSLAM", Shown::kAlways);
  schema.choice("observe", config.observe, {"range-bearing", "range", "bearing", "pixel", "markers"},
                "observations to use; pixel: corners in images or logged pixels, markers: ArUco or AprilTag "
                "markers in images; chosen by the log unless set",
                Shown::kAlways);
  schema.choice("associate", config.associate, {"known", "nearest", "jcbb", "ml"},
                "data association: known by identity alone; without identities nearest (neighbour) or jcbb "
                "with the EKF, ml (maximum likelihood) with FastSLAM; chosen by the log unless set",
                Shown::kAlways);
  schema.integer("seed", config.seed, {0, 9007199254740992.0}, "seed of all random numbers", Shown::kAlways);
  schema.integer("threads", config.threads, {1, 256}, "number of threads; does not change the result",
                 Shown::kAlways);
  describe(schema, config.input);
  describe(schema, config.odometry);
  describe(schema, config.sensor);
  describe(schema, config.camera);
  describe(schema, config.map);
  describe(schema, config.pipeline);
  describe(schema, config.gate);
  describe(schema, config.association);
  describe(schema, config.ekf);
  describe(schema, config.pixel);
  describe(schema, config.tracker);
  describe(schema, config.search);
  describe(schema, config.markers);
  describe(schema, config.fastslam);
  describe(schema, config.smooth);
  schema.boolean(
      "pixel.article", [&config] { return uses_article_methods(config); },
      [&config](bool use) { use_article_methods(config, use); },
      "use the algorithms of Vincke et al. 2012, for comparison; needs observe=pixel and "
      "ekf.consistency=standard");
  sim::describe(schema, config.sim);
  return schema;
}

Result<Config> resolve_config(const UserSettings& user) {
  Config config;
  Schema schema = describe(config);
  if (auto done = apply(schema, user); !done) return done.error();
  return config;
}

Result<std::unique_ptr<Source>> open_simulation(const std::string& scenario, const UserSettings& user) {
  const auto world = sim::scenario(scenario);
  return world ? simulate(scenario, *world, user) : world.error();
}

Result<OpenedInput> open_input(const std::string& input, const UserSettings& user) {
  Config config;
  const auto scenario = scenario_of(input);
  if (scenario) {
    const auto world = sim::scenario(*scenario);
    if (!world) return world.error();
    config.sim = *world;
  }
  auto source = scenario ? simulate(*scenario, config.sim, user) : open_log(input, user);
  if (!source) return source.error();
  Schema schema = describe(config);
  const LogInfo& log = (*source)->info();
  if (auto done = apply(schema, user.defaults, "defaults"); !done) return done.error();
  if (auto done = apply(schema, log); !done) return done.error();
  if (auto done = apply(schema, user); !done) return done.error();
  if (wants_markers(user))
    if (auto done = schema.set("observe", "markers", "--set"); !done) return done.error();
  config.camera_known = schema.was_set("camera.fu_px");
  if (!log.identities && config.observe != Observe::kMarkers) {
    // The filter is settled now; but the user may have said how to associate, too.
    if (auto done = schema.set("associate", without_identities(config.filter), log.name); !done)
      return done.error();
    if (auto done = apply(schema, user); !done) return done.error();
  }
  if (config.observe == Observe::kMarkers) put_sensor_at_camera(config);
  if (config.observe == Observe::kPixel || config.observe == Observe::kMarkers)
    *source = std::make_unique<ImageLoader>(std::move(*source));
  return OpenedInput{std::move(*source), config};
}

}  // namespace waymark
