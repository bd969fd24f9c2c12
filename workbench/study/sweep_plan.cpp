#include "workbench/study/sweep_plan.hpp"

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "workbench/run/make_filter.hpp"

namespace waymark::study {
namespace {

constexpr double kRunsMax = 1e6;
constexpr std::string_view kSeed = "seed";

/// The values of one block's axis for a column; one empty value where it has none.
std::vector<std::string> values_of(const std::vector<Axis>& block, const std::string& column) {
  const auto axis = std::ranges::find(block, column, &Axis::key);
  return axis == block.end() ? std::vector<std::string>{""} : axis->values;
}

double count(const std::vector<Axis>& block) {
  double runs = 1.0;
  for (const Axis& axis : block) runs *= static_cast<double>(axis.values.size());
  return runs;
}

std::vector<SweepPoint> points_of(const std::vector<Axis>& block, const std::vector<std::string>& columns) {
  std::vector<SweepPoint> points{{}};
  for (const auto& column : columns) {
    std::vector<SweepPoint> longer;
    for (const auto& point : points)
      for (const auto& value : values_of(block, column)) {
        longer.push_back(point);
        longer.back().push_back(value);
      }
    points = std::move(longer);
  }
  return points;
}

/// What a filter can work from.
Axis observable(FilterKind filter) {
  Axis axis{"observe", {}};
  for (const Observe observe : {Observe::kRangeBearing, Observe::kRange, Observe::kBearing}) {
    Config config;
    config.filter = filter;
    config.observe = observe;
    if (make_filter(config)) axis.values.push_back(describe(config).value("observe"));
  }
  return axis;
}

/// FNV-1a.
std::uint64_t hash(std::string_view text) {
  std::uint64_t value = 14695981039346656037ULL;
  for (const char c : text) value = (value ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  return value;
}

}  // namespace

std::vector<std::string> columns(const SweepPlan& plan) {
  std::vector<std::string> columns;
  for (const auto& block : plan.blocks)
    for (const Axis& axis : block)
      if (std::ranges::find(columns, axis.key) == columns.end()) columns.push_back(axis.key);
  std::ranges::stable_partition(columns, [](const auto& column) { return column == kSeed; });
  return columns;
}

std::vector<SweepPoint> points(const SweepPlan& plan) {
  const auto all_columns = columns(plan);
  std::vector<SweepPoint> points;
  for (const auto& block : plan.blocks)
    std::ranges::move(points_of(block, all_columns), std::back_inserter(points));
  std::set<SweepPoint> seen;
  std::erase_if(points, [&seen](const auto& point) { return !seen.insert(point).second; });
  if (!all_columns.empty() && all_columns.front() == kSeed)
    std::ranges::stable_sort(points, {}, [](const SweepPoint& point) {
      return std::pair(point.front().size(), point.front());  // whole numbers in their order
    });
  return points;
}

UserSettings settings(const SweepPlan& plan, const SweepPoint& point) {
  UserSettings user = plan.user;
  const auto keys = columns(plan);
  for (std::size_t i = 0; i < keys.size(); ++i)
    if (!point[i].empty()) user.assignments.push_back(keys[i] + "=" + point[i]);
  return user;
}

Result<void> check(const SweepPlan& plan) {
  double runs = 0.0;
  for (const auto& block : plan.blocks) {
    std::set<std::string> keys;
    for (const Axis& axis : block)
      if (!keys.insert(axis.key).second)
        return Error{fmt::format("--axis: {} is given twice; list its values in one", axis.key)};
    runs += count(block);
  }
  if (runs > kRunsMax)
    return Error{fmt::format(
        "--axis: {:.0f} runs are too many, at most {:.0f} are possible; give fewer values", runs, kRunsMax)};
  return {};
}

Result<std::uint64_t> fingerprint(const SweepPlan& plan) {
  auto config = resolve_config(plan.user);
  if (!config) return config.error();
  std::string text = plan.input + "\n" + describe(*config).to_yaml();
  for (const auto& column : columns(plan)) text += "\n" + column;
  return hash(text);
}

SweepPlan study_plan() {
  constexpr int kSeeds = 20;
  Axis seed{std::string(kSeed), {}};
  for (int i = 1; i <= kSeeds; ++i) seed.values.push_back(std::to_string(i));
  const Axis particles{"fastslam.particles", {"10", "30", "75", "150", "400", "1000", "4000"}};
  return {.input = "sim:study",
          .user = {},
          .blocks = {{seed, {"filter", {"fastslam"}}, observable(FilterKind::kFastSlam), particles},
                     {seed, {"filter", {"ekf"}}, observable(FilterKind::kEkf)}}};
}

}  // namespace waymark::study
