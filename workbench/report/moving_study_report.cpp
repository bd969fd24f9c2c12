#include "workbench/report/moving_study_report.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "waymark/core/angle.hpp"

#include "workbench/logs/files.hpp"
#include "workbench/logs/json_text.hpp"
#include "workbench/report/findings_text.hpp"
#include "workbench/report/noise_chart.hpp"
#include "workbench/report/pages.hpp"
#include "workbench/report/rounded.hpp"

namespace waymark {
namespace {

using calibrate::MovingStudy;
using calibrate::NoiseBin;
using Json = nlohmann::ordered_json;

std::string rows(const std::vector<NoiseBin>& bins, const char* axis, double unit) {
  std::string text = fmt::format("  {:>14}{:>8}{:>12}{:>12}\n", axis, "count", "mean", "sigma");
  for (const NoiseBin& bin : bins)
    text += fmt::format("  {:>14.2f}{:>8}{:>12.4f}{:>12.4f}\n", (unit == 1.0 ? 1.0 : unit) * bin.at,
                        bin.count, unit * bin.mean, unit * bin.sigma.value);
  return text;
}

Json json_of(const std::vector<NoiseBin>& bins, const char* axis, double unit) {
  Json list = Json::array();
  for (const NoiseBin& bin : bins)
    list.push_back({{axis, rounded(unit * bin.at)},
                    {"count", bin.count},
                    {"mean", rounded(unit * bin.mean)},
                    {"sigma", rounded(unit * bin.sigma.value)}});
  return list;
}

/// As rows of a table.
Json found(const MovingStudy& study) {
  Json list = Json::array();
  const Json by_key = Json::parse(findings_json(study.findings));
  for (const auto& [name, finding] : by_key.items()) {
    list.push_back(finding);
    list.back()["name"] = name;
  }
  return list;
}

}  // namespace

std::string to_text(const MovingStudy& study) {
  std::string text = findings_text(study.findings, study.runs, study.input);
  text += rows(study.noise.ranges, "range, m", 1.0);
  text += rows(study.noise.bearings, "bearing, deg", to_degrees(1.0));
  for (const auto& note : study.notes) text += fmt::format("  note: {}\n", note);
  return text;
}

std::string to_json(const MovingStudy& study) {
  Json json{{"input", study.input},
            {"runs", study.runs},
            {"settled", study.settled},
            {"found", Json::parse(findings_json(study.findings))},
            {"ranges", json_of(study.noise.ranges, "range_m", 1.0)},
            {"bearings", json_of(study.noise.bearings, "bearing_deg", to_degrees(1.0))},
            {"odometry_noise", Json::array()},
            {"outliers", study.noise.outliers},
            {"notes", study.notes}};
  for (const calibrate::Value& times : study.odometry_noise)
    json["odometry_noise"].push_back({{"value", rounded(times.value)}, {"sigma", rounded(times.sigma)}});
  return json_text(json, 2) + "\n";
}

std::string render_report(const MovingStudy& study, const std::string& command) {
  Json json{{"title", "Noise of a sensor on a moving robot"},
            {"subtitle", fmt::format("From {} alone, in {} runs: residuals of the observations against path "
                                     "and map smoothed over the whole log",
                                     study.input, study.runs)}};
  json["version"] = WAYMARK_VERSION;
  json["command"] = command;
  json["config_yaml"] = to_yaml(study);
  json["notes"] = study.notes;
  json["found"] = found(study);
  json["charts"] = Json::parse(noise_charts_json(study.noise.ranges, study.noise.bearings));
  return fill_page(sensor_page(), json_text(json));
}

Result<void> write_results(const MovingStudy& study, const std::filesystem::path& folder,
                           const std::string& command) {
  if (auto done = write_file(folder / "calibration.yaml", to_yaml(study)); !done) return done;
  if (auto done = write_file(folder / "calibration.json", to_json(study)); !done) return done;
  return write_file(folder / "report.html", render_report(study, command));
}

}  // namespace waymark
