#include "workbench/datasets/plaza.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "waymark/core/angle.hpp"

#include "workbench/config/known_settings.hpp"
#include "workbench/logs/event_list.hpp"
#include "workbench/logs/files.hpp"
#include "workbench/logs/text_table.hpp"

namespace waymark {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kOdometrySuffix = "_DR.txt";
constexpr std::string_view kRangeSuffix = "_TD.txt";
constexpr std::string_view kOdometryColumns = "time s, distance m, turn rad";
constexpr std::string_view kRangeColumns = "time s, sender, beacon, range m";

/// A run as its four tables, whichever files they came from.
struct Run {
  std::string name;
  Eigen::MatrixXd odometry;  ///< time, distance and turn since the row above
  Eigen::MatrixXd ranges;    ///< time, sender, beacon, range
  Eigen::MatrixXd truth;     ///< time, x, y, heading; one row more than odometry, or none
  Eigen::MatrixXd beacons;   ///< id, x, y
};

/// The run of "Plaza1_.mat" is Plaza1.
std::string run_name(const fs::path& file) {
  std::string name = file.stem().string();
  while (name.ends_with('_')) name.pop_back();
  return name;
}

Stamp stamp_of(const Eigen::MatrixXd& table, Eigen::Index row) { return stamp_from_seconds(table(row, 0)); }

/// Everything that later steps take for granted.
Result<void> check(const Run& run, const std::string& where) {
  constexpr double kLatest_s = 9e9;
  const auto refuse = [&where](std::string_view table, Eigen::Index row, std::string_view what) {
    return Error{fmt::format("{}: {}: row {}: {}", where, table, row + 1, what)};
  };
  if (run.odometry.rows() < 2) return Error{where + ": DR: fewer than two rows of odometry"};
  for (const auto& [name, table] :
       {std::pair{"DR", &run.odometry}, std::pair{"TD", &run.ranges}, std::pair{"GT", &run.truth}})
    for (Eigen::Index row = 0; row < table->rows(); ++row)
      if (std::abs((*table)(row, 0)) >= kLatest_s) return refuse(name, row, "is not a time in seconds");
  for (Eigen::Index row = 1; row < run.odometry.rows(); ++row)
    if (run.odometry(row, 0) < run.odometry(row - 1, 0)) return refuse("DR", row, "goes back in time");
  for (Eigen::Index row = 0; row < run.ranges.rows(); ++row) {
    if (run.ranges(row, 3) < 0.0) return refuse("TD", row, "a range cannot be negative");
    if (std::abs(run.ranges(row, 2)) > 1e6) return refuse("TD", row, "is not the number of a beacon");
  }
  return {};
}

LandmarkId beacon_id(double number) {
  return {LandmarkId::Family::kMarker, static_cast<std::int32_t>(number)};
}

/// Whether the robot of a published run moves against its published heading.
bool drives_backwards(const Run& run) { return run.name == "Plaza2"; }

/// Dead reckoning in steps that each bend as an arc does; a row belongs to the time since the one above.
void add_odometry(const Run& run, double sign, std::vector<Event>& events) {
  Pose2 pose;
  const Duration first_step = stamp_of(run.odometry, 1) - stamp_of(run.odometry, 0);
  events.emplace_back(stamp_of(run.odometry, 0) - first_step, OdometryPose{pose});
  for (Eigen::Index row = 0; row < run.odometry.rows(); ++row) {
    const double distance_m = sign * run.odometry(row, 1);
    const double turn_rad = run.odometry(row, 2);
    const double course_rad = 0.5 * turn_rad;
    pose = pose * Pose2{distance_m * std::cos(course_rad), distance_m * std::sin(course_rad), turn_rad};
    events.emplace_back(stamp_of(run.odometry, row), OdometryPose{pose});
  }
}

void add_truth(const Run& run, std::vector<Event>& events) {
  for (Eigen::Index row = 0; row < run.truth.rows(); ++row)
    events.emplace_back(stamp_of(run.truth, row),
                        Truth{run.truth(row, 1), run.truth(row, 2), wrap_angle(run.truth(row, 3))});
}

/// Returns how many were not in the order of time.
int add_ranges(const Run& run, std::vector<Event>& events) {
  int out_of_order = 0;
  for (Eigen::Index row = 0; row < run.ranges.rows(); ++row) {
    const Observation observation{beacon_id(run.ranges(row, 2)), Range{run.ranges(row, 3)}, std::nullopt};
    events.emplace_back(stamp_of(run.ranges, row), Observations{observation});
    out_of_order += row > 0 && run.ranges(row, 0) < run.ranges(row - 1, 0) ? 1 : 0;
  }
  return out_of_order;
}

Result<LogInfo> info_of(const Run& run) {
  LogInfo info;
  info.name = run.name;
  info.format = "Plaza";
  auto settings = known_settings("plaza");
  if (!settings) return settings.error();
  info.settings = *std::move(settings);
  for (Eigen::Index row = 0; row < run.beacons.rows(); ++row)
    info.landmarks.push_back({beacon_id(run.beacons(row, 0)), run.beacons(row, 1), run.beacons(row, 2), 0.0});
  return info;
}

Result<std::unique_ptr<Source>> make_source(const Run& run, const std::string& where, bool fix_known_errors) {
  if (auto checked = check(run, where); !checked) return checked.error();
  auto info = info_of(run);
  if (!info) return info.error();
  const bool turn_round = fix_known_errors && drives_backwards(run);
  std::vector<Event> events;
  add_odometry(run, turn_round ? -1.0 : 1.0, events);
  add_truth(run, events);
  const int out_of_order = add_ranges(run, events);
  std::vector<std::string> notes;
  if (turn_round)
    notes.emplace_back(
        "the robot drives backwards: its distances, which are published as positive, were negated "
        "(input.fix_known_errors)");
  if (out_of_order > 0) notes.push_back(fmt::format("ranges sorted by time: {}", out_of_order));
  return std::unique_ptr<Source>(
      std::make_unique<EventList>(*std::move(info), std::move(events), std::move(notes)));
}

Result<Eigen::MatrixXd> read_text(const fs::path& file, const std::string& columns) {
  auto table = TextTable::open(file, {columns, TableLayout::Separator::kBlank, ""});
  if (!table) return table.error();
  const auto count = static_cast<std::size_t>(std::ranges::count(columns, ',')) + 1;
  std::vector<double> cells;
  while (table->next())
    for (std::size_t column = 0; column < count; ++column) cells.push_back(table->number(column));
  if (table->error()) return *table->error();
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  return Eigen::MatrixXd(Eigen::Map<const RowMajor>(
      cells.data(), static_cast<Eigen::Index>(cells.size() / count), static_cast<Eigen::Index>(count)));
}

}  // namespace

