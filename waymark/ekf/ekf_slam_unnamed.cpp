// What EkfSlam does with sightings that have no identity.

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <Eigen/LU>

#include "waymark/core/as_index.hpp"
#include "waymark/core/gaussian.hpp"
#include "waymark/ekf/ekf_slam.hpp"
#include "waymark/models/observation_models.hpp"

namespace waymark {
namespace {

// A few landmarks per cell where they are as dense as trunks.
constexpr double kCell_m = 2.0;
// A third of the smallest region of a compressed map: so many landmarks may be considered at once.
constexpr std::size_t kMostConsidered = 48;
// Landmarks that one sighting is compared with; the likeliest stay.
constexpr std::ptrdiff_t kMostPerSighting = 6;
// Nats by which being one must be likelier than standing side by side.
constexpr double kMergeMargin = 3.0;
constexpr double kFarthestTwin_m = 10.0;
// Variance of the difference of a landmark and itself: as good as none, but S stays well conditioned.
constexpr double kSameVariance_m2 = 1e-6;

/// -2 log N(nu; 0, S) but for a constant.
double cost_of(double nis, const Eigen::Matrix2d& S) { return nis + std::log(S.determinant()); }

double range_m(const Observation& observation) { return std::get<RangeBearing>(observation.value).range_m; }

Eigen::Vector2d in_sensor(const Observation& observation) {
  const auto& z = std::get<RangeBearing>(observation.value);
  return z.range_m * Eigen::Vector2d(std::cos(z.bearing_rad), std::sin(z.bearing_rad));
}

/// The largest distance at which the densest Gaussian still beats landmarks side by side: it has a standard
/// deviation of d / sqrt(2), and a density of 1 / (pi e d^2).
double farthest_twin_m(const AssociationModel& model) {
  const double others = std::max(model.landmarks_per_m2(), 1e-9);
  return std::min(kFarthestTwin_m, 1.0 / std::sqrt(kPi * others * std::exp(1.0 + kMergeMargin)));
}

}  // namespace

EkfSlam::Unnamed::Unnamed(const UnknownAssociation& association, const GateOptions& gate,
                          const LandmarkSensor& observing)
    : model(association.options, observing),
      sensor(observing),
      jointly(association.jointly),
      joint(gate.probability, static_cast<int>(kMostConsidered), association.options.most_pairings),
      grid(kCell_m) {
  considered.reserve(kMostConsidered);
}

void EkfSlam::match_unnamed(std::span<const Observation> observations) {
  ++unnamed_->scan;
  unnamed_->candidates.clear();
  unnamed_->considered.clear();
  unnamed_->open.assign(observations.size(), 0);
  index_places();
  for (std::size_t i = 0; i < observations.size(); ++i) {
    if (innovations_[i].outcome != Outcome::kUnidentified) continue;
    unnamed_->open[i] = 1;
    find_candidates(static_cast<int>(i), observations[i]);
  }
  if (unnamed_->candidates.empty()) return;
  if (unnamed_->jointly)
    match_jointly(observations);
  else
    match_exclusively(observations);
}

void EkfSlam::index_places() {
  const Eigen::Vector2d p_sensor = (state_.pose().T_world_robot * T_robot_sensor_).position();
  unnamed_->places.clear();
  unnamed_->sigma_m = 0.0;
  for (int k = 0; k < state_.landmarks(); ++k) {
    Landmark& landmark = landmarks_[as_index(k)];
    if (is_place_due(k, p_sensor)) landmark.place_m = state_.landmark(k).head<2>();
    unnamed_->places.push_back(landmark.place_m);
    unnamed_->sigma_m = std::max(unnamed_->sigma_m, landmark.sigma_m);
  }
  unnamed_->grid.build(unnamed_->places);
}

/// Where a landmark outside of the region is takes a while to find out. Those far off are asked in turn.
bool EkfSlam::is_place_due(int landmark, const Eigen::Vector2d& p_sensor) const {
  constexpr int kTurns = 16;
  constexpr double kMargin_m = 10.0;
  if (state_.is_active(landmark) || (landmark + unnamed_->scan) % kTurns == 0) return true;
  const double far_m = (landmarks_[as_index(landmark)].place_m - p_sensor).norm();
  return far_m < unnamed_->sensor.max_range_m + kMargin_m;
}

/// From where a sighting is expected to where its gate may reach, but for what is unsure of the landmark.
double EkfSlam::reach_m(const Observation& observation) const {
  const Eigen::Matrix3d P = state_.pose().covariance;
  const Eigen::Matrix2d& R = *observation.covariance;
  const double across_m = range_m(observation);
  return std::sqrt(P(0, 0) + P(1, 1)) + across_m * std::sqrt(P(2, 2)) +
         std::sqrt(R(0, 0) + across_m * across_m * R(1, 1));
}

/// Calls visit(landmark, sighting, S, NIS) for the landmarks within the gate of a sighting. Standard
/// deviations are added up to find them: whatever the correlations are, no error is larger.
template <class Visit>
void EkfSlam::visit_candidates(const Observation& observation, const Visit& visit) const {
  const double gate = gate_.threshold(2);
  const double k_sigma = std::sqrt(gate);
  const double reach = reach_m(observation);
  const Eigen::Vector2d p_world = state_.pose().T_world_robot * T_robot_sensor_ * in_sensor(observation);
  unnamed_->grid.visit_near(p_world, k_sigma * (reach + unnamed_->sigma_m), [&](int k) {
    const double far_m = (unnamed_->places[as_index(k)] - p_world).norm();
    if (far_m > k_sigma * (reach + landmarks_[as_index(k)].sigma_m)) return;
    const auto sighting = linearize(k, observation);
    if (!sighting) return;
    const Eigen::Matrix2d S = state_.innovation_covariance(*sighting);
    const auto nis = mahalanobis_squared<2>(sighting->nu, S);
    if (nis && *nis <= gate) visit(*sighting, S, *nis);
  });
}

void EkfSlam::find_candidates(int observation_index, const Observation& observation) {
  auto& candidates = unnamed_->candidates;
  const auto first = std::ssize(candidates);
  visit_candidates(observation, [&](const ekf::Sighting& sighting, const Eigen::Matrix2d& S, double nis) {
    if (std::ranges::find(matched_, sighting.landmark) == matched_.end())
      candidates.push_back({observation_index, cost_of(nis, S), nis, S, sighting});
  });
  std::sort(candidates.begin() + first, candidates.end(),
            [](const Candidate& a, const Candidate& b) { return a.cost < b.cost; });
  if (std::ssize(candidates) > first + kMostPerSighting)
    candidates.erase(candidates.begin() + first + kMostPerSighting, candidates.end());
  const auto refused = [this](const Candidate& candidate) { return !consider(candidate.sighting.landmark); };
  candidates.erase(std::remove_if(candidates.begin() + first, candidates.end(), refused), candidates.end());
}

/// False if that would be too many landmarks.
bool EkfSlam::consider(int landmark) {
  auto& considered = unnamed_->considered;
  if (std::ranges::find(considered, landmark) != considered.end()) return true;
  if (considered.size() == kMostConsidered) return false;
  considered.push_back(landmark);
  return true;
}

/// The log-odds that the landmark is sighted, over the density of sightings of nothing known.
double EkfSlam::bonus(const Candidate& candidate, const Observation& observation) const {
  const Landmark& landmark = landmarks_[as_index(candidate.sighting.landmark)];
  const double existence = landmark.existence ? landmark.existence->probability() : 1.0;
  return unnamed_->model.log_odds_of_sighting(existence) -
         unnamed_->model.log_density_of_others(range_m(observation));
}

void EkfSlam::match_jointly(std::span<const Observation> observations) {
  const auto& candidates = unnamed_->candidates;
  unnamed_->joint.clear();
  for (const Candidate& c : candidates)
    unnamed_->joint.add({c.observation, c.sighting.landmark, c.sighting.nu, c.sighting.R,
                         bonus(c, observations[as_index(c.observation)])});
  state_.consider(unnamed_->considered);
  unnamed_->joint.solve(static_cast<int>(observations.size()), [&](int a, int b) {
    return state_.common_covariance(candidates[as_index(a)].sighting, candidates[as_index(b)].sighting);
  });
  for (int i = 0; i < static_cast<int>(observations.size()); ++i) {
    const int pair = unnamed_->joint.pair_of(i);
    if (pair != JointMatch::kNothing) take_match(candidates[as_index(pair)]);
  }
}

void EkfSlam::match_exclusively(std::span<const Observation> observations) {
  unnamed_->exclusive.clear();
  for (const Candidate& c : unnamed_->candidates)
    unnamed_->exclusive.add({c.observation, c.sighting.landmark,
                             -0.5 * c.cost - kLogTwoPi + bonus(c, observations[as_index(c.observation)])});
  unnamed_->exclusive.solve(static_cast<int>(observations.size()), state_.landmarks(), 0.0);
  for (const Candidate& c : unnamed_->candidates)
    if (unnamed_->exclusive.landmark_of(c.observation) == c.sighting.landmark) take_match(c);
}

void EkfSlam::take_match(const Candidate& candidate) {
  const int landmark = candidate.sighting.landmark;
  Landmark& matched = landmarks_[as_index(landmark)];
  Innovation& innovation = innovations_[as_index(candidate.observation)];
  unnamed_->open[as_index(candidate.observation)] = 0;
  matched_[as_index(candidate.observation)] = landmark;
  innovation.landmark = matched.id;
  compare(innovation, candidate.sighting);
  errors_.sight(state_, matched.id);
}

/// What fits no landmark now that the others have corrected the state begins one.
void EkfSlam::settle_leftovers(std::span<const Observation> observations) {
  index_places();
  for (std::size_t i = 0; i < observations.size(); ++i)
    if (unnamed_->open[i] != 0)
      innovations_[i].outcome = is_near_a_landmark(observations[i]) ? Outcome::kAmbiguous : of_no_landmark();
}

bool EkfSlam::is_near_a_landmark(const Observation& observation) const {
  bool near = false;
  visit_candidates(observation, [&](const ekf::Sighting&, const Eigen::Matrix2d&, double) { near = true; });
  return near;
}

/// Landmarks that were seen are surer, those that should have been are less so.
void EkfSlam::update_existence() {
  for (std::size_t i = 0; i < matched_.size(); ++i) {
    if (innovations_[i].outcome != Outcome::kMatched) continue;
    Landmark& seen = landmarks_[as_index(matched_[i])];
    if (seen.existence) seen.existence->see(unnamed_->model);
    seen.seen_at_way_m = way_m_;
    seen.claimed_at_scan = unnamed_->scan;
    note_sigma(matched_[i]);
  }
  const Pose2 T_world_sensor = state_.pose().T_world_robot * T_robot_sensor_;
  const Pose2 T_sensor_world = T_world_sensor.inverse();
  const Eigen::Matrix2d R = T_sensor_world.rotation();
  unnamed_->grid.visit_near(T_world_sensor.position(), unnamed_->sensor.max_range_m, [&](int k) {
    Landmark& landmark = landmarks_[as_index(k)];
    if (landmark.existence && landmark.claimed_at_scan != unnamed_->scan &&
        should_be_seen(k, R * unnamed_->places[as_index(k)] + T_sensor_world.position()))
      landmark.existence->miss(unnamed_->model);
  });
}

/// It is in view by three standard deviations of what would be measured.
bool EkfSlam::should_be_seen(int landmark, const Eigen::Vector2d& p_sensor) const {
  if (!is_in_view(unnamed_->sensor, p_sensor)) return false;
  const RangeBearing expected{p_sensor.norm(), std::atan2(p_sensor.y(), p_sensor.x())};
  const Observation observation{{}, expected, noise_covariance(unnamed_->sensor, expected)};
  const auto sighting = linearize(landmark, observation);
  if (!sighting) return false;
  const Eigen::Vector2d sigma = state_.innovation_covariance(*sighting).diagonal().cwiseSqrt();
  return is_in_view(unnamed_->sensor, p_sensor, {3.0 * sigma[0], 3.0 * sigma[1]});
}

/// At most one pair per scan: the rest of them are still there at the next.
void EkfSlam::merge_duplicates() {
  Duplicate best;
  for (int k = 0; k < state_.landmarks(); ++k)
    if (landmarks_[as_index(k)].claimed_at_scan == unnamed_->scan) find_duplicates(k, best);
  if (best.landmark >= 0) merge(best);
}

/// Compares a landmark that was seen with those beside it that were not. That they are one is likely by
/// log N(p - p'; 0, S) over the density of landmarks side by side.
void EkfSlam::find_duplicates(int landmark, Duplicate& best) {
  const double log_others = std::log(std::max(unnamed_->model.landmarks_per_m2(), 1e-9));
  unnamed_->grid.visit_near(
      unnamed_->places[as_index(landmark)], farthest_twin_m(unnamed_->model), [&](int twin) {
        const bool named = !landmarks_[as_index(landmark)].existence && !landmarks_[as_index(twin)].existence;
        if (twin == landmark || named || landmarks_[as_index(twin)].claimed_at_scan == unnamed_->scan) return;
        state_.consider(std::array{landmark, twin});
        const ekf::Sighting apart = difference(landmark, twin);
        const Eigen::Matrix2d S = state_.common_covariance(apart, apart) + apart.R;
        const auto d2 = mahalanobis_squared<2>(apart.nu, S);
        if (!d2 || *d2 > gate_.threshold(2)) return;
        const double score = -0.5 * cost_of(*d2, S) - kLogTwoPi - log_others - kMergeMargin;
        if (score > best.score) best = {score, landmark, twin};
      });
}

/// That two landmarks are one, as a sighting: seen from the robot their difference is zero. (Seen in the
/// world the same constraint would tell the filter its heading.)
ekf::Sighting EkfSlam::difference(int landmark, int twin) const {
  const Eigen::Matrix2d to_robot = rotation_matrix(-state_.linearization_pose().theta_rad);
  const Eigen::Vector2d apart =
      (state_.linearization_landmark(landmark) - state_.linearization_landmark(twin)).head<2>();
  ekf::Sighting difference;
  difference.landmark = landmark;
  difference.anchor = twin;
  difference.nu = -to_robot * (state_.landmark(landmark) - state_.landmark(twin)).head<2>();
  difference.H_landmark.leftCols<2>() = to_robot;
  difference.H_anchor.leftCols<2>() = -to_robot;
  difference.H_pose.col(2) = -to_robot * perpendicular(apart);
  difference.R = kSameVariance_m2 * Eigen::Matrix2d::Identity();
  return difference;
}

/// The one with a name stays, or the one that was seen more often.
void EkfSlam::merge(const Duplicate& duplicate) {
  const std::array same{difference(duplicate.landmark, duplicate.twin)};
  if (!state_.update(same)) return;
  const auto rank = [this](int k) {
    const Landmark& landmark = landmarks_[as_index(k)];
    return std::pair(!landmark.existence, landmark.observations);
  };
  const bool twin_stays = rank(duplicate.twin) > rank(duplicate.landmark);
  Landmark& stays = landmarks_[as_index(twin_stays ? duplicate.twin : duplicate.landmark)];
  const int goes = twin_stays ? duplicate.landmark : duplicate.twin;
  stays.observations += landmarks_[as_index(goes)].observations;
  stays.seen_at_way_m = way_m_;
  stays.claimed_at_scan = unnamed_->scan;
  ++merges_;
  remove(goes);
}

/// Landmarks that were missed too often, and those that a single sighting left behind.
void EkfSlam::forget_ghosts() {
  for (int k = state_.landmarks() - 1; k >= 0; --k) {
    const Landmark& landmark = landmarks_[as_index(k)];
    if (!landmark.existence) continue;
    const bool is_stale =
        !landmark.existence->is_confirmed() && way_m_ - landmark.seen_at_way_m > kTentativeWay_m;
    if (landmark.existence->is_ghost() || is_stale) remove(k);
  }
}

void EkfSlam::name(Innovation& added) {
  added.landmark = {LandmarkId::Family::kNone, unnamed_->next_number++};
  errors_.sight(state_, added.landmark);
}

/// So large its errors may be until it is next seen.
void EkfSlam::note_sigma(int landmark) {
  landmarks_[as_index(landmark)].sigma_m =
      std::sqrt(state_.landmark_covariance(landmark).topLeftCorner<2, 2>().trace());
}

}  // namespace waymark
