#include "workbench/logs/map_files.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "waymark/core/gaussian.hpp"

#include "workbench/logs/files.hpp"
#include "workbench/logs/number_text.hpp"
#include "workbench/logs/text_lines.hpp"
#include "workbench/logs/text_table.hpp"
#include "workbench/logs/upper_triangle.hpp"

namespace waymark {
namespace {

constexpr std::string_view kMapCsvColumns = "id,x_m,y_m,z_m,sxx,sxy,sxz,syy,syz,szz,observations";
constexpr std::string_view kMapVersion = "1";
constexpr std::string_view kMapEnd = "end";
constexpr std::array<std::string_view, 5> kFamilies{"none", "marker", "barcode", "corner",
                                                    "robot"};  // in order of the enum

LandmarkEstimate read_landmark(TextTable& row) {
  LandmarkEstimate landmark;
  const int number = row.integer(0);
  if (number >= 0) landmark.id = {LandmarkId::Family::kMarker, number};
  landmark.position_m = {row.number(1), row.number(2), row.number(3)};
  std::size_t column = 4;
  for (const auto& [i, j] : kUpperTriangle)
    landmark.covariance(i, j) = landmark.covariance(j, i) = row.number(column++);
  landmark.observations = row.integer(column);
  if (!is_covariance(landmark.covariance)) row.fail("the covariance is not positive semi-definite");
  return landmark;
}

Result<void> check_sizes(const MapState& map) {
  const auto count = static_cast<Eigen::Index>(map.ids.size());
  const Eigen::Index coordinates = count * map.landmark_dimension;
  if (static_cast<Eigen::Index>(map.observations.size()) == count && map.landmarks.size() == coordinates &&
      map.covariance.rows() == 3 + coordinates && map.covariance.cols() == 3 + coordinates)
    return {};
  return Error{
      fmt::format(
          "a map of {} landmarks of dimension {} has {} observations, {} coordinates and a covariance of "
          "{} x {}",
          count, map.landmark_dimension, map.observations.size(), map.landmarks.size(), map.covariance.rows(),
          map.covariance.cols()),
      Error::Kind::kFailed};
}

std::string one_line(std::string text) {
  std::ranges::replace_if(
      text, [](char c) { return c == '\n' || c == '\r'; }, ' ');
  return text;
}

void append_header(std::string& text, const MapState& map) {
  text += fmt::format("waymark_map: {}\nmade_by: {}\nstamp_s: ", kMapVersion, one_line(map.made_by));
  append_stamp(text, map.stamp);
  text += "\npose:";
  const Pose2& pose = map.T_world_robot;
  for (const double value : {pose.x_m, pose.y_m, pose.theta_rad}) append_shortest(text += ' ', value);
  text += fmt::format("\nlandmark_dimension: {}\nlandmarks: {}\n", map.landmark_dimension, map.ids.size());
}

void append_landmarks(std::string& text, const MapState& map) {
  for (std::size_t i = 0; i < map.ids.size(); ++i) {
    text += family_name(map.ids[i].family);
    append_integer(text += ' ', map.ids[i].number);
    append_integer(text += ' ', map.observations[i]);
    for (int axis = 0; axis < map.landmark_dimension; ++axis)
      append_shortest(text += ' ',
                      map.landmarks[static_cast<Eigen::Index>(i) * map.landmark_dimension + axis]);
    text += '\n';
  }
}

void append_covariance(std::string& text, const Eigen::MatrixXd& P) {
  text += fmt::format("covariance: {}\n", P.rows());
  for (Eigen::Index i = 0; i < P.rows(); ++i) {
    for (Eigen::Index j = i; j < P.cols(); ++j) {
      append_shortest(text, P(j, i));  // symmetric; down a column is along the memory
      text += j + 1 < P.cols() ? ' ' : '\n';
    }
  }
}

constexpr std::string_view kHexDigits = "0123456789abcdef";

void append_hex(std::string& text, std::span<const std::uint8_t> bytes) {
  for (const std::uint8_t byte : bytes) {
    text += kHexDigits[byte / 16];
    text += kHexDigits[byte % 16];
  }
}

void append_patches(std::string& text, const MapState& map) {
  if (map.patches.empty()) return;
  text += fmt::format("patches: {}\n", map.patches.size());
  for (const LandmarkPatch& patch : map.patches) {
    text += family_name(patch.id.family);
    append_integer(text += ' ', patch.id.number);
    const Pose2& pose = patch.T_world_robot;
    for (const double value : {pose.x_m, pose.y_m, pose.theta_rad}) append_shortest(text += ' ', value);
    append_hex(text += ' ', patch.pixels);
    text += '\n';
  }
}

/// Reads map.waymark line by line. As in a TextTable the first thing wrong stays in `error` and what is read
/// after it is of no meaning.
class MapReader {
 public:
  explicit MapReader(TextLines lines) : lines_(std::move(lines)) {}

