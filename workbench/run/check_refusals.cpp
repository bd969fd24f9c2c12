#include "workbench/run/check_refusals.hpp"

#include <algorithm>
#include <functional>
#include <iterator>
#include <map>
#include <utility>

#include <fmt/format.h>

namespace waymark {
namespace {

struct Refusals {
  Stamp first;
  int refused = 0;
  int observed = 0;  ///< since the first
  int in_a_row = 0;  ///< the last ones
  int matched = 0;
  bool moved = false;  ///< the filter put the landmark elsewhere
  void add(Stamp stamp, Outcome outcome) {
    const bool is_refused = outcome == Outcome::kGated || outcome == Outcome::kDistrusted;
    if (is_refused && refused++ == 0) first = stamp;
    if (refused > 0) ++observed;
    if (outcome == Outcome::kMatched) ++matched;
    moved = moved || (outcome == Outcome::kAdded && in_a_row >= 2 && matched >= 3);
    in_a_row = is_refused ? in_a_row + 1 : 0;
  }

  [[nodiscard]] bool again_and_again() const { return moved || (refused >= 10 && 5 * refused >= observed); }
};

using RefusedLandmark = std::pair<LandmarkId, Refusals>;

/// Corners have identities, too, but nobody has put them up.
bool is_marker(LandmarkId id) {
  return id.family == LandmarkId::Family::kMarker || id.family == LandmarkId::Family::kBarcode;
}

std::string describe(const RefusedLandmark& landmark, Stamp start) {
  const auto& [id, of] = landmark;
  return fmt::format(
      "landmark {}: {} of {} observations refused since {:.2f} s: it was moved, or two landmarks have "
      "this identity",
      to_string(id), of.refused, of.observed, to_seconds(of.first - start));
}

}  // namespace

std::vector<std::string> describe_refused_landmarks(
    const std::vector<Recording::TimedInnovation>& innovations, Stamp start) {
  constexpr std::size_t kMany = 4;
  std::map<LandmarkId, Refusals> all;
  for (const auto& [stamp, innovation] : innovations)
    if (is_marker(innovation.landmark)) all[innovation.landmark].add(stamp, innovation.outcome);
  std::vector<RefusedLandmark> refused;
  std::ranges::copy_if(all, std::back_inserter(refused),
                       [](const auto& each) { return each.second.again_and_again(); });
  if (all.size() >= kMany && 2 * refused.size() > all.size())
    return {fmt::format(
        "observations of {} of {} landmarks are refused again and again: the filter is lost, or odometry "
        "and observations do not fit each other",
        refused.size(), all.size())};
  std::ranges::stable_sort(refused, std::ranges::greater{},
                           [](const auto& each) { return each.second.refused; });
  std::vector<std::string> lines;
  for (const RefusedLandmark& each : refused) lines.push_back(describe(each, start));
  return lines;
}

}  // namespace waymark
