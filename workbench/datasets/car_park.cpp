#include "workbench/datasets/car_park.hpp"

#include <filesystem>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "workbench/datasets/reflectors.hpp"
#include "workbench/datasets/vehicle_log.hpp"
#include "workbench/logs/event_list.hpp"

namespace waymark {
namespace {

namespace fs = std::filesystem;

constexpr const char* kBeaconsFile = "beac_juan3.mat";
constexpr Eigen::Index kBeams = 361;

Result<void> read_car_steering(const MatFile& file, std::vector<Event>& events) {
  const auto stamps = read_stamps(file, "Time_VS", 1.0);
  if (!stamps) return stamps.error();
  const auto v_mps = file.vector("Velocity", "m/s");
  if (!v_mps) return v_mps.error();
  const auto steer_rad = file.vector("Steering", "rad");
  if (!steer_rad) return steer_rad.error();
  if (auto same = check_rows(file, "Velocity", v_mps->size(), stamps->size()); !same) return same;
  if (auto same = check_rows(file, "Steering", steer_rad->size(), stamps->size()); !same) return same;
  add_steering(*stamps, *v_mps, *steer_rad, events);
  return {};
}

Observations observations(const std::vector<RangeBearing>& reflectors) {
  Observations seen;
  for (const RangeBearing& reflector : reflectors) seen.push_back({std::nullopt, reflector, std::nullopt});
  return seen;
}

Result<void> read_scans(const MatFile& file, std::vector<Event>& events) {
  const auto stamps = read_stamps(file, "TimeLaser", 1.0);
  if (!stamps) return stamps.error();
  const auto ranges_m = file.matrix("Laser", kBeams, "ranges m");
  if (!ranges_m) return ranges_m.error();
  const auto intensities = file.matrix("Intensity", kBeams, "0 or intensity");
  if (!intensities) return intensities.error();
  if (auto same = check_rows(file, "Laser", ranges_m->rows(), stamps->size()); !same) return same;
  if (auto same = check_rows(file, "Intensity", intensities->rows(), stamps->size()); !same) return same;
  for (std::size_t i = 0; i < stamps->size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const auto reflectors = find_reflectors(ranges_m->row(row), intensities->row(row));
    events.emplace_back((*stamps)[i], observations(reflectors));
  }
  return {};
}

Result<void> read_beacons(const fs::path& path, LogInfo& info) {
  if (!fs::exists(path)) return {};
  const auto file = MatFile::open(path);
  if (!file) return file.error();
  const auto beacons = file->matrix("estbeac", 2, "east m, north m");
  if (!beacons) return beacons.error();
  for (Eigen::Index row = 0; row < beacons->rows(); ++row) {
    const LandmarkId id{LandmarkId::Family::kMarker, static_cast<std::int32_t>(row + 1)};
    info.landmarks.push_back({id, (*beacons)(row, 0), (*beacons)(row, 1), 0.0});
  }
  return {};
}

}  // namespace

bool is_car_park(const MatFile& file) {
  return file.has_all({"Laser", "Intensity", "TimeLaser", "Velocity", "Steering", "Time_VS"});
}

Result<std::unique_ptr<Source>> open_car_park(const MatFile& file) {
  auto info = vehicle_info("car park", "car park", "car-park");
  if (!info) return info.error();
  if (auto done = read_beacons(file.path().parent_path() / kBeaconsFile, *info); !done) return done.error();
  std::vector<Event> events;
  if (auto done = read_car_steering(file, events); !done) return done.error();
  if (auto done = read_scans(file, events); !done) return done.error();
  const auto fixes = read_fixes(file, "TimeGPS", 1.0, "GPSLon", "GPSLat");
  if (!fixes) return fixes.error();
  add_truth(*fixes, events);
  return std::unique_ptr<Source>(std::make_unique<EventList>(*std::move(info), std::move(events)));
}

}  // namespace waymark
