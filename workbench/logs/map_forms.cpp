#include "workbench/logs/map_forms.hpp"

#include <algorithm>
#include <cstdint>
#include <exception>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "workbench/logs/files.hpp"
#include "workbench/logs/json_place.hpp"
#include "workbench/logs/json_text.hpp"
#include "workbench/logs/map_files.hpp"

namespace waymark {
namespace {

using Json = nlohmann::ordered_json;

enum class Form { kWaymark, kJson, kCsv };

Result<Form> form_of(const std::filesystem::path& path) {
  const auto extension = path.extension();
  if (extension == ".waymark") return Form::kWaymark;
  if (extension == ".json") return Form::kJson;
  if (extension == ".csv") return Form::kCsv;
  return Error{path.string() + ": the name of a map file ends with .waymark, .json or .csv"};
}

Json landmarks_json(const MapState& map) {
  Json landmarks = Json::array();
  const int d = map.landmark_dimension;
  for (std::size_t i = 0; i < map.ids.size(); ++i) {
    const Eigen::VectorXd position = map.landmarks.segment(static_cast<Eigen::Index>(i) * d, d);
    landmarks.push_back({{"kind", family_name(map.ids[i].family)},
                         {"number", map.ids[i].number},
                         {"sightings", map.observations[i]},
                         {"position_m", std::vector<double>(position.begin(), position.end())}});
  }
  return landmarks;
}

Json patches_json(const MapState& map) {
  Json patches = Json::array();
  for (const LandmarkPatch& patch : map.patches) {
    const Pose2& pose = patch.T_world_robot;
    patches.push_back({{"kind", family_name(patch.id.family)},
                       {"number", patch.id.number},
                       {"pose", {pose.x_m, pose.y_m, pose.theta_rad}},
                       {"pixels", patch.pixels}});
  }
  return patches;
}

using Place = JsonPlace<Json>;

Pose2 pose_of(const Place& place) {
  const auto items = place.items(3);
  return {items[0].number(), items[1].number(), items[2].number()};
}

LandmarkId id_of(const Place& place) {
  const Place kind = place.at("kind");
  const auto family = family_named(kind.text());
  if (!family) kind.fail("is not a kind of landmark; expected none, marker, barcode or corner");
  return {*family, place.at("number").whole<std::int32_t>()};
}

Stamp stamp_of(const Place& place) {
  const auto stamp = parse_stamp(place.text());
  if (!stamp) place.fail("is not a number of seconds");
  return *stamp;
}

LandmarkPatch patch_of(const Place& place) {
  LandmarkPatch patch{id_of(place), pose_of(place.at("pose")), {}};
  for (const Place& pixel : place.at("pixels").items()) patch.pixels.push_back(pixel.whole<std::uint8_t>());
  return patch;
}

/// The upper triangle, row by row.
Eigen::MatrixXd covariance_of(const Place& place) {
  const auto rows = place.items();
  const std::size_t n = rows.size();
  Eigen::MatrixXd P(n, n);
  for (std::size_t i = 0; i < n; ++i) {
    const auto row = rows[i].items(n - i);
    for (std::size_t j = i; j < n; ++j)
      P(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
          P(static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(i)) = row[j - i].number();
  }
  return P;
}

std::string format_json(const MapState& map) {
  const Pose2& pose = map.T_world_robot;
  Json json{{"waymark_map", 1},
            {"made_by", map.made_by},
            {"stamp_s", to_string(map.stamp)},
            {"pose", {pose.x_m, pose.y_m, pose.theta_rad}},
            {"landmark_dimension", map.landmark_dimension},
            {"landmarks", landmarks_json(map)},
            {"covariance", Json::array()},
            {"patches", patches_json(map)}};
  for (Eigen::Index i = 0; i < map.covariance.rows(); ++i) {
    const Eigen::VectorXd row = map.covariance.row(i).tail(map.covariance.cols() - i);
    json["covariance"].push_back(std::vector<double>(row.begin(), row.end()));
  }
  return json_text(json, 1) + '\n';
}

MapState map_of(const Place& place) {
  MapState map;
  map.made_by = place.at("made_by").text();
  map.stamp = stamp_of(place.at("stamp_s"));
  map.T_world_robot = pose_of(place.at("pose"));
  map.landmark_dimension = place.at("landmark_dimension").whole<int>();
  std::vector<double> coordinates;
  for (const Place& landmark : place.at("landmarks").items()) {
    map.ids.push_back(id_of(landmark));
    map.observations.push_back(landmark.at("sightings").whole<int>());
    for (const Place& coordinate : landmark.at("position_m").items())
      coordinates.push_back(coordinate.number());
  }
  map.landmarks =
      Eigen::Map<const Eigen::VectorXd>(coordinates.data(), static_cast<Eigen::Index>(coordinates.size()));
  map.covariance = covariance_of(place.at("covariance"));
  for (const Place& patch : place.at("patches").items()) map.patches.push_back(patch_of(patch));
  return map;
}

/// What is no belief is refused as it is in map.waymark.
Result<MapState> checked(const MapState& map, const std::string& name) {
  auto text = format_map(map);
  if (!text) return Error{name + ": " + text.error().message};
  return parse_map(*std::move(text), name);
}

/// A message of the JSON library without the name of its exception, which stands before it in brackets.
std::string_view without_name(std::string_view message) {
  if (!message.starts_with("[json.")) return message;
  const std::size_t end = message.find("] ");
  return end == std::string_view::npos ? message : message.substr(end + 2);
}

Result<MapState> read_json(const std::filesystem::path& path) {
  const auto text = read_file(path);
  if (!text) return text.error();
  try {
    const Json json = Json::parse(*text);
    if (json.is_object() && json.contains("waymark_map") && json["waymark_map"] != 1)
      return Error{fmt::format("{}: version {} of the map format is not supported; only 1 is", path.string(),
                               json_text(json["waymark_map"]))};
    const Place place(json);
    (void)place.at("waymark_map");
    return checked(map_of(place), path.string());
  } catch (const std::exception& problem) {
    return Error{fmt::format("{}: is not a map: {}", path.string(), without_name(problem.what()))};
  }
}

Result<MapState> read_csv(const std::filesystem::path& path) {
  const auto landmarks = read_map_csv(path);
  if (!landmarks) return landmarks.error();
  const bool flat = std::ranges::all_of(*landmarks, [](const LandmarkEstimate& landmark) {
    return landmark.position_m.z() == 0.0 && landmark.covariance.col(2).isZero(0.0);
  });
  MapState map;
  map.made_by = "waymark map convert of " + path.filename().string();
  const Eigen::Index d = map.landmark_dimension = flat ? 2 : 3;
  const Eigen::Index n = 3 + d * std::ssize(*landmarks);
  map.landmarks.resize(n - 3);
  map.covariance = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index at = 0; const LandmarkEstimate& landmark : *landmarks) {
    map.ids.push_back(landmark.id);
    map.observations.push_back(landmark.observations);
    map.landmarks.segment(at, d) = landmark.position_m.head(d);
    map.covariance.block(3 + at, 3 + at, d, d) = landmark.covariance.topLeftCorner(d, d);
    at += d;
  }
  return checked(map, path.string());
}

}  // namespace

Snapshot snapshot_of(const MapState& map) {
  Snapshot snapshot{map.stamp, {map.T_world_robot, map.covariance.topLeftCorner<3, 3>()}, {}};
  const Eigen::Index d = map.landmark_dimension;
  for (std::size_t i = 0; i < map.ids.size(); ++i) {
    const Eigen::Index at = d * static_cast<Eigen::Index>(i);
    LandmarkEstimate landmark{.id = map.ids[i], .observations = map.observations[i]};
    landmark.position_m.head(d) = map.landmarks.segment(at, d);
    landmark.covariance.topLeftCorner(d, d) = map.covariance.block(3 + at, 3 + at, d, d);
    snapshot.landmarks.push_back(landmark);
  }
  return snapshot;
}

Result<MapState> read_map_of_any_form(const std::filesystem::path& path) {
  const auto form = form_of(path);
  if (!form) return form.error();
  if (*form == Form::kWaymark) return read_map(path);
  return *form == Form::kJson ? read_json(path) : read_csv(path);
}

Result<void> write_map_of_any_form(const std::filesystem::path& path, const MapState& map) {
  const auto form = form_of(path);
  if (!form) return form.error();
  if (*form == Form::kWaymark) return write_map(path, map);
  return *form == Form::kJson ? write_file(path, format_json(map)) : write_map_csv(path, snapshot_of(map));
}

}  // namespace waymark
