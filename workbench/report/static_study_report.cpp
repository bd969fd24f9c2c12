#include "workbench/report/static_study_report.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "waymark/core/angle.hpp"

#include "workbench/logs/files.hpp"
#include "workbench/logs/json_text.hpp"
#include "workbench/report/noise_chart.hpp"
#include "workbench/report/pages.hpp"
#include "workbench/report/rounded.hpp"

namespace waymark {
namespace {

using calibrate::PlaceStudy;
using calibrate::StaticStudy;
using calibrate::Value;
using Json = nlohmann::ordered_json;

std::string line(const char* what, const Value& value, double unit = 1.0) {
  return fmt::format("  {:<48}{:>11.5f} +- {:.5f}\n", what, unit * value.value, unit * value.sigma);
}

std::string row(const PlaceStudy& each) {
  return fmt::format("  {:>9.3f}{:>13.2f}{:>8}{:>9.0f} %{:>12.4f}{:>10.4f}{:>14.3f}{:>10.3f}\n",
                     each.place.range_m, to_degrees(each.place.bearing_rad), each.observations,
                     100.0 * each.observations / std::max(1, each.scans), each.range_error_m,
                     std::sqrt(each.covariance(0, 0)), to_degrees(each.bearing_error_rad),
                     to_degrees(std::sqrt(each.covariance(1, 1))));
}

Json json_of(const Value& value, double unit = 1.0) {
  return {{"value", rounded(unit * value.value)}, {"sigma", rounded(unit * value.sigma)}};
}

Json json_of(const PlaceStudy& each) {
  const Eigen::Matrix2d& R = each.covariance;
  return {{"log", each.place.log},
          {"range_m", rounded(each.place.range_m)},
          {"bearing_deg", rounded(to_degrees(each.place.bearing_rad))},
          {"scans", each.scans},
          {"observations", each.observations},
          {"range_error_m", rounded(each.range_error_m)},
          {"bearing_error_deg", rounded(to_degrees(each.bearing_error_rad))},
          {"range_sigma_m", rounded(std::sqrt(R(0, 0)))},
          {"bearing_sigma_deg", rounded(to_degrees(std::sqrt(R(1, 1))))},
          {"correlation", rounded(R(0, 1) / std::max(1e-300, std::sqrt(R(0, 0) * R(1, 1))))}};
}

void add_limit(Json& limits, const char* key, const std::optional<double>& value, double unit = 1.0) {
  if (value) limits[key] = rounded(unit * *value);
}

Json finding(const char* name, const Value& found, double unit = 1.0) {
  Json json = json_of(found, unit);
  json["name"] = name;
  return json;
}

Json findings(const StaticStudy& study) {
  Json list = Json::array();
  if (study.range_scale) list.push_back(finding("range scale", *study.range_scale));
  list.push_back(finding("range offset, m", study.range_offset_m));
  list.push_back(finding("bearing offset, deg", study.bearing_offset_rad, to_degrees(1.0)));
  if (study.range) {
    list.push_back(finding("sensor.range_sigma_m", study.range->sigma_m));
    list.push_back(finding("sensor.range_sigma_ratio", study.range->sigma_ratio));
  }
  list.push_back(finding("sensor.bearing_sigma_deg", study.bearing_sigma_rad, to_degrees(1.0)));
  return list;
}

/// Each place as it was seen.
std::vector<calibrate::NoiseBin> bins(const StaticStudy& study, bool ranges) {
  std::vector<calibrate::NoiseBin> list;
  for (const PlaceStudy& each : study.places) {
    if (each.observations < 2) continue;
    const Eigen::Index i = ranges ? 0 : 1;
    list.push_back({ranges ? each.place.range_m : each.place.bearing_rad,
                    each.observations,
                    ranges ? each.range_error_m : each.bearing_error_rad,
                    {std::sqrt(each.covariance(i, i)), 0.0}});
  }
  std::ranges::sort(list, {}, &calibrate::NoiseBin::at);
  return list;
}

}  // namespace

std::string to_text(const StaticStudy& study) {
  std::string text = fmt::format("{} recordings of a landmark at known places\n", study.places.size());
  text += fmt::format("  {:>9}{:>13}{:>8}{:>11}{:>12}{:>10}{:>14}{:>10}\n", "range, m", "bearing, deg",
                      "count", "seen", "error, m", "sigma", "error, deg", "sigma");
  for (const PlaceStudy& each : study.places) text += row(each);
  if (study.range_scale) text += line("range scale", *study.range_scale);
  text += line("range offset, m", study.range_offset_m);
  text += line("bearing offset, deg", study.bearing_offset_rad, to_degrees(1.0));
  text += line("spread of range errors over places, m", study.range_scatter_m);
  text += line("spread of bearing errors over places, deg", study.bearing_scatter_rad, to_degrees(1.0));
  for (const auto& note : study.notes) text += fmt::format("  note: {}\n", note);
  return text;
}

std::string to_json(const StaticStudy& study) {
  Json json{{"places", Json::array()}, {"found", Json::object()}, {"limits", Json::object()}};
  for (const PlaceStudy& each : study.places) json["places"].push_back(json_of(each));
  Json& found = json["found"];
  if (study.range_scale) found["range_scale"] = json_of(*study.range_scale);
  found["range_offset_m"] = json_of(study.range_offset_m);
  found["bearing_offset_deg"] = json_of(study.bearing_offset_rad, to_degrees(1.0));
  found["range_scatter_m"] = json_of(study.range_scatter_m);
  found["bearing_scatter_deg"] = json_of(study.bearing_scatter_rad, to_degrees(1.0));
  if (study.range) {
    found["range_sigma_m"] = json_of(study.range->sigma_m);
    found["range_sigma_ratio"] = json_of(study.range->sigma_ratio);
  }
  found["bearing_sigma_deg"] = json_of(study.bearing_sigma_rad, to_degrees(1.0));
  add_limit(json["limits"], "min_range_m", study.limits.min_range_m);
  add_limit(json["limits"], "max_range_m", study.limits.max_range_m);
  add_limit(json["limits"], "left_deg", study.limits.left_rad, to_degrees(1.0));
  add_limit(json["limits"], "right_deg", study.limits.right_rad, to_degrees(1.0));
  json["notes"] = study.notes;
  return json_text(json, 2) + "\n";
}

std::string render_report(const StaticStudy& study, const std::string& command) {
  Json json{{"title", "Errors of a sensor, from landmarks at known places"},
            {"subtitle", fmt::format("{} recordings", study.places.size())}};
  json["version"] = WAYMARK_VERSION;
  json["command"] = command;
  json["config_yaml"] = to_yaml(study);
  json["notes"] = study.notes;
  json["found"] = findings(study);
  json["charts"] = Json::parse(noise_charts_json(bins(study, true), bins(study, false)));
  return fill_page(sensor_page(), json_text(json));
}

Result<void> write_results(const StaticStudy& study, const std::filesystem::path& folder,
                           const std::string& command) {
  if (auto done = write_file(folder / "calibration.yaml", to_yaml(study)); !done) return done;
  if (auto done = write_file(folder / "calibration.json", to_json(study)); !done) return done;
  return write_file(folder / "report.html", render_report(study, command));
}

}  // namespace waymark
