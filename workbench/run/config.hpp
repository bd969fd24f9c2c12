#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "waymark/association/association_options.hpp"
#include "waymark/association/gate.hpp"
#include "waymark/ekf/ekf_options.hpp"
#include "waymark/ekf/pixel_slam_options.hpp"
#include "waymark/fastslam/fast_slam_options.hpp"
#include "waymark/markers/marker_options.hpp"
#include "waymark/models/camera.hpp"
#include "waymark/models/landmark_sensor.hpp"
#include "waymark/models/observe.hpp"
#include "waymark/models/odometry.hpp"
#include "waymark/slam/pipeline_options.hpp"
#include "waymark/smooth/options.hpp"
#include "waymark/vision/search_options.hpp"
#include "waymark/vision/tracker_options.hpp"

#include "workbench/config/schema.hpp"
#include "workbench/logs/source.hpp"
#include "workbench/run/input_options.hpp"
#include "workbench/run/map_options.hpp"
#include "workbench/sim/options.hpp"

namespace waymark {

enum class FilterKind { kEkf, kFastSlam };
[[nodiscard]] const char* filter_name(FilterKind kind);

enum class Association {
  kKnown,    ///< by their identities
  kNearest,  ///< EKF: those without identity pair by pair, the likeliest first
  kJcbb,     ///< EKF: those without identity by what they say together
  kMl        ///< FastSLAM: those without identity by maximum likelihood
};

/// Everything that decides a run besides its input. Enters once, is validated whole, is written beside the
/// result.
struct Config {
  FilterKind filter = FilterKind::kEkf;
  Observe observe = Observe::kRangeBearing;
  Association associate = Association::kKnown;
  std::uint64_t seed = 1;
  int threads = 1;
  InputOptions input;
  OdometryOptions odometry;
  LandmarkSensor sensor;
  CameraOptions camera;
  bool camera_known = true;  ///< no key: false where neither log nor user says what the camera is like
  MapOptions map;
  PipelineOptions pipeline;
  GateOptions gate;
  AssociationOptions association;
  EkfOptions ekf;
  PixelSlamOptions pixel;
  vision::TrackerOptions tracker;
  vision::SearchOptions search;
  markers::MarkerOptions markers;
  FastSlamOptions fastslam;
  SmoothOptions smooth;
  sim::SimOptions sim;
};

/// All keys. The schema refers to `config`, which must outlive it and stay where it is.
[[nodiscard]] Schema describe(Config& config);

/// A key that a flag of its own sets: `--filter ekf`.
struct FlagSetting {
  std::string flag;
  std::string key;
  std::string value;
};

/// What the user wants changed: files, then flags, then single keys, the later ones winning.
struct UserSettings {
  std::vector<std::filesystem::path> files;  ///< YAML; a later one ranks above those before
  std::vector<std::string> assignments;      ///< "key=value"
  std::vector<std::string> defaults;         ///< the same where neither the log nor the user says anything
  std::vector<FlagSetting> flags;
};

/// Sets what the user wants changed.
Result<void> apply(Schema& schema, const UserSettings& user);

/// A log, opened, with the config that holds for it.
struct OpenedInput {
  std::unique_ptr<Source> source;
  Config config;
};

/// Opens a log folder, a data set or `sim:SCENARIO`, and settles the config: defaults, then what the log
/// knows about its robot, then what the user says. Who says what markers there are wants them observed; then
/// the camera is the landmark sensor, and `sensor.x_m`, `y_m` and `yaw_deg` are those of its mount. Where
/// images are observed they come with their pixels.
[[nodiscard]] Result<OpenedInput> open_input(const std::string& input, const UserSettings& user);

/// The config alone: defaults, then what the user says.
[[nodiscard]] Result<Config> resolve_config(const UserSettings& user);

/// The simulated world of a scenario, changed by the user's `sim.` keys.
[[nodiscard]] Result<std::unique_ptr<Source>> open_simulation(const std::string& scenario,
                                                              const UserSettings& user);

}  // namespace waymark
