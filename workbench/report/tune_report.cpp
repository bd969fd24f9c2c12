#include "workbench/report/tune_report.hpp"

#include <cmath>

#include <nlohmann/json.hpp>

#include "workbench/logs/files.hpp"
#include "workbench/logs/json_text.hpp"
#include "workbench/report/pages.hpp"
#include "workbench/report/rounded.hpp"
#include "workbench/study/tune_text.hpp"

namespace waymark {
namespace {

using Json = nlohmann::ordered_json;

Json key_json(const study::TunedKey& key) {
  Json slice = Json::array();
  for (const auto& [value, score] : key.slice) slice.push_back({rounded(value), rounded(score)});
  Json json{{"name", key.name},
            {"before", rounded(key.before)},
            {"after", rounded(key.after)},
            {"logarithmic", key.by_factor},
            {"good", study::interval_text(key)},
            {"slice", slice}};
  if (!key.interval) return json;
  json["low"] = key.open_low ? Json() : Json(rounded(key.interval->first));
  json["high"] = key.open_high ? Json() : Json(rounded(key.interval->second));
  return json;
}

Json figures_json(const study::Figures& figures) {
  Json json = Json::object();
  for (std::size_t i = 0; i < figures.size(); ++i)
    if (!std::isnan(figures[i])) json[std::string(study::kFigureNames[i])] = rounded(figures[i]);
  return json;
}

Json result_json(const study::TuneResult& result) {
  Json json{{"by", result.by == study::TuneBy::kLikelihood ? "likelihood" : "rmse"},
            {"score", study::score_name(result.by)},
            {"observations", result.observations},
            {"runs", result.runs},
            {"stopped", result.stopped},
            {"before", rounded(result.before)},
            {"after", rounded(result.after)},
            {"keys", Json::array()},
            {"idle_keys", result.idle_keys},
            {"held_out", Json::array()},
            {"logs", Json::array()}};
  for (const auto& key : result.keys) json["keys"].push_back(key_json(key));
  for (const auto& part : result.held_out)
    json["held_out"].push_back(
        {{"name", part.name}, {"before", rounded(part.before)}, {"after", rounded(part.after)}});
  for (const auto& log : result.logs)
    json["logs"].push_back({{"name", log.name},
                            {"score", {rounded(log.before), rounded(log.after)}},
                            {"before", figures_json(log.figures_before)},
                            {"after", figures_json(log.figures_after)}});
  return json;
}

}  // namespace

std::string render_tune_report(const study::TuneResult& result, const std::string& command) {
  Json data = result_json(result);
  data["command"] = command;
  data["version"] = WAYMARK_VERSION;
  return fill_page(tune_page(), json_text(data));
}

Result<void> write_tune_report(const study::TuneResult& result, const std::string& command,
                               const std::filesystem::path& path) {
  return write_file(path, render_tune_report(result, command));
}

std::string tune_json_text(const study::TuneResult& result) { return json_text(result_json(result), 2); }

}  // namespace waymark
