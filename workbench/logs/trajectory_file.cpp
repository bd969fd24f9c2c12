#include "workbench/logs/trajectory_file.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "workbench/logs/files.hpp"
#include "workbench/logs/stamp_unit.hpp"
#include "workbench/logs/text_lines.hpp"

namespace waymark {
namespace {

constexpr std::size_t kTumColumns = 8;
constexpr std::size_t kKittiColumns = 12;
constexpr const char* kExpected =
    "stamp_s tx ty tz qx qy qz qw as in TUM files, the same as in EuRoC's, or the 12 of a 3 x 4 matrix as in "
    "KITTI's";

enum class Format { kTum, kEuroc, kKitti };

constexpr std::array<const char*, 3> kFormatNames{"TUM", "EuRoC", "KITTI"};

/// One line with its columns.
struct TrajectoryRow {
  int line = 0;
  std::vector<std::string_view> cells;
  std::vector<double> numbers;
};

struct TrajectoryRows {
  std::vector<TrajectoryRow> rows;
  bool has_commas = false;
};

std::vector<std::string_view> split_cells(std::string_view line) {
  std::vector<std::string_view> cells;
  const char separator = line.find(',') != std::string_view::npos ? ',' : ';';
  if (line.find(separator) == std::string_view::npos) {
    for (auto word = take_word(line); !word.empty(); word = take_word(line)) cells.push_back(word);
    return cells;
  }
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(separator, begin), line.size());
    std::string_view cell = line.substr(begin, end - begin);
    cells.push_back(take_word(cell));
    if (!take_word(cell).empty()) cells.back() = line.substr(begin, end - begin);  // two words are no number
    begin = end + 1;
  }
  if (cells.back().empty()) cells.pop_back();  // a separator at the end
  return cells;
}

/// The numbers of a row; an error names the first that is none.
Result<TrajectoryRow> read_trajectory_row(const TextLines& lines) {
  TrajectoryRow row{lines.number(), split_cells(lines.line()), {}};
  for (const std::string_view cell : row.cells) {
    const auto number = parse_number(cell);
    if (!number || !std::isfinite(*number)) return lines.error(in_quotes(cell) + " is not a finite number");
    row.numbers.push_back(*number);
  }
  return row;
}

/// A line of column names that is no comment.
bool is_header(std::string_view line) {
  const auto cells = split_cells(line);
  return !cells.empty() && !parse_number(cells.front());
}

Result<TrajectoryRows> read_trajectory_rows(TextLines& lines) {
  TrajectoryRows all;
  bool is_first = true;
  while (lines.next()) {
    if (std::exchange(is_first, false) && is_header(lines.line())) continue;
    auto row = read_trajectory_row(lines);
    if (!row) return row.error();
    if (all.rows.empty()) all.has_commas = lines.line().find(',') != std::string_view::npos;
    if (!all.rows.empty() && row->cells.size() != all.rows.front().cells.size())
      return lines.error(fmt::format("expected {} columns as in line {}, found {}",
                                     all.rows.front().cells.size(), all.rows.front().line,
                                     row->cells.size()));
    if (row->cells.size() < kTumColumns)
      return lines.error(fmt::format("expected {} columns or more ({}), found {}", kTumColumns, kExpected,
                                     row->cells.size()));
    all.rows.push_back(*std::move(row));
  }
  if (all.rows.empty()) return Error{fmt::format("{}: has no rows; expected {}", lines.name(), kExpected)};
  return all;
}

/// The comments and names above the first row.
std::string_view header_of(std::string_view text) {
  std::size_t end = 0;
  while (end < text.size() && std::string_view("0123456789+-.").find(text[end]) == std::string_view::npos)
    end = std::min(text.find('\n', end), text.size() - 1) + 1;
  return text.substr(0, end);
}

/// Where the header names the quaternion's parts: whether its w is before its x.
std::optional<bool> names_w_first(std::string_view text) {
  const std::string_view line = header_of(text);
  std::optional<std::size_t> w, x;
  std::size_t at = 0;
  while ((at = line.find_first_of("qQ", at)) != std::string_view::npos) {
    const std::size_t end = std::min(line.find_first_of(" ,;\t\r\n[", at), line.size());
    const std::string_view name = line.substr(at, end - at);
    if (!w && (name.ends_with('w') || name.ends_with('W'))) w = at;
    if (!x && (name.ends_with('x') || name.ends_with('X'))) x = at;
    at = end;
  }
  return w && x ? std::optional(*w < *x) : std::nullopt;
}

Eigen::Matrix3d rotation_of(const std::vector<double>& n) {
  return Eigen::Matrix3d{{n[0], n[1], n[2]}, {n[4], n[5], n[6]}, {n[8], n[9], n[10]}};
}

