#include "workbench/report/log_calibration_report.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "workbench/eval/path_alignment.hpp"
#include "workbench/eval/trajectory_error.hpp"
#include "workbench/logs/files.hpp"
#include "workbench/logs/json_text.hpp"
#include "workbench/report/findings_text.hpp"
#include "workbench/report/pages.hpp"
#include "workbench/report/path_series.hpp"
#include "workbench/report/report_json.hpp"
#include "workbench/report/rounded.hpp"

namespace waymark {
namespace {

using calibrate::Drift;
using calibrate::DriftPair;
using calibrate::LogCalibration;
using Json = nlohmann::ordered_json;

constexpr const char* kWholeLog = "the smoothed path";

Json json_of(const Drift& drift) {
  return {{"final_m", rounded(drift.final_m)},
          {"final_heading_deg", rounded(drift.final_heading_deg)},
          {"percent", rounded(drift.percent())},
          {"rmse_m", rounded(drift.rmse_m)},
          {"rmse_aligned_m", rounded(drift.rmse_aligned_m)}};
}

Json json_of(const DriftPair& pair) {
  return {{"path_m", rounded(pair.before.path_m)},
          {"before", json_of(pair.before)},
          {"after", json_of(pair.after)}};
}

Json json_of(const LogCalibration& c) {
  Json json{{"input", c.input},
            {"runs", c.passes},
            {"settled", c.settled},
            {"found", Json::parse(findings_json(c.findings))},
            {"notes", c.notes}};
  if (c.drift) json["drift"] = json_of(*c.drift);
  if (c.drift_from_truth) json["drift_from_truth"] = json_of(*c.drift_from_truth);
  return json;
}

std::string row(const char* what, const Drift& drift) {
  return fmt::format("  {:<30}{:>9.3f} m{:>9.1f} deg{:>8.1f} %{:>9.3f} m{:>9.3f} m\n", what, drift.final_m,
                     drift.final_heading_deg, drift.percent(), drift.rmse_m, drift.rmse_aligned_m);
}

std::string text_of(const DriftPair& pair, const char* reference) {
  return fmt::format(
             "dead reckoning compared with {} ({:.1f} m)\n"
             "  {:<30}{:>11}{:>13}{:>10}{:>11}{:>11}\n",
             reference, pair.before.path_m, "", "at the end", "heading", "of path", "RMSE", "aligned") +
         row("as configured", pair.before) + row("calibrated", pair.after);
}

/// Distance from the path by the whole log over time.
Json distances(const Trajectory& dead_reckoning, const LogCalibration& c, Stamp start) {
  const auto pairs = eval::associate(dead_reckoning, eval::TruthTrack::from_trajectory(c.smoothed));
  const auto anchor = eval::anchor_at_start(pairs);
  PathSeries series;
  if (anchor)
    for (const auto& error : eval::errors(pairs, anchor->T_truth_estimate)) {
      series.t_s.push_back(to_seconds(error.stamp - start));
      series.x_m.push_back(error.position_m.norm());
      series.y_m.push_back(0.0);
    }
  return {{"t", series.t_s}, {"m", series.x_m}};
}

/// Where the truth lies in the frame of the run.
Pose2 truth_in_run(const LogCalibration& c) {
  const auto anchor = eval::anchor_at_start(eval::associate(c.smoothed, c.truth));
  return anchor ? anchor->T_truth_estimate.inverse() : Pose2{};
}

Json map_of(const LogCalibration& c, Stamp start) {
  ReportData map;
  map.truth = path_series(c.truth, truth_in_run(c), start);
  map.dead_reckoning.path = path_series(c.dead_reckoning_before, {}, start);
  RunData run;
  run.name = "Odometry, calibrated";
  run.path = path_series(c.dead_reckoning_after, {}, start);
  run.smoothed = path_series(c.smoothed, {}, start);
  map.runs.push_back(std::move(run));
  return Json::parse(report_json(map));
}

}  // namespace

std::string to_text(const LogCalibration& c) {
  std::string text = findings_text(c.findings, c.passes, c.input);
  if (c.drift) text += text_of(*c.drift, kWholeLog);
  if (c.drift_from_truth) text += text_of(*c.drift_from_truth, "ground truth");
  for (const auto& note : c.notes) text += fmt::format("  note: {}\n", note);
  return text;
}

std::string to_json(const LogCalibration& calibration) { return json_text(json_of(calibration), 2) + "\n"; }

std::string render_report(const LogCalibration& c, const std::string& command) {
  Json json = json_of(c);
  const Stamp start = c.smoothed.empty() ? Stamp{} : c.smoothed.front().stamp;
  json["title"] = c.log.name + ": calibration of its robot";
  json["version"] = WAYMARK_VERSION;
  json["command"] = command;
  json["config_yaml"] = to_yaml(c);
  json["map"] = map_of(c, start);
  json["distance"] = {{"before", distances(c.dead_reckoning_before, c, start)},
                      {"after", distances(c.dead_reckoning_after, c, start)}};
  return fill_page(calibration_page(), json_text(json));
}

Result<void> write_results(const LogCalibration& calibration, const std::filesystem::path& folder,
                           const std::string& command) {
  if (auto done = write_file(folder / "calibration.yaml", to_yaml(calibration)); !done) return done;
  if (auto done = write_file(folder / "calibration.json", to_json(calibration)); !done) return done;
  return write_file(folder / "report.html", render_report(calibration, command));
}

}  // namespace waymark
