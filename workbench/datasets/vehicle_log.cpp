#include "workbench/datasets/vehicle_log.hpp"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "workbench/config/known_settings.hpp"

namespace waymark {
namespace {

bool agree(const Fix& a, const Fix& b) {
  constexpr double kLongestGap_s = 1.5;
  constexpr double kFastest_mps = 15.0;
  const double gap_s = std::abs(to_seconds(b.stamp - a.stamp));
  return gap_s <= kLongestGap_s && (b.position_m - a.position_m).norm() < kFastest_mps * gap_s;
}

}  // namespace

Result<LogInfo> vehicle_info(std::string name, std::string format, std::string_view settings) {
  LogInfo info;
  info.name = std::move(name);
  info.format = std::move(format);
  info.identities = false;
  info.truth_sensor_m = kVehicleLaser_m;
  auto known = known_settings(settings);
  if (!known) return known.error();
  info.settings = *std::move(known);
  return info;
}

Result<std::vector<Stamp>> read_stamps(const MatFile& file, std::string_view variable, double unit_s) {
  constexpr double kLatest_s = 9e9;
  const auto times = file.vector(variable, "time");
  if (!times) return times.error();
  std::vector<Stamp> stamps;
  for (Eigen::Index row = 0; row < times->size(); ++row) {
    const double time_s = unit_s * (*times)(row);
    const auto error = [&](const char* what) {
      return Error{
          fmt::format("{}: variable {}: value {} {}", file.path().string(), variable, row + 1, what)};
    };
    if (std::abs(time_s) >= kLatest_s) return error("is not a time");
    stamps.push_back(stamp_from_seconds(time_s));
    if (row > 0 && stamps.back() < stamps[stamps.size() - 2]) return error("goes back in time");
  }
  return stamps;
}

Result<void> check_rows(const MatFile& file, std::string_view variable, Eigen::Index rows,
                        std::size_t expected) {
  if (std::cmp_equal(rows, expected)) return {};
  return Error{fmt::format("{}: variable {} has {} values for {} times", file.path().string(), variable, rows,
                           expected)};
}

void add_steering(const std::vector<Stamp>& stamps, const Eigen::VectorXd& v_mps,
                  const Eigen::VectorXd& steer_rad, std::vector<Event>& events) {
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    events.emplace_back(stamps[i], Steering{v_mps(row), steer_rad(row)});
  }
}

Result<std::vector<Fix>> read_fixes(const MatFile& file, std::string_view times, double unit_s,
                                    std::string_view east, std::string_view north) {
  const auto stamps = read_stamps(file, times, unit_s);
  if (!stamps) return stamps.error();
  std::vector<Fix> fixes(stamps->size());
  for (std::size_t i = 0; i < fixes.size(); ++i) fixes[i].stamp = (*stamps)[i];
  for (const auto& [axis, variable] : {std::pair{0, east}, {1, north}}) {
    const auto values_m = file.vector(variable, "m");
    if (!values_m) return values_m.error();
    if (auto same = check_rows(file, variable, values_m->size(), fixes.size()); !same) return same.error();
    for (std::size_t i = 0; i < fixes.size(); ++i)
      fixes[i].position_m[axis] = (*values_m)(static_cast<Eigen::Index>(i));
  }
  return fixes;
}

std::vector<Fix> clean_fixes(const std::vector<Fix>& fixes) {
  std::vector<Fix> clean;
  for (std::size_t i = 1; i + 1 < fixes.size(); ++i)
    if (agree(fixes[i - 1], fixes[i]) && agree(fixes[i], fixes[i + 1])) clean.push_back(fixes[i]);
  return clean;
}

void add_truth(const std::vector<Fix>& fixes, std::vector<Event>& events) {
  for (const Fix& fix : fixes)
    events.emplace_back(fix.stamp, Truth{fix.position_m.x(), fix.position_m.y(), std::nullopt});
}

}  // namespace waymark
