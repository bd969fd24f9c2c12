#include "waymark/report/sensor_noise_report.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "waymark/core/angle.hpp"
#include "waymark/io/files.hpp"
#include "waymark/report/noise_chart.hpp"
#include "waymark/report/pages.hpp"
#include "waymark/report/rounded.hpp"

namespace waymark {
namespace {

using calibrate::NoiseBin;
using calibrate::SensorNoise;
using calibrate::Value;
using Json = nlohmann::ordered_json;

std::string row(const char* key, double before, const Value& found) {
  return fmt::format("  {:<30}{:>11.5f}{:>13.5f} +- {:.5f}\n", key, before, found.value, found.sigma);
}

std::string rows(const std::vector<NoiseBin>& bins, const char* axis, double unit) {
  std::string text = fmt::format("  {:>14}{:>8}{:>12}{:>12}\n", axis, "count", "mean", "sigma");
  for (const NoiseBin& bin : bins)
    text += fmt::format("  {:>14.2f}{:>8}{:>12.4f}{:>12.4f}\n", (unit == 1.0 ? 1.0 : unit) * bin.at,
                        bin.count, unit * bin.mean, unit * bin.sigma.value);
  return text;
}

Json json_of(const Value& value) {
  return {{"value", rounded(value.value)}, {"sigma", rounded(value.sigma)}};
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

Json finding(const char* name, double before, const Value& found) {
  return {{"name", name},
          {"before", rounded(before)},
          {"value", rounded(found.value)},
          {"sigma", rounded(found.sigma)}};
}

Json findings(const SensorNoise& noise) {
  Json list = Json::array();
  const LandmarkSensor& before = noise.before.sensor;
  if (noise.range) {
    list.push_back(finding("sensor.range_sigma_m", before.range_sigma_m, noise.range->sigma_m));
    list.push_back(finding("sensor.range_sigma_ratio", before.range_sigma_ratio, noise.range->sigma_ratio));
  }
  if (noise.bearing_sigma_deg)
    list.push_back(finding("sensor.bearing_sigma_deg", before.bearing_sigma_deg, *noise.bearing_sigma_deg));
  return list;
}

}  // namespace

std::string to_text(const SensorNoise& noise) {
  const LandmarkSensor& before = noise.before.sensor;
  std::string text =
      fmt::format("{} runs over {}\n  {:<30}{:>11}{:>13}\n", noise.runs, noise.input, "", "before", "found");
  if (noise.range) {
    text += row("sensor.range_sigma_m", before.range_sigma_m, noise.range->sigma_m);
    text += row("sensor.range_sigma_ratio", before.range_sigma_ratio, noise.range->sigma_ratio);
  }
  if (noise.bearing_sigma_deg)
    text += row("sensor.bearing_sigma_deg", before.bearing_sigma_deg, *noise.bearing_sigma_deg);
  text += rows(noise.ranges, "range, m", 1.0);
  text += rows(noise.bearings, "bearing, deg", to_degrees(1.0));
  if (noise.outliers > 0)
    text += fmt::format("  note: {} errors beyond 4 sigma were left out\n", noise.outliers);
  for (const auto& note : noise.notes) text += fmt::format("  note: {}\n", note);
  return text;
}

std::string to_json(const SensorNoise& noise) {
  Json json{
      {"input", noise.input}, {"runs", noise.runs}, {"settled", noise.settled}, {"found", Json::object()}};
  if (noise.range) {
    json["found"]["sensor.range_sigma_m"] = json_of(noise.range->sigma_m);
    json["found"]["sensor.range_sigma_ratio"] = json_of(noise.range->sigma_ratio);
  }
  if (noise.bearing_sigma_deg) json["found"]["sensor.bearing_sigma_deg"] = json_of(*noise.bearing_sigma_deg);
  json["ranges"] = json_of(noise.ranges, "range_m", 1.0);
  json["bearings"] = json_of(noise.bearings, "bearing_deg", to_degrees(1.0));
  json["outliers"] = noise.outliers;
  json["notes"] = noise.notes;
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string render_report(const SensorNoise& noise, const std::string& command) {
  Json json{{"title", "Noise of a moving sensor"},
            {"subtitle", fmt::format("From {} alone, in {} runs: what is left over of sightings when path "
                                     "and map are known by the whole log",
                                     noise.input, noise.runs)}};
  json["version"] = WAYMARK_VERSION;
  json["command"] = command;
  json["config_yaml"] = to_yaml(noise);
  json["notes"] = noise.notes;
  json["found"] = findings(noise);
  json["charts"] = Json::parse(noise_charts_json(noise.ranges, noise.bearings));
  return fill_page(sensor_page(), json.dump(-1, ' ', false, Json::error_handler_t::replace));
}

Result<void> write_results(const SensorNoise& noise, const std::filesystem::path& folder,
                           const std::string& command) {
  if (auto done = write_file(folder / "calibration.yaml", to_yaml(noise)); !done) return done;
  if (auto done = write_file(folder / "calibration.json", to_json(noise)); !done) return done;
  return write_file(folder / "report.html", render_report(noise, command));
}

}  // namespace waymark