/// Files are written with 6 digits and more.
bool is_rotation(const Eigen::Matrix3d& R) {
  constexpr double kRounding = 1e-3;
  return (R * R.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() < kRounding &&
         R.determinant() > 0.0;
}

Format format_of(const TrajectoryRows& all, StampUnit unit, std::optional<bool> w_first) {
  const TrajectoryRow& first = all.rows.front();
  if (first.cells.size() == kKittiColumns && is_rotation(rotation_of(first.numbers))) return Format::kKitti;
  return w_first.value_or(all.has_commas && unit == StampUnit::kNanoseconds) ? Format::kEuroc : Format::kTum;
}

std::vector<double> stamps_of(const TrajectoryRows& all) {
  std::vector<double> counts;
  counts.reserve(all.rows.size());
  for (const TrajectoryRow& row : all.rows) counts.push_back(row.numbers.front());
  return counts;
}

/// Turns rows into poses; an error is without the file's name and line.
class RowReader {
 public:
  RowReader(Format format, StampUnit unit) : format_(format), unit_(unit) {}

  Result<SpacePose> pose(const TrajectoryRow& row, std::size_t index) const {
    return format_ == Format::kKitti ? of_matrix(row, index) : of_quaternion(row);
  }

 private:
  [[nodiscard]] Result<SpacePose> of_quaternion(const TrajectoryRow& row) const {
    const auto& n = row.numbers;
    const auto stamp = parse_stamp(row.cells.front(), unit_);
    if (!stamp) return Error{in_quotes(row.cells.front()) + " is not a stamp"};
    Eigen::Quaterniond q = format_ == Format::kEuroc ? Eigen::Quaterniond(n[4], n[5], n[6], n[7])
                                                     : Eigen::Quaterniond(n[7], n[4], n[5], n[6]);
    if (q.squaredNorm() < 1e-6) return Error{"the quaternion is zero"};
    return SpacePose{*stamp, {n[1], n[2], n[3]}, q.normalized()};
  }

  [[nodiscard]] static Result<SpacePose> of_matrix(const TrajectoryRow& row, std::size_t index) {
    const auto& n = row.numbers;
    const Eigen::Matrix3d R = rotation_of(n);
    if (!is_rotation(R)) return Error{"the matrix is no rotation"};
    return SpacePose{
        Stamp{std::chrono::seconds(index)}, {n[3], n[7], n[11]}, Eigen::Quaterniond(R).normalized()};
  }

  Format format_;
  StampUnit unit_;
};

Result<SpacePath> read_path(const TrajectoryRows& all, const RowReader& reader, const std::string& name) {
  SpacePath path;
  path.reserve(all.rows.size());
  for (const TrajectoryRow& row : all.rows) {
    const auto pose = reader.pose(row, path.size());
    if (!pose) return Error{fmt::format("{}:{}: {}", name, row.line, pose.error().message)};
    if (!path.empty() && pose->stamp < path.back().stamp)
      return Error{fmt::format("{}:{}: stamp {} is before {} in the row above; rows must be sorted by time",
                               name, row.line, to_string(pose->stamp), to_string(path.back().stamp))};
    path.push_back(*pose);
  }
  return path;
}

bool is_whole_second(const SpacePose& pose) {
  return pose.stamp.since_epoch % std::chrono::seconds(1) == Duration{0};
}

std::string describe_repeats(const SpacePath& path) {
  std::size_t repeats = 0;
  for (std::size_t i = 1; i < path.size(); ++i) repeats += path[i].stamp == path[i - 1].stamp ? 1 : 0;
  if (repeats == 0) return "";
  return fmt::format("{} of {} rows have the same stamp as the row before{}", repeats, path.size(),
                     std::ranges::all_of(path, is_whole_second)
                         ? ": stamps are whole seconds; write them with decimals"
                         : "");
}

std::vector<std::string> notes_of(const TrajectoryFile& file, StampUnit unit, std::size_t columns) {
  std::vector<std::string> notes;
  if (!file.has_stamps)
    notes.emplace_back("poses without stamps, as in KITTI's files");
  else if (unit != StampUnit::kSeconds)
    notes.push_back(fmt::format("stamps are taken as {}", name_of(unit)));
  if (file.format == kFormatNames[1])
    notes.emplace_back("quaternions are taken as w, x, y, z, as in EuRoC's files");
  if (file.has_stamps && columns > kTumColumns)
    notes.push_back(fmt::format("rows have {} columns: the first {} are used, stamp, position and quaternion",
                                columns, kTumColumns));
  if (auto repeats = describe_repeats(file.path); !repeats.empty()) notes.push_back(std::move(repeats));
  return notes;
}

}  // namespace

Result<TrajectoryFile> read_trajectory(const std::filesystem::path& path) {
  auto text = read_file(path);
  if (!text) return text.error();
  const auto w_first = names_w_first(*text);
  TextLines lines(*std::move(text), path.string());
  const auto all = read_trajectory_rows(lines);
  if (!all) return all.error();
  const StampUnit unit = unit_of(stamps_of(*all));
  const Format format = format_of(*all, unit, w_first);
  auto poses = read_path(*all, RowReader(format, unit), path.string());
  if (!poses) return poses.error();
  TrajectoryFile file{
      *std::move(poses), kFormatNames[static_cast<std::size_t>(format)], format != Format::kKitti, {}};
  for (const std::string& note : notes_of(file, unit, all->rows.front().cells.size()))
    file.notes.push_back(fmt::format("{}: {}", path.filename().string(), note));
  return file;
}

}  // namespace waymark
