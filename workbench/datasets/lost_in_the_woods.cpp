#include "workbench/datasets/lost_in_the_woods.hpp"

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "workbench/config/known_settings.hpp"
#include "workbench/logs/event_list.hpp"

namespace waymark {
namespace {

constexpr Eigen::Index kTubes = 17;

/// The columns of the file that make events, row by row at the same times.
struct Columns {
  Eigen::MatrixXd t, v, om;                             ///< s, m/s, rad/s
  Eigen::MatrixXd x_true, y_true, th_true, true_valid;  ///< m, m, rad, 0 or 1
  Eigen::MatrixXd r, b;                                 ///< m and rad, a column per tube; 0: not seen
};

struct Wanted {
  const char* variable;
  Eigen::MatrixXd Columns::*member;
  Eigen::Index columns;
  const char* meaning;
};

Result<Columns> read_columns(const MatFile& file) {
  const std::vector<Wanted> all{{"t", &Columns::t, 1, "time s"},
                                {"v", &Columns::v, 1, "speed m/s"},
                                {"om", &Columns::om, 1, "turn rate rad/s"},
                                {"x_true", &Columns::x_true, 1, "true x m"},
                                {"y_true", &Columns::y_true, 1, "true y m"},
                                {"th_true", &Columns::th_true, 1, "true heading rad"},
                                {"true_valid", &Columns::true_valid, 1, "truth is valid"},
                                {"r", &Columns::r, kTubes, "ranges m"},
                                {"b", &Columns::b, kTubes, "bearings rad"}};
  Columns columns;
  for (const auto& [variable, member, count, meaning] : all) {
    auto values = file.matrix(variable, count, meaning);
    if (!values) return values.error();
    if (variable != all.front().variable && values->rows() != columns.t.rows())
      return Error{fmt::format("{}: variable {} has {} rows, t has {}", file.path().string(), variable,
                               values->rows(), columns.t.rows())};
    columns.*member = *std::move(values);
  }
  return columns;
}

Result<void> check(const Columns& c, const std::string& where) {
  constexpr double kLatest_s = 9e9;
  for (Eigen::Index row = 0; row < c.t.rows(); ++row) {
    if (std::abs(c.t(row, 0)) >= kLatest_s)
      return Error{fmt::format("{}: variable t: row {} is not a time in seconds", where, row + 1)};
    if (row > 0 && c.t(row, 0) < c.t(row - 1, 0))
      return Error{fmt::format("{}: variable t: row {} goes back in time", where, row + 1)};
    if (c.r.row(row).minCoeff() < 0.0)
      return Error{fmt::format("{}: variable r: row {}: a range cannot be negative", where, row + 1)};
  }
  return {};
}

LandmarkId tube(Eigen::Index column) {
  return {LandmarkId::Family::kMarker, static_cast<std::int32_t>(column + 1)};
}

Observations observations(const Columns& c, Eigen::Index row) {
  Observations seen;
  for (Eigen::Index column = 0; column < kTubes; ++column)
    if (c.r(row, column) != 0.0)
      seen.push_back({tube(column), RangeBearing{c.r(row, column), c.b(row, column)}, std::nullopt});
  return seen;
}

std::vector<Event> events_of(const Columns& c) {
  std::vector<Event> events;
  for (Eigen::Index row = 0; row < c.t.rows(); ++row) {
    const Stamp stamp = stamp_from_seconds(c.t(row, 0));
    events.emplace_back(stamp, Velocity{c.v(row, 0), c.om(row, 0)});
    if (c.true_valid(row, 0) != 0.0)
      events.emplace_back(stamp, Truth{c.x_true(row, 0), c.y_true(row, 0), c.th_true(row, 0)});
    if (auto seen = observations(c, row); !seen.empty()) events.emplace_back(stamp, std::move(seen));
  }
  return events;
}

Result<LogInfo> read_info(const MatFile& file) {
  LogInfo info;
  info.name = file.path().stem().string();
  info.format = "lost-in-the-woods";
  auto settings = known_settings("lost-in-the-woods");
  if (!settings) return settings.error();
  info.settings = *std::move(settings);
  const auto ahead_m = file.matrix("d", 1, "distance of the laser ahead of the robot m");
  if (!ahead_m) return ahead_m.error();
  if (ahead_m->rows() != 1) return Error{file.path().string() + ": variable d must be a single number"};
  info.settings.emplace_back("sensor.x_m", fmt::format("{}", (*ahead_m)(0, 0)));
  const auto places = file.matrix("l", 2, "x m, y m of the landmarks");
  if (!places) return places.error();
  for (Eigen::Index row = 0; row < places->rows(); ++row)
    info.landmarks.push_back({tube(row), (*places)(row, 0), (*places)(row, 1), 0.0});
  return info;
}

}  // namespace

bool is_lost_in_the_woods(const MatFile& file) { return file.has_all({"om", "r", "b", "l", "x_true"}); }

Result<std::unique_ptr<Source>> open_lost_in_the_woods(const MatFile& file) {
  auto info = read_info(file);
  if (!info) return info.error();
  const auto columns = read_columns(file);
  if (!columns) return columns.error();
  if (auto checked = check(*columns, file.path().string()); !checked) return checked.error();
  return std::unique_ptr<Source>(std::make_unique<EventList>(*std::move(info), events_of(*columns)));
}

}  // namespace waymark
