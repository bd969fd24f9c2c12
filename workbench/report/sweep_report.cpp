#include "workbench/report/sweep_report.hpp"

#include <array>
#include <cmath>

#include <nlohmann/json.hpp>

#include "workbench/logs/files.hpp"
#include "workbench/logs/json_text.hpp"
#include "workbench/report/pages.hpp"
#include "workbench/report/rounded.hpp"

namespace waymark {
namespace {

using Json = nlohmann::ordered_json;

/// A row of the figures that the FastSLAM report read off its runs on a real Pioneer 3-DX; the path RMSE
/// there is against odometry after a Procrustes fit.
struct Published {
  const char* observe;
  int particles;
  double path_rmse_m;
  double landmark_rmse_m;
  double step_ms;
  std::array<double, 2> frobenius_m2;  ///< smallest and largest over N
};

constexpr std::array<Published, 6> kPublished{{{"range-bearing", 150, 0.38, 0.56, 31.0, {0.065, 0.065}},
                                               {"range-bearing", 1000, 0.45, 0.55, 178.0, {0.065, 0.065}},
                                               {"range", 150, 0.56, 0.41, 14.0, {0.68, 0.79}},
                                               {"range", 1000, 0.64, 0.40, 68.0, {0.68, 0.79}},
                                               {"bearing", 150, 0.64, 2.32, 12.0, {0.83, 0.94}},
                                               {"bearing", 1000, 0.89, 2.47, 68.0, {0.83, 0.94}}}};

Json group_json(const study::SweepSummary& summary, const study::SweepGroup& group) {
  Json json{
      {"axes", Json::object()}, {"runs", group.runs}, {"failed", group.failed}, {"diverged", group.diverged}};
  for (std::size_t i = 0; i < summary.axes.size(); ++i)
    if (!group.values[i].empty()) json["axes"][summary.axes[i]] = group.values[i];
  for (std::size_t i = 0; i < study::kFigureNames.size(); ++i)
    if (!std::isnan(group.median[i]))
      json["figures"][std::string(study::kFigureNames[i])] = {rounded(group.low[i]), rounded(group.median[i]),
                                                              rounded(group.high[i])};
  return json;
}

Json groups_json(const study::SweepSummary& summary) {
  Json groups = Json::array();
  for (const auto& group : summary.groups) groups.push_back(group_json(summary, group));
  return groups;
}

Json published_json() {
  Json rows = Json::array();
  for (const auto& row : kPublished)
    rows.push_back({{"observe", row.observe},
                    {"particles", row.particles},
                    {"path_rmse_m", row.path_rmse_m},
                    {"landmark_rmse_m", row.landmark_rmse_m},
                    {"step_ms", row.step_ms},
                    {"frobenius_m2", row.frobenius_m2}});
  return rows;
}

}  // namespace

std::string render_sweep_report(const SweepReport& report) {
  const Json data{{"input", report.input},        {"command", report.command},
                  {"version", WAYMARK_VERSION},   {"runs", report.runs},
                  {"axes", report.summary.axes},  {"groups", groups_json(report.summary)},
                  {"published", published_json()}};
  return fill_page(sweep_page(), json_text(data));
}

Result<void> write_sweep_report(const SweepReport& report, const std::filesystem::path& path) {
  return write_file(path, render_sweep_report(report));
}

std::string sweep_json_text(const study::SweepSummary& summary) {
  return json_text(Json{{"groups", groups_json(summary)}}, 2);
}

}  // namespace waymark
