#include "workbench/sim/faults.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

#include "waymark/core/angle.hpp"
#include "waymark/core/random.hpp"

#include "workbench/sim/landmark_sensor.hpp"

namespace waymark::sim {
namespace {

// Enough to be in the map, and for its new place to be found.
constexpr int kScansInView = 10;
// Attempts to find a place for a landmark that is carried.
constexpr int kPlaces = 1000;

int scans_in_view(const SensorOptions& options, const Drive& drive, const Eigen::Vector2d& p_world,
                  Stamp from, Stamp to) {
  const Pose2 T_robot_sensor = model_of(options).T_robot_sensor();
  int count = 0;
  for (std::uint64_t i = 0; scan_stamp(options, i) <= to; ++i) {
    if (scan_stamp(options, i) < from) continue;
    const Pose2 T_sensor_world = (drive.at(scan_stamp(options, i)) * T_robot_sensor).inverse();
    if (is_visible(options, sight(T_sensor_world, p_world))) ++count;
  }
  return count;
}

/// Identities in the order in which they are first seen, each with a drawn rank.
std::vector<std::pair<double, LandmarkId>> rank_identities(const std::vector<Event>& scans,
                                                           std::uint64_t seed) {
  std::set<LandmarkId> known;
  std::vector<std::pair<double, LandmarkId>> ranks;
  RandomStream random(seed, StreamPurpose::kSimulation, 0, kFalseFirst);
  for (const Event& event : scans)
    for (const Observation& observation : std::get<Observations>(event.content))
      if (observation.id && known.insert(*observation.id).second)
        ranks.emplace_back(random.uniform(), *observation.id);
  return ranks;
}

std::set<LandmarkId> choose_false_firsts(const std::vector<Event>& scans, double share, std::uint64_t seed) {
  if (share <= 0.0) return {};
  auto ranks = rank_identities(scans, seed);
  std::ranges::sort(ranks);
  const auto count = std::max(1.0, std::round(share * static_cast<double>(ranks.size())));
  std::set<LandmarkId> chosen;
  for (std::size_t i = 0; i < ranks.size() && static_cast<double>(i) < count; ++i)
    chosen.insert(ranks[i].second);
  return chosen;
}

double false_range(double range_m, RandomStream& random) {
  return range_m * std::exp(random.uniform(std::log(0.3), std::log(3.0)));
}

double false_bearing(double bearing_rad, RandomStream& random) {
  const double off_rad = random.uniform(std::numbers::pi / 6.0, std::numbers::pi);
  return wrap_angle(bearing_rad + (random.uniform() < 0.5 ? -off_rad : off_rad));
}

/// A range times 0.3 to 3 or a bearing 30 to 180 degrees off; what has both, either.
void spoil(Measurement& value, RandomStream& random) {
  if (auto* range = std::get_if<Range>(&value)) range->range_m = false_range(range->range_m, random);
  if (auto* bearing = std::get_if<Bearing>(&value))
    bearing->bearing_rad = false_bearing(bearing->bearing_rad, random);
  if (auto* both = std::get_if<RangeBearing>(&value)) {
    if (random.uniform() < 0.5)
      both->range_m = false_range(both->range_m, random);
    else
      both->bearing_rad = false_bearing(both->bearing_rad, random);
  }
}

}  // namespace

Stamp scan_stamp(const SensorOptions& options, std::uint64_t i) {
  return stamp_from_seconds((static_cast<double>(i) + 0.5) / options.rate_hz);
}

std::optional<CarriedLandmark> carry_landmark(const FaultOptions& options, const SensorOptions& sensor,
                                              const Drive& drive, const std::vector<TrueLandmark>& landmarks,
                                              std::uint64_t seed) {
  if (options.landmark_carried_at_s <= 0.0 || landmarks.empty()) return std::nullopt;
  const Stamp at = stamp_from_seconds(options.landmark_carried_at_s);
  RandomStream random(seed, StreamPurpose::kSimulation, 0, kCarriedLandmark);
  for (int i = 0; i < kPlaces; ++i) {
    const auto index =
        std::min(landmarks.size() - 1,
                 static_cast<std::size_t>(random.uniform() * static_cast<double>(landmarks.size())));
    const double direction_rad = random.uniform(-std::numbers::pi, std::numbers::pi);
    const Eigen::Vector2d from_m(landmarks[index].x_m, landmarks[index].y_m);
    const Eigen::Vector2d to_m =
        from_m +
        options.landmark_carried_m * Eigen::Vector2d(std::cos(direction_rad), std::sin(direction_rad));
    if (scans_in_view(sensor, drive, from_m, drive.stamp(0), at) >= kScansInView &&
        scans_in_view(sensor, drive, to_m, at, drive.end()) >= kScansInView)
      return CarriedLandmark{index, at, to_m};
  }
  return std::nullopt;
}

std::vector<TrueLandmark> places_at(std::vector<TrueLandmark> landmarks,
                                    const std::optional<CarriedLandmark>& carried, Stamp when) {
  if (carried && when >= carried->at) {
    landmarks[carried->index].x_m = carried->to_m.x();
    landmarks[carried->index].y_m = carried->to_m.y();
  }
  return landmarks;
}

void make_false(std::vector<Event>& scans, const FaultOptions& options,
                const std::optional<CarriedLandmark>& carried, const std::vector<TrueLandmark>& landmarks,
                std::uint64_t seed) {
  std::set<LandmarkId> false_firsts = choose_false_firsts(scans, options.false_first_share, seed);
  for (std::size_t i = 0; i < scans.size(); ++i) {
    RandomStream random(seed, StreamPurpose::kSimulation, i, kFalse);
    std::erase_if(std::get<Observations>(scans[i].content), [&](Observation& observation) {
      const bool is_first = observation.id && false_firsts.erase(*observation.id) > 0;
      const bool is_false = random.uniform() < options.outlier_share || is_first;
      const bool is_carried =
          carried && scans[i].stamp >= carried->at && observation.id == landmarks[carried->index].id;
      if (is_false) spoil(observation.value, random);  // what is left out, too: the rest is as in the twin
      return options.omit && (is_false || is_carried);
    });
  }
}

}  // namespace waymark::sim
