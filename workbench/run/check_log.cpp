#include "workbench/run/check_log.hpp"

#include "workbench/run/check_fit.hpp"
#include "workbench/run/check_units.hpp"

namespace waymark {

std::vector<std::string> contradictions_in(const LogSample& sample, const Config& config) {
  const auto fit = fit_of(sample, config);
  if (fit && !fit->contradicts() && fit->moved_m > 2.0 * fit->noise_m) return {};
  const bool is_explained = fit && !fit->mistake.empty();
  auto lines = is_explained ? std::vector<std::string>{} : check_units(sample, config);
  if (auto line = fit ? describe(*fit) : std::nullopt; line && lines.empty())
    lines.push_back(*std::move(line));
  return lines;
}

std::string describe_missing_odometry(const LogInfo& log) {
  return log.topics.empty()
             ? "nothing can be run: there is no odometry (expected wheels.csv, velocity.csv, steering.csv or "
               "odometry.csv)"
             : "nothing can be run: there is no odometry (expected a topic of type nav_msgs/Odometry, "
               "sensor_msgs/JointState, geometry_msgs/TwistStamped, Twist or PoseStamped)";
}

}  // namespace waymark
