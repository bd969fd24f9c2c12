#include "workbench/run/acting_keys.hpp"

#include <algorithm>
#include <array>

namespace waymark {
namespace {

/// Keys that begin alike.
struct Part {
  std::string_view prefix;
  bool acts;
};

}  // namespace

bool can_act(std::string_view key, const Config& config, const LogInfo& log,
             std::optional<OdometryKind> odometry) {
  const bool is_ekf = config.filter == FilterKind::kEkf;
  const bool pixels = config.observe == Observe::kPixel;
  const bool markers = config.observe == Observe::kMarkers;
  const bool is_bag = !log.topics.empty();
  const bool is_data_set = !is_bag && log.format != "simulation" && log.format != "log folder";
  const bool finds_scales = config.smooth.run || (is_ekf && config.ekf.odometry.estimate);
  const bool steers = odometry == OdometryKind::kSteering;
  const bool has_wheels = odometry == OdometryKind::kWheels;
  // The first that fits counts.
  const std::array parts{Part{"sim.", log.format == "simulation"},
                         Part{"input.robot", is_data_set},
                         Part{"input.run", is_data_set},
                         Part{"input.fix_known_errors", is_data_set},
                         Part{"input.pixel_noise_px", is_data_set},
                         Part{"input.", is_bag},
                         Part{"wheels.", has_wheels},
                         Part{"car.", steers},
                         Part{"motion.wheel_var", has_wheels || steers},
                         Part{"motion.steer_var", steers},
                         Part{"motion.speed_scale_sigma", finds_scales},
                         Part{"motion.turn_scale_sigma", finds_scales},
                         Part{"motion.turn_bias_sigma", finds_scales},
                         Part{"motion.outer_point_m", odometry == OdometryKind::kVelocity},
                         Part{"sensor.delay_s", true},
                         Part{"sensor.", !pixels},
                         Part{"camera.mount_", pixels || markers || is_bag},
                         Part{"camera.", pixels || markers},
                         Part{"markers.", markers},
                         Part{"map.localize", !config.map.file.empty()},
                         Part{"gate.", !pixels},
                         Part{"association.", config.associate != Association::kKnown},
                         Part{"ekf.consistency", is_ekf},
                         Part{"ekf.", is_ekf && !pixels},
                         Part{"pixel.", pixels},
                         Part{"tracker.", pixels},
                         Part{"corners.", pixels},
                         Part{"search.", pixels},
                         Part{"fastslam.", !is_ekf},
                         Part{"smooth.run", true},
                         Part{"smooth.", config.smooth.run}};
  const auto* const part =
      std::ranges::find_if(parts, [key](const Part& each) { return key.starts_with(each.prefix); });
  return part == parts.end() || part->acts;
}

std::string acting_yaml(Config config, const LogInfo& log, std::optional<OdometryKind> odometry) {
  const Schema schema = describe(config);
  return schema.to_yaml([&](const std::string& key) { return can_act(key, config, log, odometry); });
}

}  // namespace waymark
