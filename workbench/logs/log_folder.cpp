#include "workbench/logs/log_folder.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "waymark/core/names.hpp"

#include "workbench/config/flat_yaml.hpp"
#include "workbench/logs/camera_yaml.hpp"
#include "workbench/logs/files.hpp"
#include "workbench/logs/image_file.hpp"
#include "workbench/logs/log_format.hpp"
#include "workbench/logs/merged_log.hpp"

namespace waymark {
namespace {

namespace fs = std::filesystem;

std::optional<EventContent> read_wheels_row(TextTable& row, Tally&) {
  return WheelAngles{row.number(1), row.number(2)};
}
std::optional<EventContent> read_velocity_row(TextTable& row, Tally&) {
  return Velocity{row.number(1), row.number(2)};
}
std::optional<EventContent> read_steering_row(TextTable& row, Tally&) {
  return Steering{row.number(1), row.number(2)};
}

std::optional<EventContent> read_odometry_row(TextTable& row, Tally&) {
  return OdometryPose{{row.number(1), row.number(2), row.number(3)}};
}

std::optional<EventContent> read_yaw_rate_row(TextTable& row, Tally&) { return YawRate{row.number(1)}; }

std::optional<EventContent> read_truth_row(TextTable& row, Tally&) {
  return Truth{row.number(1), row.number(2), row.is_empty(3) ? std::nullopt : std::optional(row.number(3))};
}

/// The id in a column; a number below zero names nobody.
LandmarkId read_id(TextTable& row, std::size_t column) {
  const int number = row.integer(column);
  if (number < 0)
    row.fail(fmt::format("id {} is below 0; leave the cell empty if the identity is unknown", number));
  return {LandmarkId::Family::kMarker, number};
}

double read_range(TextTable& row, std::size_t column) {
  const double range_m = row.number(column);
  if (range_m < 0.0) row.fail(fmt::format("range_m is {}; a range cannot be negative", range_m));
  return range_m;
}

std::optional<Measurement> read_measurement(TextTable& row) {
  const bool has_range = !row.is_empty(2);
  const bool has_bearing = !row.is_empty(3);
  const bool has_pixel = !row.is_empty(4) || !row.is_empty(5);
  if (has_pixel && (has_range || has_bearing))
    row.fail("a row must have range_m and bearing_rad, or u_px and v_px, but not both");
  if (has_pixel) return Pixel{row.number(4), row.number(5)};
  if (has_range && has_bearing) return RangeBearing{read_range(row, 2), row.number(3)};
  if (has_range) return Range{read_range(row, 2)};
  if (has_bearing) return Bearing{row.number(3)};
  return std::nullopt;
}

std::optional<EventContent> read_observation(TextTable& row, Tally&) {
  Observation observation;
  if (!row.is_empty(1)) observation.id = read_id(row, 1);
  const auto measurement = read_measurement(row);
  if (!measurement && observation.id)
    row.fail("no measurement: range_m, bearing_rad, u_px and v_px are all empty");
  if (!measurement) return Observations{};
  observation.value = *measurement;
  return Observations{observation};
}

fs::path image_path(const fs::path& folder, const TextTable& row) {
  return folder / log_format::kImageFolder / row.text(1);
}

/// A lost image costs its frame and not the log; a repeated one must not count twice.
EventStream::ReadRow read_image_below(const fs::path& folder) {
  return [folder, last = std::optional<Stamp>()](TextTable& row,
                                                 Tally& tally) mutable -> std::optional<EventContent> {
    if (row.is_empty(1)) row.fail("column file is empty; it needs the name of an image");
    const Stamp stamp = row.stamp(0);
    const bool repeats = stamp == last;
    last = stamp;
    const fs::path file = image_path(folder, row);
    const bool exists = fs::is_regular_file(file);
    if (repeats) tally.count("images skipped with the same stamp as the one before");
    if (!exists) tally.count("images skipped that are listed in images.csv and missing in images/");
    if (repeats || !exists) return std::nullopt;
    return Image{file.string()};
  };
}

TableLayout layout_of(const log_format::Table& table) {
  return {std::string(table.columns), TableLayout::Separator::kComma, std::string(table.may_lack)};
}

/// What an entry of log.yaml does; an error says what is wrong with the value.
using Meaning = std::function<Result<void>(const std::string& value)>;

Result<double> read_yaml_number(const std::string& value) {
  const auto number = parse_number(value);
  if (!number || !std::isfinite(*number)) return Error{in_quotes(value) + " is not a number"};
  return *number;
}

Meaning add_setting(LogInfo& info, std::string_view config_key) {
  return [&info, key = std::string(config_key)](const std::string& value) -> Result<void> {
    if (auto number = read_yaml_number(value); !number) return number.error();
    info.settings.emplace_back(key, value);
    return {};
  };
}

Meaning set_truth_sensor(LogInfo& info, int axis) {
  return [&info, axis](const std::string& value) -> Result<void> {
    const auto number = read_yaml_number(value);
    if (!number) return number.error();
    if (!info.truth_sensor_m) info.truth_sensor_m = Eigen::Vector2d::Zero();
    (*info.truth_sensor_m)[axis] = *number;
    return {};
  };
}

Result<void> check_version(const std::string& value) {
  if (value == log_format::kVersion) return {};
  return Error{in_quotes(value) + " is not a supported version; only 1 is"};
}

/// All keys of log.yaml outside of its config section.
std::map<std::string, Meaning, std::less<>> meanings_of_keys(LogInfo& info) {
  std::map<std::string, Meaning, std::less<>> meanings;
  meanings.emplace(log_format::kVersionKey, check_version);
  meanings["name"] = [&info](const std::string& value) -> Result<void> {
    info.name = value;
    return {};
  };
  for (const auto& [log_key, config_key] : log_format::kSettings)
    meanings.emplace(log_key, add_setting(info, config_key));
  meanings["truth_sensor.x_m"] = set_truth_sensor(info, 0);
  meanings["truth_sensor.y_m"] = set_truth_sensor(info, 1);
  return meanings;
}

Error unknown_key(const std::string& where, const std::string& key,
                  const std::map<std::string, Meaning, std::less<>>& known) {
  std::vector<std::string> names;
  names.reserve(known.size());
  for (const auto& [name, meaning] : known) names.push_back(name);
  const std::string guess = nearest_name(key, names);
  return {fmt::format("{}: unknown key {}{}; config keys belong under `config:`", where, key,
                      guess.empty() ? "" : fmt::format(", did you mean {}?", guess))};
}

Result<void> take_entries(const std::vector<FlatYamlEntry>& entries, const std::string& file, LogInfo& info) {
  const auto meanings = meanings_of_keys(info);
  std::vector<std::pair<std::string, std::string>> config;
  for (const auto& [key, value, line] : entries) {
    const std::string where = fmt::format("{}:{}", file, line);
    if (key.starts_with(log_format::kConfigSection)) {
      config.emplace_back(key.substr(log_format::kConfigSection.size()), value);
      continue;
    }
    const auto meaning = meanings.find(key);
    if (meaning == meanings.end()) return unknown_key(where, key, meanings);
    if (auto done = meaning->second(value); !done)
      return Error{fmt::format("{}: {}: {}", where, key, done.error().message)};
  }
  std::ranges::move(config, std::back_inserter(info.settings));
  return {};
}

Result<void> read_info(const fs::path& folder, LogInfo& info) {
  const fs::path file = folder / log_format::kInfoFile;
  if (!fs::exists(file))
    return Error{fmt::format("{}: {} is missing; it must have at least the line `{}: {}`", folder.string(),
                             log_format::kInfoFile, log_format::kVersionKey, log_format::kVersion)};
  const auto text = read_file(file);
  if (!text) return text.error();
  const auto entries = flatten_yaml(*text, file.string());
  if (!entries) return entries.error();
  if (std::ranges::find(*entries, log_format::kVersionKey, &FlatYamlEntry::key) == entries->end())
    return Error{fmt::format("{}: the line `{}: {}` is missing", file.string(), log_format::kVersionKey,
                             log_format::kVersion)};
  return take_entries(*entries, file.string(), info);
}

Result<void> read_landmarks(const fs::path& file, LogInfo& info) {
  if (!fs::exists(file)) return {};
  auto table = TextTable::open(file, layout_of(log_format::kLandmarks));
  if (!table) return table.error();
  while (table->next()) {
    const TrueLandmark landmark{read_id(*table, 0), table->number(1), table->number(2),
                                table->is_empty(3) ? 0.0 : table->number(3)};
    if (std::ranges::find(info.landmarks, landmark.id, &TrueLandmark::id) != info.landmarks.end())
      table->fail(fmt::format("landmark {} is listed twice", to_string(landmark.id)));
    info.landmarks.push_back(landmark);
  }
  if (table->error()) return *table->error();
  return {};
}

/// What the rows of observations.csv have, read as far as the first that says what it is of.
struct Sighted {
  bool named = false;
  bool polar = false;
  bool pixel = false;
};

Sighted look_at_observations(const fs::path& file) {
  Sighted sighted;
  if (!fs::exists(file)) return sighted;
  auto table = TextTable::open(file, layout_of(log_format::kObservations));
  while (table && !sighted.named && table->next()) {
    sighted.named = !table->is_empty(1);
    sighted.polar = sighted.polar || !table->is_empty(2) || !table->is_empty(3);
    sighted.pixel = sighted.pixel || !table->is_empty(4) || !table->is_empty(5);
  }
  return sighted;
}

bool has_images(const fs::path& folder) { return fs::exists(folder / log_format::kImages.file); }

/// The first image of the log that there is.
std::optional<fs::path> first_image(const fs::path& folder) {
  auto table = TextTable::open(folder / log_format::kImages.file, layout_of(log_format::kImages));
  while (table && table->next())
    if (!table->is_empty(1) && fs::is_regular_file(image_path(folder, *table)))
      return image_path(folder, *table);
  return std::nullopt;
}

/// A camera that was calibrated with images of another size sees nothing where it should.
Result<void> check_image_size(const fs::path& folder, const fs::path& camera_file,
                              const CameraOptions& camera) {
  const auto file = first_image(folder);
  if (!file) return {};
  const auto image = read_image(*file);
  if (!image || (image->width_px() == camera.width_px && image->height_px() == camera.height_px)) return {};
  return Error{fmt::format("{}: image_width and image_height are {} and {}, but {} has {} x {} pixels",
                           camera_file.string(), camera.width_px, camera.height_px, file->string(),
                           image->width_px(), image->height_px())};
}

Result<void> read_camera(const fs::path& folder, LogInfo& info) {
  const fs::path file = folder / log_format::kCameraFile;
  if (!fs::exists(file)) return {};
  const auto camera = read_camera_yaml(file);
  if (!camera) return camera.error();
  if (auto fits = check_image_size(folder, file, *camera); !fits) return fits;
  std::ranges::move(lens_settings(*camera), std::back_inserter(info.settings));
  return {};
}

Result<void> open_stream(const fs::path& folder, const log_format::Table& format,
                         EventStream::ReadRow read_row, std::vector<EventStream>& streams) {
  const fs::path file = folder / format.file;
  if (!fs::exists(file)) return {};
  auto table = TextTable::open(file, layout_of(format));
  if (!table) return table.error();
  streams.emplace_back(*std::move(table), std::move(read_row), EventStream::BackInTime::kRefuse);
  return {};
}

Result<void> check_one_odometry(const fs::path& folder) {
  std::string found;
  for (const auto& table : log_format::kOdometryTables) {
    if (!fs::exists(folder / table.file)) continue;
    if (!found.empty())
      return Error{
          fmt::format("{}: both {} and {} exist; remove one of them", folder.string(), found, table.file)};
    found = table.file;
  }
  return {};
}

/// Recordings that lie in the folder and are no part of the log.
std::vector<std::string> describe_bags_in(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(folder, failed))
    if (const auto kind = entry.path().extension(); kind == ".bag" || kind == ".db3" || kind == ".mcap")
      names.push_back(entry.path().filename().string());
  if (names.empty()) return {};
  std::ranges::sort(names);
  return {
      fmt::format("{} says that this is a log folder: {} in it {} not read; to read a bag, give its own name",
                  log_format::kInfoFile, fmt::join(names, " and "), names.size() > 1 ? "are" : "is")};
}

}  // namespace

