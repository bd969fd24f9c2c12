#include "workbench/study/sweep_summary.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

namespace waymark::study {
namespace {

/// Linear between the nearest ranks; `sorted` is.
double quantile(const std::vector<double>& sorted, double q) {
  if (sorted.empty()) return kUnknownFigure;
  const double place = q * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const auto above = std::min(below + 1, sorted.size() - 1);
  return std::lerp(sorted[below], sorted[above], place - static_cast<double>(below));
}

bool has_diverged(const Figures& figures) {
  return figures[figure_index("position_rmse_m")] > figures[figure_index("odometry_position_rmse_m")];
}

void fill_quantiles(std::span<const SweepRow* const> rows, SweepGroup& group) {
  for (std::size_t i = 0; i < kFigureNames.size(); ++i) {
    std::vector<double> values;
    for (const SweepRow* row : rows)
      if (!std::isnan(row->figures[i])) values.push_back(row->figures[i]);
    std::ranges::sort(values);
    group.median[i] = quantile(values, 0.5);
    group.low[i] = quantile(values, 0.25);
    group.high[i] = quantile(values, 0.75);
  }
}

SweepGroup make_group(std::vector<std::string> values, std::span<const SweepRow* const> rows) {
  SweepGroup group{.values = std::move(values)};
  for (const SweepRow* row : rows) {
    (row->error.empty() ? group.runs : group.failed) += 1;
    group.diverged += has_diverged(row->figures) ? 1 : 0;
  }
  fill_quantiles(rows, group);
  return group;
}

/// Of the axes: their longest text and two blanks.
std::vector<std::size_t> column_widths(const SweepSummary& summary) {
  std::vector<std::size_t> widths;
  for (std::size_t i = 0; i < summary.axes.size(); ++i) {
    widths.push_back(summary.axes[i].size() + 2);
    for (const auto& group : summary.groups) widths[i] = std::max(widths[i], group.values[i].size() + 2);
  }
  return widths;
}

}  // namespace

std::size_t figure_index(std::string_view name) {
  return static_cast<std::size_t>(std::ranges::find(kFigureNames, name) - kFigureNames.begin());
}

SweepSummary summarise(const SweepPlan& plan, std::span<const SweepRow> rows) {
  SweepSummary summary{columns(plan), {}};
  const bool has_seed = !summary.axes.empty() && summary.axes.front() == "seed";
  if (has_seed) summary.axes.erase(summary.axes.begin());
  std::vector<std::vector<std::string>> order;
  std::map<std::vector<std::string>, std::vector<const SweepRow*>> members;
  for (const SweepRow& row : rows) {
    std::vector<std::string> values(row.point.begin() + (has_seed ? 1 : 0), row.point.end());
    auto& group = members[values];
    if (group.empty()) order.push_back(std::move(values));
    group.push_back(&row);
  }
  for (auto& values : order) {
    const auto& group = members[values];
    summary.groups.push_back(make_group(std::move(values), group));
  }
  return summary;
}

std::string to_text(const SweepSummary& summary) {
  constexpr std::array<std::pair<const char*, const char*>, 6> kShown{
      {{"position_rmse_m", "path m"},
       {"position_rmse_aligned_m", "aligned m"},
       {"landmark_rmse_m", "map m"},
       {"nees_median", "NEES"},
       {"step_mean_us", "step us"},
       {"frobenius_mixture_m2", "Frob. m2"}}};
  const auto widths = column_widths(summary);
  std::string text;
  for (std::size_t i = 0; i < widths.size(); ++i) text += fmt::format("{:<{}}", summary.axes[i], widths[i]);
  text += fmt::format("{:>6}{:>9}", "runs", "diverged");
  for (const auto& [name, title] : kShown) text += fmt::format("{:>11}", title);
  for (const auto& group : summary.groups) {
    text += '\n';
    for (std::size_t i = 0; i < widths.size(); ++i) text += fmt::format("{:<{}}", group.values[i], widths[i]);
    text += fmt::format("{:>6}{:>9}", group.runs, group.diverged);
    for (const auto& [name, title] : kShown) {
      const double value = group.median[figure_index(name)];
      text += std::isnan(value) ? fmt::format("{:>11}", "-") : fmt::format("{:>11.4g}", value);
    }
    if (group.failed > 0) text += fmt::format("  ({} failed)", group.failed);
  }
  return text + "\n";
}

}  // namespace waymark::study
