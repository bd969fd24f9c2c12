#include "workshop/figures/consistency_report.hpp"

#include <nlohmann/json.hpp>

#include "workbench/logs/files.hpp"
#include "workbench/logs/json_text.hpp"
#include "workbench/report/pages.hpp"
#include "workbench/report/rounded.hpp"

namespace waymark {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const study::ConsistencyComparison::Mode& mode) {
  Json nees = Json::array();
  for (const double value : mode.result.nees) nees.push_back(rounded(value));
  return {{"name", mode.name},
          {"nees", nees},
          {"nees_mean", rounded(mode.result.nees_mean)},
          {"part_inside", rounded(mode.result.part_inside)},
          {"band", {rounded(mode.result.low), rounded(mode.result.high)}},
          {"position_rmse_m", rounded(mode.result.position_rmse_m)}};
}

Json to_json(const study::ConsistencyComparison& comparison) {
  const auto& options = comparison.options;
  Json modes = Json::array();
  for (const auto& mode : comparison.modes) modes.push_back(to_json(mode));
  return {{"runs", options.runs},
          {"steps", options.steps},
          {"landmarks", options.landmarks},
          {"odometry_sigma_m", rounded(options.odometry_sigma_m)},
          {"odometry_sigma_deg", rounded(to_degrees(options.odometry_sigma_rad))},
          {"range_sigma_m", rounded(options.range_sigma_m)},
          {"bearing_sigma_deg", rounded(to_degrees(options.bearing_sigma_rad))},
          {"modes", modes}};
}

}  // namespace

std::string render_consistency_report(const ConsistencyReport& report) {
  Json comparisons = Json::array();
  for (const auto& comparison : report.comparisons) comparisons.push_back(to_json(comparison));
  const Json data{{"version", WAYMARK_VERSION}, {"command", report.command}, {"comparisons", comparisons}};
  return fill_page(consistency_page(), json_text(data));
}

Result<void> write_consistency_report(const ConsistencyReport& report, const std::filesystem::path& path) {
  return write_file(path, render_consistency_report(report));
}

}  // namespace waymark