bool names_log_folder(const fs::path& folder) {
  const auto text = read_file(folder / log_format::kInfoFile);
  return text && text->find(log_format::kVersionKey) != std::string::npos;
}

bool is_log_folder(const fs::path& folder) {
  return fs::exists(folder / log_format::kInfoFile) ||
         std::ranges::any_of(log_format::kTables, [&](const auto& table) {
           return table.file != log_format::kLandmarks.file && fs::exists(folder / table.file);
         });
}

Result<std::unique_ptr<Source>> open_log_folder(const fs::path& folder) {
  const Sighted sighted = look_at_observations(folder / log_format::kObservations.file);
  LogInfo info{.name = base_name(folder),
               .format = "log folder",
               .settings = {},
               .landmarks = {},
               .identities = sighted.named || !(sighted.polar || sighted.pixel),
               .only_pixels = !sighted.polar && (sighted.pixel || has_images(folder)),
               .truth_sensor_m = {}};
  if (auto done = read_camera(folder, info); !done) return done.error();
  if (auto done = read_info(folder, info); !done) return done.error();
  if (auto done = read_landmarks(folder / log_format::kLandmarks.file, info); !done) return done.error();
  if (auto done = check_one_odometry(folder); !done) return done.error();

  // In the order that events of one stamp come in.
  const std::vector<std::pair<log_format::Table, EventStream::ReadRow>> tables{
      {log_format::kWheels, read_wheels_row},        {log_format::kVelocity, read_velocity_row},
      {log_format::kSteering, read_steering_row},    {log_format::kOdometry, read_odometry_row},
      {log_format::kYawRate, read_yaw_rate_row},     {log_format::kTruth, read_truth_row},
      {log_format::kObservations, read_observation}, {log_format::kImages, read_image_below(folder)}};
  std::vector<EventStream> streams;
  for (const auto& [format, read_row] : tables)
    if (auto done = open_stream(folder, format, read_row, streams); !done) return done.error();
  return std::unique_ptr<Source>(
      std::make_unique<MergedLog>(std::move(info), std::move(streams), describe_bags_in(folder)));
}

}  // namespace waymark
