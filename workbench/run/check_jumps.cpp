#include "workbench/run/check_jumps.hpp"

#include <fmt/format.h>

#include "waymark/slam/odometer.hpp"

namespace waymark {
namespace {

std::string when(const Occurrences& occurrences, Stamp start) {
  const double first_s = to_seconds(occurrences.first - start);
  return occurrences.count == 1 ? fmt::format("once, at {:.2f} s", first_s)
                                : fmt::format("{} times, first at {:.2f} s", occurrences.count, first_s);
}

}  // namespace

OdometryJumps jumps_of(const LogSample& sample, const Config& config) {
  Odometer odometer(config.odometry, config.pipeline.max_hold_s);
  for (const Event& event : sample.odometry) {
    static_cast<void>(odometer.advance(event.stamp, &event));
    odometer.add(event);
  }
  return odometer.jumps();
}

std::vector<std::string> describe(const OdometryJumps& jumps, Stamp start) {
  std::vector<std::string> lines;
  if (jumps.resets.count > 0)
    lines.push_back(
        fmt::format("the odometry jumps {}, farther than a robot can move: it was reset, or a counter "
                    "rolled over; the speed before the jump is taken until the next reading",
                    when(jumps.resets, start)));
  if (jumps.outliers.count > 0)
    lines.push_back(
        fmt::format("the odometry jumps away and back: readings were far off {}; they are left out",
                    when(jumps.outliers, start)));
  if (jumps.wraps.count > 0)
    lines.push_back(fmt::format("wheel angles wrap {}: they are unwrapped", when(jumps.wraps, start)));
  return lines;
}

}  // namespace waymark
