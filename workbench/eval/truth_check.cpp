#include "workbench/eval/truth_check.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <utility>

#include "workbench/eval/align.hpp"
#include "workbench/eval/map_error.hpp"
#include "workbench/eval/median.hpp"

namespace waymark::eval {
namespace {

using Map = std::span<const LandmarkEstimate>;
using Survey = std::span<const TrueLandmark>;

constexpr std::size_t kMinObservations = 5;
constexpr std::size_t kMinCommon = 4;
/// Below this a single landmark is not worth a word; an exchange is, from a smaller error on.
constexpr double kMinOffM = 0.25;
constexpr double kMinExchangeM = 0.1;
constexpr double kOddSigmas = 5.0;
/// What remains of a squared error that an exchange explains, at most.
constexpr double kExchangedShare = 0.25;
/// Least drop of the squared errors of an exchanged pair, in variances: a likelihood ratio of exp(25 / 2).
/// Two landmarks support one another, so a pair is found where neither alone would be odd.
constexpr double kExchangeEvidence = 25.0;

struct Coordinates {
  std::vector<double> x_m;
  std::vector<double> y_m;
};

/// Where two maps that share ids have each landmark.
struct Common {
  std::vector<LandmarkId> ids;
  std::vector<Eigen::Vector2d> seen;
  std::vector<Eigen::Vector2d> surveyed;
};

Common common_landmarks(Map map, Survey survey) {
  Common common;
  for (const auto [i, j] : match_by_number(map, survey)) {
    common.ids.push_back(survey[j].id);
    common.seen.emplace_back(map[i].position_m.head<2>());
    common.surveyed.emplace_back(survey[j].x_m, survey[j].y_m);
  }
  return common;
}

/// Standard deviation per axis of the landmarks that agree: those within three robust standard deviations.
double agreeing_sigma_m(const std::vector<double>& off_m) {
  const double limit_m = 3.0 * robust_sigma(off_m);
  double sum = 0.0;
  int count = 0;
  for (const double off : off_m) {
    if (off > limit_m) continue;
    sum += off * off;
    ++count;
  }
  return std::sqrt(sum / (2 * count - 3));  // three parameters of the frame were fitted; half of four agree
}

double squared_distance(const Common& common, std::size_t seen, std::size_t surveyed) {
  return (common.seen[seen] - common.surveyed[surveyed]).squaredNorm();
}

/// Which landmark's place each one is seen in, where that is another's.
using Places = std::vector<std::optional<std::size_t>>;

/// How far each landmark is seen from the place that is meant to be its own.
std::vector<double> distances_m(const Common& common, const Places& places) {
  std::vector<double> distances;
  for (std::size_t i = 0; i < places.size(); ++i) {
    distances.push_back(std::sqrt(squared_distance(common, i, places[i].value_or(i))));
  }
  return distances;
}

/// What an exchange of two landmarks must explain, and how far either may then still be from its new place.
struct ExchangeLimits {
  double min_gain_m2 = kMinExchangeM * kMinExchangeM;
  double farthest_m = std::numeric_limits<double>::infinity();
};

/// By how much the squared errors of i and j shrink when their places are exchanged; 0 when too much error
/// stays.
double exchange_gain(const Common& common, std::size_t i, std::size_t j, double farthest_m) {
  const double i_there = squared_distance(common, i, j);
  const double j_there = squared_distance(common, j, i);
  const double apart = squared_distance(common, i, i) + squared_distance(common, j, j);
  if (std::max(i_there, j_there) > farthest_m * farthest_m) return 0.0;
  return i_there + j_there < kExchangedShare * apart ? apart - i_there - j_there : 0.0;
}

/// The partner of `i` whose exchange explains most.
std::optional<std::size_t> best_partner(const Common& common, std::size_t i, const ExchangeLimits& limits) {
  std::optional<std::size_t> best;
  double best_gain = limits.min_gain_m2;
  for (std::size_t j = 0; j < common.ids.size(); ++j) {
    const double gain = j == i ? 0.0 : exchange_gain(common, i, j, limits.farthest_m);
    if (gain <= best_gain) continue;
    best_gain = gain;
    best = j;
  }
  return best;
}

/// Exchanges of two landmarks that prefer each other.
Places find_exchanges(const Common& common, const ExchangeLimits& limits) {
  Places partner(common.ids.size());
  for (std::size_t i = 0; i < partner.size(); ++i) partner[i] = best_partner(common, i, limits);
  Places places(common.ids.size());
  for (std::size_t i = 0; i < partner.size(); ++i) {
    if (partner[i] && partner[*partner[i]] == i) places[i] = partner[i];
  }
  return places;
}

/// The other landmark nearest to where `i` is seen, if that is much nearer than its own place.
std::optional<std::size_t> place_of(const Common& common, std::size_t i) {
  std::optional<std::size_t> nearest;
  double nearest_squared = kExchangedShare * squared_distance(common, i, i);
  for (std::size_t j = 0; j < common.ids.size(); ++j) {
    if (j == i || squared_distance(common, i, j) >= nearest_squared) continue;
    nearest_squared = squared_distance(common, i, j);
    nearest = j;
  }
  return nearest;
}

std::vector<MapOddity> find_oddities(const Common& common) {
  if (common.ids.size() < kMinCommon) return {};
  const double sigma_m = agreeing_sigma_m(distances_m(common, find_exchanges(common, {})));
  const double min_off_m = std::max(kMinOffM, kOddSigmas * sigma_m);
  const double evidence_m2 = kExchangeEvidence * sigma_m * sigma_m;
  Places places = find_exchanges(common, {std::max(kMinExchangeM * kMinExchangeM, evidence_m2), min_off_m});
  std::vector<MapOddity> oddities;
  for (std::size_t i = 0; i < places.size(); ++i) {
    MapOddity oddity{.id = common.ids[i], .off_m = std::sqrt(squared_distance(common, i, i))};
    if (!places[i]) {
      if (oddity.off_m <= min_off_m) continue;
      places[i] = place_of(common, i);
    }
    if (places[i]) {
      oddity.seen_at = common.ids[*places[i]];
      oddity.off_there_m = std::sqrt(squared_distance(common, i, *places[i]));
    }
    oddities.push_back(oddity);
  }
  return oddities;
}

const MapOddity* partner(std::span<const MapOddity> oddities, const MapOddity& oddity) {
  const auto is_partner = [&](const MapOddity& other) {
    return oddity.seen_at == other.id && other.seen_at == oddity.id;
  };
  const auto found = std::ranges::find_if(oddities, is_partner);
  return found == oddities.end() ? nullptr : &*found;
}

std::string metres(double value_m) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.2f m", value_m);
  return text.data();
}

std::string describe_one(const MapOddity& oddity) {
  const std::string off =
      "landmark " + to_string(oddity.id) + " is seen " + metres(oddity.off_m) + " from its place";
  return oddity.seen_at ? off + ", where landmark " + to_string(*oddity.seen_at) + " should be" : off;
}

std::string describe_exchange(const MapOddity& a, const MapOddity& b) {
  return "landmarks " + to_string(a.id) + " and " + to_string(b.id) + " may be exchanged: they are seen " +
         metres(a.off_m) + " and " + metres(b.off_m) + " from their own places, and " +
         metres(a.off_there_m) + " and " + metres(b.off_there_m) + " from each other's";
}

}  // namespace

