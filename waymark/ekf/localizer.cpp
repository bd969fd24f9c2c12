#include "waymark/ekf/localizer.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "waymark/core/gaussian.hpp"
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
constexpr int kTimesToBeSure = 2;      // that a landmark is seen, of its identity
constexpr int kContradictions = 3;     // pairs of landmarks
constexpr double kLongEnough_s = 8.0;  // of driving without a pose
constexpr std::size_t kMaxRemembered = 32;
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

bool can_be_placed(const Observation& observation) {
  const auto* z = std::get_if<RangeBearing>(&observation.value);
  return z != nullptr && observation.covariance && observation.covariance->allFinite() &&
         std::isfinite(z->range_m) && std::isfinite(z->bearing_rad) && z->range_m > kMinDistance_m;
}

/// Of the errors that outlive an observation: two that are weeks apart have none in common.
Eigen::Matrix2d bias_covariance(const SensorErrors& errors, double range_m) {
  const double range_ratio = std::hypot(errors.shared_range_sigma_ratio, errors.bias_range_sigma_ratio);
  const double bearing_deg = std::hypot(errors.shared_bearing_sigma_deg, errors.bias_bearing_sigma_deg);
  const Eigen::Vector2d sigma(range_ratio * range_m, to_radians(bearing_deg));
  return sigma.cwiseAbs2().asDiagonal();
}

/// To the robot's frame after a motion, to first order.
void move(ObservedLandmark& seen, const Motion& motion) {
  const Eigen::Matrix2d R = motion.increment.rotation().transpose();
  Eigen::Matrix<double, 2, 3> J = Eigen::Matrix<double, 2, 3>::Zero();
  seen.p_robot = motion.increment.inverse() * seen.p_robot;
  J.leftCols<2>() = -R;
  J.col(2) = -perpendicular(seen.p_robot);
  seen.covariance = (R * seen.covariance * R.transpose() + J * motion.covariance * J.transpose()).eval();
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
      errors_(sensor.errors),
      unknown_(options.unknown.has_value()),
      completed_(sensor),
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
  for (ObservedLandmark& seen : memory_) move(seen, motion);
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
  memory_.clear();
}

const Correction& Localizer::search_pose(std::span<const Observation> observations) {
  innovations_.assign(observations.size(), {});
  searching_ = {innovations_, {}};
  if (refusal_) return searching_;
  for (const Observation& observation : observations)
    if (can_be_placed(observation) && (observation.id || unknown_)) remember(observation);
  if (memory_.size() < 2) return searching_;
  const PoseCandidates found = find_pose(memory_, map_);
  if (is_enough(found)) return localize_at(found.best);
  if (is_elsewhere(found)) refusal_ = Error{reason(found)};
  return searching_;
}

/// The latest observation of a landmark stands for all of them.
void Localizer::remember(const Observation& observation) {
  const auto& z = std::get<RangeBearing>(observation.value);
  const auto place = RangeBearingModel::locate({}, T_robot_sensor_, z);
  const Eigen::Matrix2d R = *observation.covariance + bias_covariance(errors_, z.range_m);
  const ObservedLandmark seen{observation.id, place.p_world,
                              place.G_measurement * R * place.G_measurement.transpose()};
  ++observations_;
  const std::size_t at = place_of(seen);
  if (at < memory_.size()) {
    const int times = memory_[at].times + 1;
    memory_[at] = seen;
    memory_[at].times = times;
  } else if (memory_.size() < kMaxRemembered) {
    memory_.push_back(seen);
  }
}

/// Where the same landmark is remembered, if it is.
std::size_t Localizer::place_of(const ObservedLandmark& seen) const {
  const auto found = std::ranges::find_if(memory_, [&](const ObservedLandmark& before) {
    if (seen.id || before.id) return seen.id == before.id;
    const auto d2 =
        mahalanobis_squared<2>(seen.p_robot - before.p_robot, seen.covariance + before.covariance);
    return d2 && *d2 < 13.82;  // 99.9 % of chi-square with two degrees of freedom
  });
  return static_cast<std::size_t>(found - memory_.begin());
}

/// Landmarks seen that the map may have.
int Localizer::seen_of_map() const {
  return static_cast<int>(std::ranges::count_if(memory_, [this](const ObservedLandmark& seen) {
    return !seen.id || std::ranges::find(map_.ids, *seen.id) != map_.ids.end();
  }));
}

bool Localizer::is_enough(const PoseCandidates& found) const {
  const int agreeing = found.best.agreeing;
  const int candidates = seen_of_map();
  if (3 * agreeing < 2 * candidates) return false;
  const bool named =
      std::ranges::all_of(memory_, [](const ObservedLandmark& seen) { return seen.id.has_value(); });
  if (!named) return agreeing >= kMinUnknown && agreeing >= found.rival + kMinAhead;
  const bool no_more = observations_ >= kManyObservations && std::ssize(memory_) == 2;
  return agreeing >= kMinKnown || (no_more && agreeing == 2);
}

/// Where no two landmarks stand to each other as in the map and some that were seen again contradict it,
/// there is little to wait for: no misread number does that.
bool Localizer::is_elsewhere(const PoseCandidates& found) const {
  const int enough = driven_s_ < kLongEnough_s ? kContradictions : 1;
  if (found.best.agreeing < 2 && count_contradictions(memory_, map_) >= enough) return true;
  return observations_ >= kManyObservations && std::ssize(memory_) >= kMinKnown;
}

std::string Localizer::reason(const PoseCandidates& found) const {
  const int candidates = seen_of_map();
  const std::string seen = concat("of ", memory_.size(), " landmarks seen in ", observations_,
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

const Correction& Localizer::localize_at(const PoseCandidate& found) {
  located_ = true;
  ekf_.place_robot({found.T_world_robot, kAsGoodAsUnknown.cwiseAbs2().asDiagonal()});
  std::vector<Observation> agreeing;
  for (std::size_t k = 0; k < memory_.size(); ++k)
    if (found.landmarks[k] >= 0)
      agreeing.push_back(
          observe(memory_[k], map_.ids[static_cast<std::size_t>(found.landmarks[k])], T_robot_sensor_));
  memory_.clear();
  observations_ = 0;
  return ekf_.correct(agreeing);
}

}  // namespace waymark
