#include "workbench/live/light.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace waymark::live {
namespace {

constexpr double kSilentPeriods = 5.0;
constexpr double kSilent_s = 0.9;  // so that it shows within a second
constexpr double kDamaged = 0.02;
constexpr double kUnsupported_s = 10.0;

bool is_silent(const StreamSummary& stream) {
  const double period_s = stream.rate_hz > 0.0 ? 1.0 / stream.rate_hz : 0.0;
  return !stream.ended && stream.silent_s &&
         *stream.silent_s > std::max(kSilent_s, kSilentPeriods * period_s);
}

/// What is wrong with a stream; empty: nothing.
std::string trouble_of(const StreamSummary& stream) {
  if (!stream.fault.empty()) return fmt::format("{}: {}", stream.name, stream.fault);
  if (!stream.silent_s) return fmt::format("{}: nothing has come yet", stream.name);
  if (is_silent(stream)) return fmt::format("{}: silent for {:.1f} s", stream.name, *stream.silent_s);
  const auto all = static_cast<double>(stream.received + stream.bad);
  if (static_cast<double>(stream.bad) > kDamaged * all)
    return fmt::format("{}: {:.0f} % is damaged", stream.name, 100.0 * static_cast<double>(stream.bad) / all);
  return "";
}

bool brings_motion_now(const StreamSummary& stream) {
  return stream.brings_motion && stream.fault.empty() && !is_silent(stream);
}

}  // namespace

Light judge_now(std::span<const StreamSummary> streams, const FilterHealth& health,
                std::optional<double> unsupported_s) {
  Light light;
  const auto add = [&light](Trust level, std::string reason) {
    const bool is_gravest = level > light.level;
    light.level = std::max(light.level, level);
    light.reasons.insert(is_gravest ? light.reasons.begin() : light.reasons.end(), std::move(reason));
  };
  if (health.lost) add(Trust::kDoNotTrust, "the robot is lost: what it observes contradicts its map");
  if (std::ranges::none_of(streams, brings_motion_now)) add(Trust::kDoNotTrust, "no odometry");
  for (const StreamSummary& stream : streams)
    if (auto trouble = trouble_of(stream); !trouble.empty()) add(Trust::kUnsure, std::move(trouble));
  if (!unsupported_s)
    add(Trust::kUnsure, "no landmark was observed yet");
  else if (*unsupported_s > kUnsupported_s)
    add(Trust::kUnsure, fmt::format("no landmark for {:.0f} s", *unsupported_s));
  return light;
}

}  // namespace waymark::live
