#include "filter_flags.hpp"

namespace waymark::app {

void FilterFlags::add_to(CLI::App& command) {
  command.add_option("--filter", filter, "ekf (default) or fastslam")->type_name("NAME");
  command
      .add_option("--observe", observe,
                  "observations to use: range-bearing, range, bearing, pixel (corners in images) or markers "
                  "(ArUco or AprilTag markers in images); default: chosen by the log")
      ->type_name("KIND");
  command
      .add_option("--associate", associate,
                  "data association: known (by identity); for unknown identities nearest or jcbb (ekf), or "
                  "ml (fastslam); default: chosen by the log")
      ->type_name("HOW");
  command.add_option("--map", map, "continue from a saved map (map.waymark), starting at its pose")
      ->type_name("FILE");
  command.add_flag(
      "--localize", localize,
      "keep the map of --map unchanged and estimate only the pose; the robot may start anywhere in it");
  command.add_option("--particles", particles, "number of particles of FastSLAM")->type_name("N");
}

void FilterFlags::add_to(UserSettings& user) const {
  const auto set = [&user](const char* flag, const char* key, const std::string& value) {
    if (!value.empty()) user.flags.push_back({flag, key, value});
  };
  set("--filter", "filter", filter);
  set("--observe", "observe", observe);
  set("--associate", "associate", associate);
  set("--particles", "fastslam.particles", particles);
  set("--map", "map.file", map);
  set("--localize", "map.localize", localize ? "true" : "");
}

}  // namespace waymark::app
