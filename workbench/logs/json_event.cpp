#include "workbench/logs/json_event.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "workbench/logs/json_text.hpp"
#include "workbench/logs/text_lines.hpp"

namespace waymark {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kLongest = 65536;
constexpr std::size_t kMostObservations = 1000;

std::optional<double> number(const Json& json, const char* name) {
  const auto found = json.find(name);
  if (found == json.end() || !found->is_number()) return std::nullopt;
  const auto value = found->get<double>();
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

/// A stamp may be a number or, to keep all its digits, a text.
Result<std::optional<Stamp>> stamp_of(const Json& json) {
  const auto found = json.find("stamp_s");
  if (found == json.end()) return std::optional<Stamp>{};
  const std::string text = found->is_string() ? found->get<std::string>() : json_text(*found);
  const auto stamp = parse_stamp(text);
  if (!stamp) return Error{fmt::format("stamp_s is not a number of seconds: {}", in_quotes(text))};
  return std::optional(*stamp);
}

Result<std::optional<LandmarkId>> id_of(const Json& json) {
  const auto found = json.find("id");
  if (found == json.end() || found->is_null()) return std::optional<LandmarkId>{};
  if (!found->is_number_integer() || found->get<double>() < 0.0 ||
      found->get<double>() > std::numeric_limits<std::int32_t>::max())
    return Error{fmt::format("id is not a whole number from 0: {}", in_quotes(json_text(*found)))};
  return std::optional(LandmarkId{LandmarkId::Family::kMarker, found->get<std::int32_t>()});
}

Result<Measurement> measurement_of(const Json& json) {
  const auto range_m = number(json, "range_m"), bearing_rad = number(json, "bearing_rad");
  const auto u_px = number(json, "u_px"), v_px = number(json, "v_px");
  if (range_m && bearing_rad) return Measurement(RangeBearing{*range_m, *bearing_rad});
  if (range_m) return Measurement(Range{*range_m});
  if (bearing_rad) return Measurement(Bearing{*bearing_rad});
  if (u_px && v_px) return Measurement(Pixel{*u_px, *v_px});
  return Error{"an observation has neither range_m nor bearing_rad, nor u_px and v_px"};
}

/// Its upper triangle.
Result<std::optional<Eigen::Matrix2d>> covariance_of(const Json& json) {
  const auto found = json.find("covariance");
  if (found == json.end()) return std::optional<Eigen::Matrix2d>{};
  const auto is_number = [](const Json& each) {
    return each.is_number() && std::isfinite(each.get<double>());
  };
  if (!found->is_array() || found->size() != 3 || !std::ranges::all_of(*found, is_number))
    return Error{"covariance is not a list of three numbers"};
  Eigen::Matrix2d R;
  R << (*found)[0].get<double>(), (*found)[1].get<double>(), (*found)[1].get<double>(),
      (*found)[2].get<double>();
  return std::optional(R);
}

Result<EventContent> observations_of(const Json& rows) {
  if (!rows.is_array() || rows.size() > kMostObservations)
    return Error{fmt::format("observations is not a list of at most {}", kMostObservations)};
  Observations observations;
  for (const Json& row : rows) {
    if (!row.is_object()) return Error{"an observation is not an object"};
    const auto id = id_of(row);
    if (!id) return id.error();
    const auto value = measurement_of(row);
    if (!value) return value.error();
    const auto covariance = covariance_of(row);
    if (!covariance) return covariance.error();
    observations.push_back({*id, *value, *covariance});
  }
  return EventContent(std::move(observations));
}

Result<EventContent> content_of(const Json& json) {
  if (const auto rows = json.find("observations"); rows != json.end()) return observations_of(*rows);
  const auto left = number(json, "left_rad"), right = number(json, "right_rad");
  if (left && right) return EventContent(WheelAngles{*left, *right});
  const auto v = number(json, "v_mps"), w = number(json, "w_radps"), steer = number(json, "steer_rad");
  if (v && w) return EventContent(Velocity{*v, *w});
  if (v && steer) return EventContent(Steering{*v, *steer});
  if (w) return EventContent(YawRate{*w});
  const auto x = number(json, "x_m"), y = number(json, "y_m"), theta = number(json, "theta_rad");
  if (x && y && theta) return EventContent(OdometryPose{{*x, *y, *theta}});
  return Error{
      "it has none of left_rad and right_rad; v_mps and w_radps; v_mps and steer_rad; x_m, y_m and "
      "theta_rad; "
      "w_radps; observations, each a finite number"};
}

struct ToJson {
  Json operator()(const WheelAngles& w) const {
    return {{"left_rad", w.left_rad}, {"right_rad", w.right_rad}};
  }
  Json operator()(const Velocity& v) const { return {{"v_mps", v.v_mps}, {"w_radps", v.w_radps}}; }
  Json operator()(const Steering& s) const { return {{"v_mps", s.v_mps}, {"steer_rad", s.steer_rad}}; }
  Json operator()(const OdometryPose& o) const {
    return {
        {"x_m", o.T_odom_robot.x_m}, {"y_m", o.T_odom_robot.y_m}, {"theta_rad", o.T_odom_robot.theta_rad}};
  }
  Json operator()(const YawRate& y) const { return {{"w_radps", y.w_radps}}; }
  Json operator()(const Observations& observations) const {
    Json rows = Json::array();
    for (const Observation& each : observations) {
      Json row = std::visit(*this, each.value);
      if (each.id) row["id"] = each.id->number;
      if (each.covariance)
        row["covariance"] = {(*each.covariance)(0, 0), (*each.covariance)(0, 1), (*each.covariance)(1, 1)};
      rows.push_back(std::move(row));
    }
    return {{"observations", std::move(rows)}};
  }
  Json operator()(const RangeBearing& m) const {
    return {{"range_m", m.range_m}, {"bearing_rad", m.bearing_rad}};
  }
  Json operator()(const Range& m) const { return {{"range_m", m.range_m}}; }
  Json operator()(const Bearing& m) const { return {{"bearing_rad", m.bearing_rad}}; }
  Json operator()(const Pixel& m) const { return {{"u_px", m.u_px}, {"v_px", m.v_px}}; }
  Json operator()(const Image& /*image*/) const { return nullptr; }
  Json operator()(const MarkerOutlines& /*outlines*/) const { return nullptr; }
  Json operator()(const Truth& /*truth*/) const { return nullptr; }
};

}  // namespace

Result<JsonEvent> parse_json_event(std::string_view line) {
  if (line.size() > kLongest) return Error{fmt::format("it is longer than {} bytes", kLongest)};
  const Json json = Json::parse(line, nullptr, false);
  if (json.is_discarded() || !json.is_object()) return Error{"it is not a JSON object"};
  const auto stamp = stamp_of(json);
  if (!stamp) return stamp.error();
  auto content = content_of(json);
  if (!content) return content.error();
  return JsonEvent{*stamp, *std::move(content)};
}

std::string to_json_event(Stamp stamp, const EventContent& content) {
  Json json = std::visit(ToJson{}, content);
  if (json.is_null()) return "";
  json["stamp_s"] = to_string(stamp);
  return json_text(json);
}

}  // namespace waymark