  Result<MapState> read() {
    MapState map;
    read_header(map);
    const int count = integer_after("landmarks");
    read_landmarks(map, count);
    read_covariance(map);
    read_patches_and_end(map);
    if (!error_) check(map);
    if (error_) return *error_;
    return map;
  }

 private:
  void fail(std::string_view what) {
    if (!error_) error_ = lines_.error(what);
  }

  bool next_line(std::string_view expected) {
    if (error_) return false;
    if (!lines_.next()) error_ = Error{fmt::format("{}: the file ends before {}", lines_.name(), expected)};
    return !error_;
  }

  /// What stands behind "key: " in the next line.
  std::string_view value_after(std::string_view key) {
    if (!next_line(fmt::format("`{}:`", key))) return {};
    const std::string_view line = lines_.line();
    if (line.starts_with(key) && line.substr(key.size()).starts_with(':')) {
      std::string_view value = line.substr(key.size() + 1);
      if (value.starts_with(' ')) value.remove_prefix(1);
      return value;
    }
    fail(fmt::format("expected `{}:`, found {}", key, in_quotes(line)));
    return {};
  }

  double take_number(std::string_view& rest) {
    const std::string_view word = take_word(rest);
    const auto value = parse_number(word);
    if (!value || !std::isfinite(*value)) fail(in_quotes(word) + " is not a finite number");
    return value.value_or(0.0);
  }

  int take_integer(std::string_view& rest) {
    const std::string_view word = take_word(rest);
    const auto value = parse_integer(word);
    if (!value) fail(in_quotes(word) + " is not a whole number");
    return value.value_or(0);
  }

  void expect_end_of_line(std::string_view rest) {
    if (!take_word(rest).empty()) fail("unexpected text at the end of this line");
  }

  int integer_after(std::string_view key) {
    std::string_view rest = value_after(key);
    if (error_) return 0;
    const int value = take_integer(rest);
    expect_end_of_line(rest);
    return value;
  }

  void read_header(MapState& map) {
    if (const auto version = value_after("waymark_map"); !error_ && version != kMapVersion)
      fail(fmt::format("version {} of the map format is not supported; only {} is", in_quotes(version),
                       kMapVersion));
    map.made_by = value_after("made_by");
    if (const auto text = value_after("stamp_s"); !error_) {
      const auto stamp = parse_stamp(text);
      if (!stamp) fail(in_quotes(text) + " is not a number of seconds");
      map.stamp = stamp.value_or(Stamp{});
    }
    if (auto rest = value_after("pose"); !error_) {
      map.T_world_robot = {take_number(rest), take_number(rest), take_number(rest)};
      expect_end_of_line(rest);
    }
    map.landmark_dimension = integer_after("landmark_dimension");
    if (map.landmark_dimension != 2 && map.landmark_dimension != 3)
      fail("the dimension of a landmark must be 2 or 3");
  }

  LandmarkId take_id(std::string_view& rest) {
    const std::string_view word = take_word(rest);
    const auto family = family_named(word);
    if (!family)
      fail(in_quotes(word) + " is not a kind of landmark; expected none, marker, barcode or corner");
    return {family.value_or(LandmarkId::Family::kNone), take_integer(rest)};
  }

  void read_landmarks(MapState& map, int count) {
    if (count < 0) fail("the number of landmarks cannot be negative");
    std::vector<double> coordinates;
    for (int i = 0; i < count && next_line("all its landmarks"); ++i) {
      std::string_view rest = lines_.line();
      map.ids.push_back(take_id(rest));
      map.observations.push_back(take_integer(rest));
      if (map.observations.back() < 0) fail("the number of observations cannot be negative");
      for (int axis = 0; axis < map.landmark_dimension; ++axis) coordinates.push_back(take_number(rest));
      expect_end_of_line(rest);
    }
    map.landmarks =
        Eigen::Map<const Eigen::VectorXd>(coordinates.data(), static_cast<Eigen::Index>(coordinates.size()));
  }

  void read_covariance(MapState& map) {
    const int size = integer_after("covariance");
    if (error_) return;
    const Eigen::Index n = 3 + map.landmarks.size();
    if (size != n)
      return fail(fmt::format("the covariance has size {}, but pose and landmarks need {}", size, n));
    // Before memory is asked for: a number takes two bytes at least.
    if (lines_.bytes() - lines_.bytes_read() < static_cast<std::size_t>(n * (n + 1)))
      return fail("the file is too short for a covariance of this size");
    map.covariance.resize(n, n);
    for (Eigen::Index i = 0; i < n && next_line("all rows of the covariance"); ++i) {
      std::string_view rest = lines_.line();
      for (Eigen::Index j = i; j < n && !error_; ++j) map.covariance(j, i) = take_number(rest);
      expect_end_of_line(rest);
    }
    if (!error_) map.covariance.triangularView<Eigen::StrictlyUpper>() = map.covariance.transpose();
  }

