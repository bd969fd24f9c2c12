#include "waymark/ekf/localizer.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "waymark/core/text.hpp"
#include "waymark/models/observation_models.hpp"

namespace waymark {
namespace {

constexpr int kManyObservations = 20;
constexpr int kMaxDoubt = 20;
// Landmarks that must agree. Without identities two of them say nothing and a third may do so by chance.
constexpr int kMinKnown = 3;
constexpr int kMinUnknown = 5;
constexpr int kMinAhead = 2;
constexpr int kContradictions = 3;     // pairs of landmarks
constexpr double kLongEnough_s = 8.0;  // of driving without a pose
// Of the belief that the first update starts from: as good as nothing is known.
const Eigen::Vector3d kAsGoodAsUnknown(10.0, 10.0, 1.0);

/// First estimates of landmarks that stay are what they are; so no update is taken for new information of how
/// the map as a whole is turned, which the robot's observations cannot tell.
EkfOptions for_held(EkfOptions options, const MapState& map) {
  options.consistency = ekf::Consistency::kFej;
  options.capacity = options.loaded = std::max<int>(1, static_cast<int>(map.ids.size()));
  options.compressed = Compress::kNever;
  return options;
}

/// What a sensor would have measured from here.
Observation observe(const ObservedLandmark& seen, LandmarkId id, const Pose2& T_robot_sensor) {
  const auto h = RangeBearingModel::linearize({}, T_robot_sensor, seen.p_robot);
  return {id, RangeBearing{h.predicted[0], h.predicted[1]},
          Eigen::Matrix2d(h.H_landmark * seen.covariance * h.H_landmark.transpose())};
}

}  // namespace

Localizer::Localizer(MapState map, const EkfOptions& options, const LandmarkSensor& sensor, int threads)
    : map_(std::move(map)),
      T_robot_sensor_(sensor.T_robot_sensor()),
      unknown_(options.unknown.has_value()),
      completed_(sensor),
      local_map_(sensor),
      ekf_(for_held(options, map_), sensor, threads) {}

Result<std::unique_ptr<Localizer>> Localizer::make(MapState map, const EkfOptions& options,
                                                   const LandmarkSensor& sensor, int threads) {
  std::unique_ptr<Localizer> localizer(new Localizer(std::move(map), options, sensor, threads));
  if (auto loaded = localizer->ekf_.load(localizer->map_); !loaded) return loaded.error();
  localizer->ekf_.hold_landmarks();
  return localizer;
}

void Localizer::predict(const Motion& motion) {
  if (located_) return ekf_.predict(motion);
  if (!is_finite(motion)) return;
  if (!is_still(motion)) driven_s_ += motion.duration_s;
  local_map_.predict(motion);
}

const Correction& Localizer::correct(std::span<const Observation> observations) {
  if (!located_) return search_pose(completed_.of(observations));
  const Correction& correction = ekf_.correct(observations);
  judge(correction);
  return correction;
}

/// Observations that contradict the map far more often than others agree mean that the robot is elsewhere.
void Localizer::judge(const Correction& correction) {
  doubt_ = std::max(0, doubt_ + correction.count(Outcome::kGated) - correction.count(Outcome::kMatched));
  if (doubt_ < kMaxDoubt) return;
  ++losses_;
  located_ = false;
  doubt_ = observations_ = 0;
  driven_s_ = 0.0;
  local_map_.clear();
}

const Correction& Localizer::search_pose(std::span<const Observation> observations) {
  innovations_.assign(observations.size(), {});
  searching_ = {innovations_, {}};
  if (refusal_) return searching_;
  for (const Observation& observation : observations)
    if (observation.id || unknown_) remember(observation);
  if (local_map_.landmarks().size() < 2) return searching_;
  const PoseCandidates found = find_pose(local_map_.landmarks(), map_);
  if (is_enough(found)) return localize_at(found.best);
  if (is_elsewhere(found)) refusal_ = Error{reason(found)};
  return searching_;
}

void Localizer::remember(const Observation& observation) {
  if (const auto seen = local_map_.locate(observation)) {
    ++observations_;
    local_map_.observe(*seen);
  }
}

/// Landmarks seen that the map may have.
int Localizer::seen_of_map() const {
  return static_cast<int>(std::ranges::count_if(local_map_.landmarks(), [this](const ObservedLandmark& seen) {
    return !seen.id || std::ranges::find(map_.ids, *seen.id) != map_.ids.end();
  }));
}

bool Localizer::is_enough(const PoseCandidates& found) const {
  const int agreeing = found.best.agreeing;
  const int candidates = seen_of_map();
  if (3 * agreeing < 2 * candidates) return false;
  const bool named = std::ranges::all_of(local_map_.landmarks(),
                                         [](const ObservedLandmark& seen) { return seen.id.has_value(); });
  if (!named) return agreeing >= kMinUnknown && agreeing >= found.rival + kMinAhead;
  const bool no_more = observations_ >= kManyObservations && std::ssize(local_map_.landmarks()) == 2;
  return agreeing >= kMinKnown || (no_more && agreeing == 2);
}

/// Where no two landmarks stand to each other as in the map and some that were seen again contradict it,
/// there is little to wait for: no misread number does that.
bool Localizer::is_elsewhere(const PoseCandidates& found) const {
  const int enough = driven_s_ < kLongEnough_s ? kContradictions : 1;
  if (found.best.agreeing < 2 && count_contradictions(local_map_.landmarks(), map_) >= enough) return true;
  return observations_ >= kManyObservations && std::ssize(local_map_.landmarks()) >= kMinKnown;
}

std::string Localizer::reason(const PoseCandidates& found) const {
  const int candidates = seen_of_map();
  const std::string seen = concat("of ", local_map_.landmarks().size(), " landmarks seen in ", observations_,
                                  " observations and ", decimals(driven_s_, 0), " s of driving");
  if (candidates < 2)
    return concat("map: localisation failed: ", seen, " the map has ", candidates,
                  "; the map is of another place");
  if (found.best.agreeing >= kMinUnknown && found.best.agreeing < found.rival + kMinAhead)
    return concat("map: localisation is ambiguous: ", seen, " ", found.best.agreeing, " fit one pose, ",
                  found.rival, " another");
  return concat("map: localisation failed: ", seen, " no more than ", found.best.agreeing,
                " are arranged as in the map; the map is of another place");
}

FilterHealth Localizer::health() const {
  FilterHealth health = ekf_.health();
  health.recoveries += located_ ? losses_ : std::max(0, losses_ - 1);
  health.lost |= !located_;
  return health;
}

const Correction& Localizer::localize_at(const PoseCandidate& found) {
  located_ = true;
  ekf_.place_robot({found.T_world_robot, kAsGoodAsUnknown.cwiseAbs2().asDiagonal()});
  std::vector<Observation> agreeing;
  for (std::size_t k = 0; k < local_map_.landmarks().size(); ++k)
    if (found.landmarks[k] >= 0)
      agreeing.push_back(observe(local_map_.landmarks()[k],
                                 map_.ids[static_cast<std::size_t>(found.landmarks[k])], T_robot_sensor_));
  local_map_.clear();
  observations_ = 0;
  return ekf_.correct(agreeing);
}

}  // namespace waymark
