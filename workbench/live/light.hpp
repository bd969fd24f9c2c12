#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "waymark/core/filter_health.hpp"

#include "workbench/live/stream_state.hpp"
#include "workbench/run/verdict.hpp"

namespace waymark::live {

/// How a session does at this moment: whether its pose of now may be trusted, and why not.
struct Light {
  Trust level = Trust::kGood;
  std::vector<std::string> reasons;  ///< the gravest first
};

/// What shows within a second. Do not trust: the robot is lost, or nothing brings motion. Unsure: a stream
/// has failed, is silent for longer than five of its periods and a second, or brings more than 2 % of damage;
/// or nothing that is in the map was observed for 10 s. `unsupported_s` is the time since then; empty:
/// nothing was ever observed.
[[nodiscard]] Light judge_now(std::span<const StreamSummary> streams, const FilterHealth& health,
                              std::optional<double> unsupported_s);

}  // namespace waymark::live