  void read_patches_and_end(MapState& map) {
    if (!next_line("the line `end`")) return;
    if (lines_.line().starts_with("patches: ")) {
      std::string_view rest = lines_.line().substr(std::string_view("patches: ").size());
      const int count = take_integer(rest);
      expect_end_of_line(rest);
      for (int i = 0; i < count && next_line("all its patches"); ++i) map.patches.push_back(take_patch());
      if (!next_line("the line `end`")) return;
    }
    if (lines_.line() != kMapEnd) fail("expected the line `end`");
  }

  LandmarkPatch take_patch() {
    std::string_view rest = lines_.line();
    LandmarkPatch patch;
    patch.id = take_id(rest);
    patch.T_world_robot = {take_number(rest), take_number(rest), take_number(rest)};
    const std::string_view hex = take_word(rest);
    for (std::size_t i = 0; i + 1 < hex.size(); i += 2) {
      const std::size_t high = kHexDigits.find(hex[i]), low = kHexDigits.find(hex[i + 1]);
      if (high == std::string_view::npos || low == std::string_view::npos)
        fail("the pixels of a patch must be two hexadecimal digits each");
      patch.pixels.push_back(static_cast<std::uint8_t>(16 * high + low));
    }
    const double side = std::sqrt(static_cast<double>(patch.pixels.size()));
    if (hex.empty() || hex.size() % 2 != 0 || side != std::floor(side))
      fail("the pixels of a patch must be a square of two hexadecimal digits each");
    expect_end_of_line(rest);
    return patch;
  }

  void check(const MapState& map) {
    auto ids = map.ids;
    std::erase_if(ids, [](LandmarkId id) { return id.family == LandmarkId::Family::kNone; });
    std::ranges::sort(ids);
    if (const auto twice = std::ranges::adjacent_find(ids); twice != ids.end())
      error_ = Error{fmt::format("{}: landmark {} is listed twice", lines_.name(), to_string(*twice))};
    else if (!is_covariance(map.covariance))
      error_ = Error{lines_.name() + ": the covariance is not positive semi-definite"};
    for (const LandmarkPatch& patch : map.patches)
      if (!error_ && std::ranges::find(map.ids, patch.id) == map.ids.end())
        error_ = Error{fmt::format("{}: a patch of landmark {}, which is not in the map", lines_.name(),
                                   to_string(patch.id))};
  }

  TextLines lines_;
  std::optional<Error> error_;
};

}  // namespace

std::string_view family_name(LandmarkId::Family family) {
  return kFamilies[static_cast<std::size_t>(family)];
}

std::optional<LandmarkId::Family> family_named(std::string_view name) {
  const auto found = std::ranges::find(kFamilies, name);
  if (found == kFamilies.end()) return std::nullopt;
  return static_cast<LandmarkId::Family>(found - kFamilies.begin());
}

std::string format_map_csv(const Snapshot& snapshot) {
  std::string text(kMapCsvColumns);
  text += '\n';
  for (const auto& landmark : snapshot.landmarks) {
    append_integer(text, landmark.id.number);
    for (const double coordinate : landmark.position_m) append_shortest(text += ',', coordinate);
    for (const auto& [i, j] : kUpperTriangle) append_shortest(text += ',', landmark.covariance(i, j));
    append_integer(text += ',', landmark.observations);
    text += '\n';
  }
  return text;
}

Result<void> write_map_csv(const std::filesystem::path& path, const Snapshot& snapshot) {
  return write_file(path, format_map_csv(snapshot));
}

Result<std::vector<LandmarkEstimate>> read_map_csv(const std::filesystem::path& path) {
  auto table = TextTable::open(path, {std::string(kMapCsvColumns), TableLayout::Separator::kComma, ""});
  if (!table) return table.error();
  std::vector<LandmarkEstimate> landmarks;
  while (table->next()) landmarks.push_back(read_landmark(*table));
  if (table->error()) return *table->error();
  return landmarks;
}

Result<std::string> format_map(const MapState& map) {
  if (auto done = check_sizes(map); !done) return done.error();
  std::string text;
  append_header(text, map);
  append_landmarks(text, map);
  append_covariance(text, map.covariance);
  append_patches(text, map);
  return text.append(kMapEnd) += '\n';
}

Result<void> write_map(const std::filesystem::path& path, const MapState& map) {
  const auto text = format_map(map);
  if (!text) return text.error();
  return write_file(path, *text);
}

Result<MapState> read_map(const std::filesystem::path& path) {
  auto lines = TextLines::open(path);
  if (!lines) return lines.error();
  return MapReader(*std::move(lines)).read();
}

Result<MapState> parse_map(std::string text, std::string name) {
  return MapReader(TextLines(std::move(text), std::move(name))).read();
}

}  // namespace waymark
