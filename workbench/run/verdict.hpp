#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "workbench/run/evidence.hpp"

namespace waymark {

/// How far the result of a run may be trusted.
enum class Trust : std::uint8_t { kGood, kUnsure, kDoNotTrust };

/// "good", "unsure" or "do not trust".
[[nodiscard]] const char* name_of(Trust level);

struct Verdict {
  Trust level = Trust::kGood;
  std::vector<std::string> reasons;  ///< sentences with numbers, the gravest first
};

/// What the evidence amounts to: the level of its gravest part. docs/fault-isolation.md, "Verdict", derives
/// the limits. `nees_mean` of the pose, where the truth is known, is one more part.
[[nodiscard]] Verdict judge(const Evidence& evidence, const std::optional<double>& nees_mean = std::nullopt);

}  // namespace waymark
