#include "workbench/datasets/victoria_park.hpp"

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "waymark/core/angle.hpp"

#include "workbench/datasets/vehicle_log.hpp"
#include "workbench/logs/event_list.hpp"

namespace waymark {
namespace {

namespace fs = std::filesystem;

constexpr double kMillisecond_s = 1e-3;  // of the receiver; the rest of the log counts seconds
constexpr const char* kFixesFile = "aa3_gpsx.mat";

/// The bearings of the detector count from the right.
Observation observation_of(const Eigen::VectorXd& detection) {
  return {std::nullopt, RangeBearing{detection(0), wrap_angle(detection(1) - 0.5 * kPi)}, std::nullopt};
}

/// Range m, bearing rad and diameter m of each tree, scan by scan. A scan without trees is one, too.
Result<void> read_trees(const MatFile& file, std::vector<Event>& events) {
  const auto stamps = read_stamps(file, "TLsr", 1.0);
  if (!stamps) return stamps.error();
  const auto scans = file.cells("zt", 3, "range m, bearing rad, diameter m");
  if (!scans) return scans.error();
  if (auto same = check_rows(file, "zt", std::ssize(*scans), stamps->size()); !same) return same;
  for (std::size_t i = 0; i < scans->size(); ++i) {
    Observations seen;
    for (const auto& detection : (*scans)[i].colwise()) seen.push_back(observation_of(detection));
    events.emplace_back((*stamps)[i], std::move(seen));
  }
  return {};
}

Result<void> read_truck_steering(const MatFile& file, std::vector<Event>& events) {
  const auto stamps = read_stamps(file, "time", 1.0);
  if (!stamps) return stamps.error();
  const auto u = file.transposed("u", 2, "speed m/s, steering rad");
  if (!u) return u.error();
  if (auto same = check_rows(file, "u", u->rows(), stamps->size()); !same) return same;
  add_steering(*stamps, u->col(0), u->col(1), events);
  return {};
}

/// Nothing is added where there is no file. What a reader of the truth must know.
Result<std::vector<std::string>> read_clean_fixes(const fs::path& path, std::vector<Event>& events) {
  if (!fs::exists(path))
    return std::vector<std::string>{"no ground truth: aa3_gpsx.mat is missing beside the log"};
  const auto file = MatFile::open(path);
  if (!file) return file.error();
  const auto fixes = read_fixes(*file, "timeGps", kMillisecond_s, "Lo_m", "La_m");
  if (!fixes) return fixes.error();
  const auto clean = clean_fixes(*fixes);
  add_truth(clean, events);
  return std::vector{fmt::format("{} of {} GPS positions left out of the ground truth as outliers",
                                 fixes->size() - clean.size(), fixes->size())};
}

}  // namespace

bool is_victoria_park(const MatFile& file) { return file.has_all({"zt", "TLsr", "u", "time"}); }

Result<std::unique_ptr<Source>> open_victoria_park(const MatFile& file) {
  auto info = vehicle_info("Victoria Park", "Victoria Park", "victoria-park");
  if (!info) return info.error();
  std::vector<Event> events;
  if (auto done = read_truck_steering(file, events); !done) return done.error();
  if (auto done = read_trees(file, events); !done) return done.error();
  auto notes = read_clean_fixes(file.path().parent_path() / kFixesFile, events);
  if (!notes) return notes.error();
  return std::unique_ptr<Source>(
      std::make_unique<EventList>(*std::move(info), std::move(events), *std::move(notes)));
}

}  // namespace waymark
