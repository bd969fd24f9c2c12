#include "workbench/run/verdict.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "waymark/core/chi2.hpp"

namespace waymark {
namespace {

// Variances that are too small by these factors. With the first the mean NEES of a pose is 6 instead of 3;
// with the second an error is three times as large as the standard deviation that it is told with.
constexpr double kTolerated = 2.0;
constexpr double kUseless = 9.0;
// One run in a hundred is called worse than it is by one part of its evidence, at most.
constexpr double kFalseAlarm = 0.01;
// A ratio of this many degrees of freedom passes as consistent at kUseless with a probability of 1 %.
constexpr double kMinDof = 10.0;
constexpr double kMostly = 0.5;

struct Finding {
  Trust level = Trust::kGood;
  std::string reason;
};
using MaybeFinding = std::optional<Finding>;

/// The largest ratio that chance or tolerated errors of the model explain.
double upper_limit(const VarianceRatio& ratio) {
  return std::max(kTolerated, chi2_quantile(1.0 - kFalseAlarm, ratio.dof) / ratio.dof);
}

Trust grade(const VarianceRatio& ratio) {
  const double limit = upper_limit(ratio);
  if (ratio.value > std::max(limit, kUseless)) return Trust::kDoNotTrust;
  return ratio.value > limit ? Trust::kUnsure : Trust::kGood;
}

MaybeFinding judge_amount(const Evidence& e) {
  if (e.matched == 0 && e.deferred > 0)
    return Finding{Trust::kDoNotTrust,
                   fmt::format("no landmark could be placed from {} observations of range or bearing alone: "
                               "this path is dead reckoning",
                               e.deferred)};
  if (e.matched == 0)
    return Finding{Trust::kDoNotTrust, "no landmark was observed twice: this path is dead reckoning"};
  if (e.innovations.dof < kMinDof)
    return Finding{Trust::kUnsure,
                   fmt::format("{} observations of known landmarks are too few to judge by", e.matched)};
  return std::nullopt;
}

/// Of one standard deviation, which is what people set.
double times(const VarianceRatio& ratio) { return std::sqrt(ratio.value); }

MaybeFinding judge_innovations(const Evidence& e) {
  if (e.innovations.dof < kMinDof) return std::nullopt;
  const Trust level = grade(e.innovations);
  if (level != Trust::kGood)
    return Finding{
        level, fmt::format("innovations are {:.1f} times as large as expected: observations or odometry are "
                           "worse than sensor.*_sigma_* and motion.* say",
                           times(e.innovations))};
  if (e.innovations.value < 1.0 / kTolerated)
    return Finding{Trust::kUnsure,
                   fmt::format("innovations are {:.2f} times as large as expected: false observations "
                               "pass the gate; sensor.*_sigma_* or motion.* are too large",
                               times(e.innovations))};
  return Finding{Trust::kGood,
                 fmt::format("innovations are {:.2f} times as large as expected, in {:.0f} observations",
                             times(e.innovations), e.innovations.dof)};
}

MaybeFinding judge_blocks(const Evidence& e) {
  if (e.blocks.dof < kMinDof) return std::nullopt;
  const Trust level = grade(e.blocks);
  if (level == Trust::kGood) return std::nullopt;
  return Finding{
      level, fmt::format("successive innovations of a landmark are alike: {} of them say as much as {:.1f}",
                         kInnovationBlock, kInnovationBlock / e.blocks.value)};
}

MaybeFinding judge_departure(const Evidence& e) {
  if (e.departure.dof < kMinDof) return std::nullopt;
  const Trust level = grade(e.departure);
  const std::string text =
      fmt::format("the path departs from odometry {:.1f} times as far as motion.* says", times(e.departure));
  if (level == Trust::kGood) return Finding{level, text};
  return Finding{level, text + ": wheel radii, track or sensor.delay_s may be wrong"};
}

double share(double part, double all) { return all > 0.0 ? part / all : 0.0; }

MaybeFinding judge_gated(const Evidence& e) {
  const double gated = share(static_cast<double>(e.gated), static_cast<double>(e.gated + e.matched));
  const std::string text =
      fmt::format("{:.1f} % of the observations were rejected by the gate", 100.0 * gated);
  if (gated > kMostly) return Finding{Trust::kDoNotTrust, text};
  return Finding{gated > kManyOutliers ? Trust::kUnsure : Trust::kGood, text};
}

/// "1 time", "2 times".
std::string counted(int count, const char* what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

MaybeFinding judge_robot(const Evidence& e) {
  if (e.health.lost)
    return Finding{Trust::kDoNotTrust, "the robot is lost at the end: what it observes contradicts its map"};
  if (e.health.recoveries == 0) return std::nullopt;
  return Finding{Trust::kUnsure,
                 fmt::format("the robot was lost and found again {}", counted(e.health.recoveries, "time"))};
}

MaybeFinding judge_landmarks(const Evidence& e) {
  if (e.health.carried == 0) return std::nullopt;
  return Finding{
      Trust::kUnsure,
      fmt::format("{} found elsewhere than before, and {} more than once: carried, or two bear one identity",
                  counted(e.health.carried, "landmark"), e.health.distrusted)};
}

MaybeFinding judge_misfit(const Evidence& e) {
  if (e.misfit.log_probability > std::log(kFalseAlarm)) return std::nullopt;
  return Finding{
      Trust::kUnsure,
      fmt::format("{} of {} observations {:.1f} s after the start match no landmark that was known before: "
                  "the robot was carried, or observations were missing",
                  e.misfit.unmatched, e.misfit.observations, e.misfit.since_start_s)};
}

MaybeFinding judge_unaided(const Evidence& e) {
  const double unaided = share(e.unaided_m, e.travelled_m);
  if (unaided <= kMostly) return std::nullopt;
  return Finding{Trust::kUnsure, fmt::format("{:.0f} % of the way ({:.1f} m) was driven by odometry alone",
                                             100.0 * unaided, e.unaided_m)};
}

MaybeFinding judge_nees(const std::optional<double>& nees_mean) {
  if (!nees_mean) return std::nullopt;
  const double ratio = *nees_mean / 3.0;
  const std::string text =
      fmt::format("errors from the truth are {:.1f} times as large as expected (mean NEES {:.1f}, ideal 3)",
                  std::sqrt(ratio), *nees_mean);
  if (ratio > kUseless) return Finding{Trust::kDoNotTrust, text};
  return Finding{ratio > kTolerated ? Trust::kUnsure : Trust::kGood, text};
}

/// What is good is only told where all is.
Verdict conclude(const std::vector<MaybeFinding>& findings) {
  Verdict verdict;
  for (const Trust level : {Trust::kDoNotTrust, Trust::kUnsure, Trust::kGood}) {
    if (level == Trust::kGood && !verdict.reasons.empty()) break;
    for (const MaybeFinding& finding : findings)
      if (finding && finding->level == level) verdict.reasons.push_back(finding->reason);
    if (!verdict.reasons.empty()) verdict.level = std::max(verdict.level, level);
  }
  return verdict;
}

}  // namespace

const char* name_of(Trust level) {
  switch (level) {
    case Trust::kGood:
      return "good";
    case Trust::kUnsure:
      return "unsure";
    case Trust::kDoNotTrust:
      return "do not trust";
  }
  return "unsure";
}

Verdict judge(const Evidence& evidence, const std::optional<double>& nees_mean) {
  return conclude({judge_nees(nees_mean), judge_robot(evidence), judge_amount(evidence),
                   judge_innovations(evidence), judge_gated(evidence), judge_departure(evidence),
                   judge_blocks(evidence), judge_unaided(evidence), judge_misfit(evidence),
                   judge_landmarks(evidence)});
}

}  // namespace waymark
