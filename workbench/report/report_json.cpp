#include "workbench/report/report_json.hpp"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "workbench/logs/json_text.hpp"
#include "workbench/report/decimate.hpp"
#include "workbench/report/image_text.hpp"
#include "workbench/report/nis_histogram.hpp"
#include "workbench/report/pages.hpp"
#include "workbench/report/rounded.hpp"

namespace waymark {
namespace {

using Json = nlohmann::ordered_json;  // metrics stay in the order of metrics.json
using Values = std::vector<double>;
using Rows = std::vector<std::size_t>;

double rounded_stamp(double t_s) { return std::round(t_s * 1e4) / 1e4; }

// A column that is not as long as its table counts as missing.
Json column(const Values& values, const Rows& rows, std::size_t length, double (*round)(double) = rounded) {
  Json::array_t result;
  if (values.size() != length) return result;
  result.reserve(rows.size());
  for (const std::size_t row : rows) result.emplace_back(round(values[row]));
  return result;
}

template <class T>
Json other_column(const std::vector<T>& values, const Rows& rows, std::size_t length) {
  Json::array_t result;
  if (values.size() != length) return result;
  for (const std::size_t row : rows) result.emplace_back(static_cast<T>(values[row]));
  return result;
}

Rows rows_to_draw(const Values& t_s, std::initializer_list<const Values*> deciding) {
  std::vector<Column> columns;
  for (const Values* values : deciding) {
    if (values->size() == t_s.size()) columns.emplace_back(*values);
  }
  return rows_with_extremes(t_s.size(), columns, kMaxReportRows);
}

Json to_json(const PathSeries& path) {
  const Rows rows = rows_to_draw(path.t_s, {&path.x_m, &path.y_m});
  const std::size_t n = path.t_s.size();
  Json json = {{"t", column(path.t_s, rows, n, rounded_stamp)},
               {"x", column(path.x_m, rows, n)},
               {"y", column(path.y_m, rows, n)}};
  if (path.theta_rad.size() == n) json["theta"] = column(path.theta_rad, rows, n);
  return json;
}

Json to_json(const DeadReckoningSeries& series) {
  Json json = to_json(series.path);
  const Rows rows = rows_to_draw(series.error_t_s, {&series.error_m});
  json["t_error"] = column(series.error_t_s, rows, series.error_t_s.size(), rounded_stamp);
  json["error_m"] = column(series.error_m, rows, series.error_t_s.size());
  return json;
}

Json to_json(const ReportedTrueLandmark& landmark) {
  return {{"id", landmark.id}, {"x", rounded(landmark.x_m)}, {"y", rounded(landmark.y_m)}};
}

Json to_json(const ReportedLandmark& landmark) {
  return {{"id", landmark.id},
          {"x", rounded(landmark.x_m)},
          {"y", rounded(landmark.y_m)},
          {"sxx", rounded(landmark.sxx_m2)},
          {"sxy", rounded(landmark.sxy_m2)},
          {"syy", rounded(landmark.syy_m2)},
          {"observations", landmark.observations}};
}

Json to_json(const ErrorSeries& errors) {
  const Rows rows = rows_to_draw(errors.t_s, {&errors.x_m, &errors.y_m, &errors.heading_deg, &errors.nees});
  const std::size_t n = errors.t_s.size();
  return {{"t", column(errors.t_s, rows, n, rounded_stamp)},
          {"x_m", column(errors.x_m, rows, n)},
          {"y_m", column(errors.y_m, rows, n)},
          {"heading_deg", column(errors.heading_deg, rows, n)},
          {"position_m", column(errors.position_m, rows, n)},
          {"sigma_x_m", column(errors.sigma_x_m, rows, n)},
          {"sigma_y_m", column(errors.sigma_y_m, rows, n)},
          {"sigma_heading_deg", column(errors.sigma_heading_deg, rows, n)},
          {"nees", column(errors.nees, rows, n)}};
}

// From all observations: those that are drawn are chosen by their extremes, which would bend a histogram.
Json histogram_json(const InnovationSeries& innovations) {
  if (innovations.dof.size() != innovations.nis.size()) return nullptr;
  const NisHistogram histogram = nis_histogram(innovations.nis, innovations.dof);
  Rows all(histogram.density.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
  return {{"dof", histogram.dof},
          {"bin_width", histogram.bin_width},
          {"density", column(histogram.density, all, all.size())},
          {"expected", column(histogram.expected, all, all.size())}};
}

Json to_json(const InnovationSeries& innovations) {
  const std::size_t n = innovations.t_s.size();
  const Rows rows = rows_to_draw(innovations.t_s, {&innovations.nis});
  std::vector<int> accepted(innovations.accepted.begin(), innovations.accepted.end());
  return {{"t", column(innovations.t_s, rows, n, rounded_stamp)},
          {"nis", column(innovations.nis, rows, n)},
          {"dof", other_column(innovations.dof, rows, n)},
          {"accepted", other_column(accepted, rows, n)},
          {"landmark", other_column(innovations.landmark, rows, n)},
          {"gate", rounded(innovations.gate)},
          {"histogram", histogram_json(innovations)}};
}

Json to_json(const StepSeries& steps) {
  const Rows rows = rows_to_draw(steps.t_s, {&steps.us});
  Json json = {{"t", column(steps.t_s, rows, steps.t_s.size(), rounded_stamp)},
               {"us", column(steps.us, rows, steps.t_s.size())}};
  if (steps.budget_us) json["budget_us"] = rounded(*steps.budget_us);
  return json;
}

Json to_json(const ReportedBlock& block) {
  Json json{{"name", block.name},
            {"calls", block.calls},
            {"mean_us", rounded(block.mean_us)},
            {"per_frame_us", rounded(block.per_frame_us)}};
  if (block.article_per_frame_us) json["article_per_frame_us"] = rounded(*block.article_per_frame_us);
  return json;
}

const char* name_of(vision::SearchRecord::Result result, bool refused) {
  switch (result) {
    case vision::SearchRecord::Result::kFound:
      return refused ? "rejected" : "found";
    case vision::SearchRecord::Result::kMissed:
      return "missed";
    case vision::SearchRecord::Result::kNew:
      return "new";
    case vision::SearchRecord::Result::kNotTried:
      break;
  }
  return "not tried";
}

double in_hundredths(double px) { return std::round(100.0 * px) / 100.0; }

Json to_json(const vision::SearchRecord& look, const StripFrame& frame) {
  const bool refused = std::ranges::find(frame.refused, look.id) != frame.refused.end();
  return {{"id", look.id.number},
          {"candidate", look.candidate},
          {"result", name_of(look.result, refused)},
          {"u", in_hundredths(look.pixel.x())},
          {"v", in_hundredths(look.pixel.y())},
          {"predicted_u", in_hundredths(look.predicted_px.x())},
          {"predicted_v", in_hundredths(look.predicted_px.y())},
          {"sxx", rounded(look.S(0, 0))},
          {"sxy", rounded(look.S(0, 1))},
          {"syy", rounded(look.S(1, 1))}};
}

Json to_json(const ImageStripSeries& image_strip) {
  Json::array_t frames;
  for (std::size_t i = 0; i < image_strip.frames.size(); ++i) {
    const StripFrame& frame = image_strip.frames[i];
    Json::array_t search_records;
    for (const vision::SearchRecord& look : frame.search_records)
      search_records.push_back(to_json(look, frame));
    frames.push_back({{"t", rounded_stamp(image_strip.t_s[i])},
                      {"width", frame.image.width_px()},
                      {"height", frame.image.height_px()},
                      {"png", image_text(frame.image)},
                      {"search_records", std::move(search_records)}});
  }
  return frames;
}

Json to_json(const RunData& run);

template <class T>
Json list(const std::vector<T>& items) {
  Json::array_t result;
  for (const T& item : items) result.push_back(to_json(item));
  return result;
}

Json metrics_of(const RunData& run) {
  Json metrics = Json::parse(run.metrics_json, nullptr, false);
  return metrics.is_object() ? metrics : Json::object();
}

Json to_json(const RunData& run) {
  Json json = {{"name", run.name},
               {"filter", run.filter},
               {"command", run.command},
               {"config_yaml", run.config_yaml},
               {"path", to_json(run.path)},
               {"landmarks", list(run.landmarks)},
               {"errors", to_json(run.errors)},
               {"innovations", to_json(run.innovations)},
               {"steps", to_json(run.steps)},
               {"blocks", list(run.blocks)},
               {"image_strip", to_json(run.image_strip)},
               {"metrics", metrics_of(run)},
               {"notes", run.notes}};
  if (!run.smoothed.t_s.empty()) json["smoothed"] = to_json(run.smoothed);
  if (run.alignment) {
    const Pose2& T = *run.alignment;
    json["alignment"] = {{"x_m", T.x_m}, {"y_m", T.y_m}, {"theta_rad", T.theta_rad}};
  }
  return json;
}

}  // namespace

std::string report_json(const ReportData& data) {
  const Json json = {{"title", data.title},
                     {"subtitle", data.subtitle},
                     {"version", data.version},
                     {"input", data.input},
                     {"truth", to_json(data.truth)},
                     {"truth_landmarks", list(data.truth_landmarks)},
                     {"dead_reckoning", to_json(data.dead_reckoning)},
                     {"runs", list(data.runs)}};
  return safe_in_script(json_text(json));
}

}  // namespace waymark