std::vector<LandmarkEstimate> place_observations(std::span<const PositionObservation> landmark_observations,
                                                 const TruthTrack& truth,
                                                 const Eigen::Vector2d& truth_sensor_m) {
  std::map<LandmarkId, Coordinates> places;
  for (const PositionObservation& observation : landmark_observations) {
    const auto at = truth.at(observation.stamp);
    const auto T_world_sensor = at ? pose_of(*at) : std::nullopt;
    if (!T_world_sensor) continue;
    const Eigen::Vector2d p = *T_world_sensor * Eigen::Vector2d(observation.p_robot_m - truth_sensor_m);
    places[observation.id].x_m.push_back(p.x());
    places[observation.id].y_m.push_back(p.y());
  }
  std::vector<LandmarkEstimate> map;
  for (auto& [id, place] : places) {
    if (place.x_m.size() < kMinObservations) continue;
    const int count = static_cast<int>(place.x_m.size());
    LandmarkEstimate landmark{.id = id, .observations = count};
    landmark.position_m = {*median(std::move(place.x_m)), *median(std::move(place.y_m)), 0.0};
    map.push_back(landmark);
  }
  return map;
}

std::vector<MapOddity> find_oddities(Map map, Survey survey, const Pose2& T_survey_map) {
  Common common = common_landmarks(map, survey);
  for (Eigen::Vector2d& p : common.seen) p = T_survey_map * p;
  return find_oddities(common);
}

std::vector<MapOddity> compare_maps(Map map, Survey survey) {
  const Common common = common_landmarks(map, survey);
  const auto T_survey_map = align_rigid_robust(common.seen, common.surveyed);
  return T_survey_map ? find_oddities(map, survey, *T_survey_map) : std::vector<MapOddity>{};
}

std::vector<std::string> describe(std::span<const MapOddity> oddities) {
  std::vector<std::string> sentences;
  for (const MapOddity& oddity : oddities) {
    const MapOddity* other = partner(oddities, oddity);
    if (other == nullptr) {
      sentences.push_back(describe_one(oddity));
    } else if (&oddity < other) {
      sentences.push_back(describe_exchange(oddity, *other));
    }
  }
  return sentences;
}

std::vector<TrueLandmark> with_exchanges(Survey survey, std::span<const MapOddity> oddities) {
  std::map<LandmarkId, LandmarkId> renamed;
  for (const MapOddity& oddity : oddities) {
    if (partner(oddities, oddity) != nullptr) renamed[oddity.id] = *oddity.seen_at;
  }
  std::vector<TrueLandmark> mended(survey.begin(), survey.end());
  for (TrueLandmark& landmark : mended) {
    if (const auto found = renamed.find(landmark.id); found != renamed.end()) landmark.id = found->second;
  }
  return mended;
}

}  // namespace waymark::eval