bool is_plaza(const MatFile& file) { return file.has_all({"GT", "DR", "TD"}); }

std::vector<fs::path> plaza_text_runs(const fs::path& folder) {
  std::vector<fs::path> runs;
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(folder, failed)) {
    const std::string file = entry.path().string();
    if (!file.ends_with(kOdometrySuffix)) continue;
    const std::string run = file.substr(0, file.size() - kOdometrySuffix.size());
    if (fs::exists(run + std::string(kRangeSuffix))) runs.emplace_back(run);
  }
  std::ranges::sort(runs);
  return runs;
}

Result<std::unique_ptr<Source>> open_plaza(const MatFile& file, bool fix_known_errors) {
  auto odometry = file.matrix("DR", 3, kOdometryColumns);
  if (!odometry) return odometry.error();
  auto ranges = file.matrix("TD", 4, kRangeColumns);
  if (!ranges) return ranges.error();
  auto truth = file.matrix("GT", 4, "time s, x m, y m, heading rad");
  if (!truth) return truth.error();
  auto beacons = file.has("TL") ? file.matrix("TL", 3, "beacon, x m, y m") : Eigen::MatrixXd(0, 3);
  if (!beacons) return beacons.error();
  const Run run{run_name(file.path()), *std::move(odometry), *std::move(ranges), *std::move(truth),
                *std::move(beacons)};
  return make_source(run, file.path().string(), fix_known_errors);
}

Result<std::unique_ptr<Source>> open_plaza_text(const fs::path& path, bool fix_known_errors) {
  auto odometry = read_text(path.string() + std::string(kOdometrySuffix), "stamp_s,distance_m,turn_rad");
  if (!odometry) return odometry.error();
  auto ranges = read_text(path.string() + std::string(kRangeSuffix), "stamp_s,sender,beacon,range_m");
  if (!ranges) return ranges.error();
  const Run run{base_name(path), *std::move(odometry), *std::move(ranges), Eigen::MatrixXd(0, 4),
                Eigen::MatrixXd(0, 3)};
  return make_source(run, path.string(), fix_known_errors);
}

}  // namespace waymark
