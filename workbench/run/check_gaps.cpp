#include "workbench/run/check_gaps.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "waymark/slam/odometer.hpp"

namespace waymark {

void GapSearch::add(const Event& event) {
  if (std::holds_alternative<Truth>(event.content)) return;
  if (!is_odometry(event.content)) return gaps_.see(event.stamp);
  const std::pair stream(event.content.index(), event.stream);
  if (!odometry_) odometry_ = stream;
  if (stream == *odometry_) gaps_.see_reading(event.stamp);
}

std::vector<std::string> describe(const std::vector<OdometryGap>& gaps, Stamp start, double max_hold_s) {
  if (gaps.empty()) return {};
  Duration whole{0};
  for (const OdometryGap& gap : gaps) whole += gap.to - gap.from;
  const auto& [from, to, at_end] =
      *std::ranges::max_element(gaps, {}, [](const OdometryGap& gap) { return gap.to - gap.from; });
  const std::string often = gaps.size() == 1 ? ""
                                             : fmt::format("{} times, {:.1f} s in all, the longest ",
                                                           gaps.size(), to_seconds(whole));
  return {fmt::format(
      "odometry is missing {}from {:.2f} s to {:.2f} s{}, longer than pipeline.max_hold_s "
      "({:.3g} s): the motion in that time is unknown",
      often, to_seconds(from - start), to_seconds(to - start), at_end ? ", the end" : "", max_hold_s)};
}

}  // namespace waymark
