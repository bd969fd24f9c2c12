#include "workbench/run/pose_losses.hpp"

#include <algorithm>
#include <cstddef>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace waymark {
namespace {

constexpr std::size_t kMostTimes = 5;  // that a line names

std::string when(const LostSpan& span, Stamp start) {
  const double from_s = to_seconds(span.from - start);
  if (!span.found) return fmt::format("from {:.1f} s to the end", from_s);
  return fmt::format("from {:.1f} to {:.1f} s", from_s, to_seconds(*span.found - start));
}

std::string list(std::vector<std::string> times) {
  const std::size_t count = times.size();
  times.resize(std::min(count, kMostTimes));
  const std::string more = count > kMostTimes ? fmt::format(" and {} times more", count - kMostTimes) : "";
  return fmt::format("{}{} after the start", fmt::join(times, ", "), more);
}

}  // namespace

void PoseLosses::add(Stamp stamp, const FilterHealth& health) {
  if (health.slips > before_.slips) slips_.push_back(stamp);
  const bool was_lost = !lost_.empty() && !lost_.back().found;
  const bool is_found = health.recoveries > before_.recoveries;
  if (!was_lost && (health.lost || is_found)) lost_.push_back({stamp, std::nullopt});
  if (!health.lost && (was_lost || is_found)) lost_.back().found = stamp;
  before_ = health;
}

std::vector<std::string> describe(const PoseLosses& losses, Stamp start) {
  std::vector<std::string> lines, slips, lost;
  for (const Stamp stamp : losses.slips())
    slips.push_back(fmt::format("at {:.1f} s", to_seconds(stamp - start)));
  for (const LostSpan& span : losses.lost()) lost.push_back(when(span, start));
  if (!slips.empty()) lines.push_back(fmt::format("the robot slipped {}", list(std::move(slips))));
  if (!lost.empty())
    lines.push_back(
        fmt::format("the robot was lost {}: what it observed contradicted its map", list(std::move(lost))));
  return lines;
}

}  // namespace waymark
