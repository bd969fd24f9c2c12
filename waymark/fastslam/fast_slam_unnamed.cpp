// What FastSlam does with sightings that have no identity. See fastslam/association.hpp for the scheme.

#include <algorithm>
#include <cmath>
#include <limits>

#include "waymark/core/gaussian.hpp"
#include "waymark/fastslam/fast_slam.hpp"
#include "waymark/kernels/particle_likelihood.hpp"

namespace waymark {
namespace {

using fastslam::Association;

// Particles of so little weight together do not keep a landmark.
constexpr double kLeastSupport = 0.01;

bool is_unnamed(const Observation& observation) {
  return !observation.id && std::holds_alternative<RangeBearing>(observation.value);
}

double range_m(const Observation& observation) { return std::get<RangeBearing>(observation.value).range_m; }

Eigen::Vector2d in_sensor(const Observation& observation) {
  const auto& z = std::get<RangeBearing>(observation.value);
  return z.range_m * Eigen::Vector2d(std::cos(z.bearing_rad), std::sin(z.bearing_rad));
}

int heaviest(std::span<const double> weights) {
  return static_cast<int>(std::max_element(weights.begin(), weights.end()) - weights.begin());
}

}  // namespace

bool FastSlam::any_contested() const {
  return std::ranges::any_of(contested_, [](char c) { return c != 0; });
}

/// The set decides what it can; the rest stays contested.
void FastSlam::match_unnamed(std::span<const Observation> observations) {
  bool any = false;
  for (std::size_t i = 0; i < observations.size(); ++i) {
    contested_[i] = innovations_[i].outcome == Outcome::kUnidentified && is_unnamed(observations[i]) ? 1 : 0;
    any = any || contested_[i] != 0;
  }
  if (!any) return;
  gate_sample_.load(particles_, estimate_.T_world_robot.position());
  decide(observations);
}

void FastSlam::decide(std::span<const Observation> observations) {
  const int particle = heaviest(particles_.weights());
  association_->index(store_, particle);
  association_->begin();
  const Pose2 T_world_sensor = particles_.pose(particle) * pending_.increment * sensor_.T_robot_sensor();
  for (std::size_t i = 0; i < observations.size(); ++i)
    if (contested_[i] != 0) find_candidates(observations[i], static_cast<int>(i), T_world_sensor);
  association_->solve(static_cast<int>(observations.size()), store_.size());
  take_decisions();
}

void FastSlam::find_candidates(const Observation& observation, int index, const Pose2& T_world_sensor) {
  const Eigen::Vector2d p_world = T_world_sensor * in_sensor(observation);
  association_->visit_near(p_world, candidate_radius_m(observation), [&](int k) {
    const Landmark& candidate = landmarks_[static_cast<std::size_t>(k)];
    if (candidate.claimed_at_scan == scan_) return;
    store_.touch(k);
    const fastslam::InnovationMoments moments = compare(observation, k);
    const auto nis = mahalanobis_squared<2>(moments.mean, moments.covariance());
    if (nis && *nis <= gate_.threshold(2))
      association_->consider(index, k, moments, range_m(observation), candidate.existence);
  });
}

/// From where one particle expects the sighting, as far as the gate may reach.
double FastSlam::candidate_radius_m(const Observation& observation) const {
  const Eigen::Matrix3d P = pose().covariance;
  const Eigen::Matrix2d& R = *observation.covariance;
  const double inflation = options_.noise_inflation * options_.noise_inflation;
  const double across = range_m(observation) * range_m(observation);
  const double variance = P(0, 0) + P(1, 1) + inflation * R(0, 0) + across * (P(2, 2) + inflation * R(1, 1));
  return std::sqrt(gate_.threshold(2) * variance);
}

void FastSlam::take_decisions() {
  int room = options_.capacity - store_.size() -
             static_cast<int>(std::ranges::count(innovations_, Outcome::kAdded, &Innovation::outcome));
  for (std::size_t i = 0; i < contested_.size(); ++i) {
    if (contested_[i] == 0 || association_->match().is_contested(static_cast<int>(i))) continue;
    contested_[i] = 0;
    const int landmark = association_->match().landmark_of(static_cast<int>(i));
    if (landmark != ExclusiveMatch::kNothing)
      take_match(i, landmark);
    else
      innovations_[i].outcome = room-- > 0 ? Outcome::kAdded : Outcome::kMapFull;
  }
}

/// What the set could not decide, it may be able to when clear sightings have moved it. Then each particle
/// decides.
void FastSlam::settle_contested(std::span<const Observation> observations) {
  if (!any_contested()) return;
  undecided_ = contested_;
  decide(observations);
  for (std::size_t i = 0; i < observations.size(); ++i) {
    if (undecided_[i] == 0 || contested_[i] != 0 || matched_[i] < 0) continue;
    judge(observations[i], i);
    if (innovations_[i].outcome == Outcome::kMatched) accept(observations[i], matched_[i], moments_[i]);
  }
  if (any_contested()) split(observations);
}

void FastSlam::split(std::span<const Observation> observations) {
  association_->begin_split();
  for (std::size_t i = 0; i < observations.size(); ++i)
    if (contested_[i] != 0) offer_choices(observations[i], static_cast<int>(i));
  association_->split(store_);
  accept_choices(observations);
}

void FastSlam::offer_choices(const Observation& observation, int index) {
  ++splits_;
  Association::Choice* const none = association_->offer_none(index, range_m(observation));
  if (none == nullptr) return;
  for (const ScoredPair& pair : association_->match().pairs()) {
    const Landmark& landmark = landmarks_[static_cast<std::size_t>(pair.landmark)];
    if (pair.sighting != index || landmark.claimed_at_scan == scan_) continue;
    const auto* choice = association_->offer(index, pair.landmark, range_m(observation), landmark.existence);
    if (choice != nullptr) list_likelihoods(observation, pair.landmark, choice->column);
  }
}

void FastSlam::list_likelihoods(const Observation& observation, int landmark, float* column) {
  store_.touch(landmark);
  const kernels::Sighting z = sighting(observation, landmark);
  const kernels::Increment increment = fastslam::increment_of(pending_);
  const Eigen::Vector2d origin_m = estimate_.T_world_robot.position();
  particle_blocks_.run([&](std::size_t begin, std::size_t end) {
    fastslam::BlockScratch scratch;
    const kernels::ParticleRange range{begin, end - begin};
    kernels::load_poses(particles_.world(begin), origin_m.x(), origin_m.y(), scratch.robots(), range.count);
    kernels::list_log_likelihoods(z, increment, scratch.robots(), column + begin, range);
  });
}

/// All choices of one sighting weigh with the same power, or the power and not the likelihood would choose.
double FastSlam::split_evidence(int index) const {
  double least = 1.0;
  for (const Association::Choice& choice : association_->choices())
    if (choice.sighting == index && choice.landmark != ExclusiveMatch::kNothing)
      least = std::min(least, news(choice.landmark));
  return least;
}

void FastSlam::accept_choices(std::span<const Observation> observations) {
  const bool shapes = options_.proposal == ProposalKind::kSightings;
  for (const Association::Choice& choice : association_->choices()) {
    const double power = split_evidence(choice.sighting);
    const double constant = power * Association::log_weight(choice);
    const std::span<double> log_weights = particles_.log_weights();
    for (std::size_t i = 0; i < log_weights.size(); ++i)
      log_weights[i] += choice.column[i] != 0.0F ? constant : 0.0;
    if (choice.landmark != ExclusiveMatch::kNothing) {
      const Observation& observation = observations[static_cast<std::size_t>(choice.sighting)];
      accepted_.push_back({sighting(observation, choice.landmark), power, shapes, choice.column});
    }
  }
  for (const Association::Choice& choice : association_->choices()) report_choice(choice);
}

/// The choice of the majority is what is told of the sighting, and what its landmark is marked with.
void FastSlam::report_choice(const Association::Choice& choice) {
  double weight = 0.0;
  for (std::size_t i = 0; i < particles_.weights().size(); ++i)
    weight += choice.column[i] != 0.0F ? particles_.weights()[i] : 0.0;
  Innovation& innovation = innovations_[static_cast<std::size_t>(choice.sighting)];
  if (choice.landmark == ExclusiveMatch::kNothing) {
    if (weight > 0.0 && innovation.outcome == Outcome::kUnidentified) innovation.outcome = Outcome::kAdded;
    return;
  }
  if (weight <= 0.5) return;
  innovation.outcome = Outcome::kMatched;
  innovation.landmark = landmarks_[static_cast<std::size_t>(choice.landmark)].id;
  matched_[static_cast<std::size_t>(choice.sighting)] = choice.landmark;
  count_sighting(choice.landmark);
}

/// Landmarks that were seen are surer, those that should have been are less so.
void FastSlam::update_existence() {
  find_landmarks_in_reach();
  for (const int landmark : matched_)
    if (landmark >= 0 && landmarks_[static_cast<std::size_t>(landmark)].claimed_at_scan == scan_)
      note_sighting(landmark, nullptr);
  if (any_contested()) note_choices();
  for (const int landmark : in_reach_) {
    Landmark& missed = landmarks_[static_cast<std::size_t>(landmark)];
    if (missed.claimed_at_scan != scan_) note_sighting(landmark, nobody_.data());
  }
  for (const int landmark : in_reach_) note_support(landmark);
}

/// Particles may have taken different sightings for the same landmark.
void FastSlam::note_choices() {
  const auto choices = association_->choices();
  for (std::size_t c = 0; c < choices.size(); ++c) {
    const int landmark = choices[c].landmark;
    if (landmark == ExclusiveMatch::kNothing) continue;
    Landmark& chosen = landmarks_[static_cast<std::size_t>(landmark)];
    if (chosen.claimed_at_scan == scan_) continue;
    chosen.claimed_at_scan = scan_;
    for (std::size_t other = c + 1; other < choices.size(); ++other)
      if (choices[other].landmark == landmark)
        for (int i = 0; i < particles_.count(); ++i) choices[c].column[i] += choices[other].column[i];
    note_sighting(landmark, choices[c].column);
  }
}

void FastSlam::find_landmarks_in_reach() {
  in_reach_.clear();
  const Eigen::Vector2d p_world = (estimate_.T_world_robot * sensor_.T_robot_sensor()).position();
  const double unsure_m = std::sqrt(gate_.threshold(2) * estimate_.covariance.topLeftCorner<2, 2>().trace());
  association_->visit_near(p_world, sensor_.max_range_m + unsure_m, [&](int k) {
    if (store_.existence(k) != nullptr) in_reach_.push_back(k);
  });
}

/// `takers` (all: null) saw it; the others should have if they have it in view.
void FastSlam::note_sighting(int landmark, const float* takers) {
  store_.touch(landmark);
  float* const log_odds = store_.existence(landmark);
  if (log_odds == nullptr) return;
  const Eigen::Vector2d origin_m = estimate_.T_world_robot.position();
  const auto missed = static_cast<float>(association_->model().missed());
  particle_blocks_.run([&](std::size_t begin, std::size_t end) {
    alignas(64) float before[fastslam::ParticleBlocks::kBlockSize];
    std::copy(log_odds + begin, log_odds + end, before);
    if (takers != nullptr) {
      fastslam::BlockScratch scratch;
      const kernels::ParticleRange range{begin, end - begin};
      const auto sensors = fastslam::load_sensors(particles_, mount_, origin_m, range, scratch);
      kernels::miss_landmark(store_.view(landmark, origin_m), sensors, view_, missed, log_odds, range);
    }
    for (std::size_t i = begin; i < end; ++i)
      if (takers == nullptr || takers[i] != 0.0F)
        log_odds[i] = association_->after_sighting(before[i - begin]);
  });
}

void FastSlam::note_support(int landmark) {
  Landmark& supported = landmarks_[static_cast<std::size_t>(landmark)];
  const Association::Support support = association_->support(store_.existence(landmark), particles_);
  supported.existence = support.present < kLeastSupport ? 0.0 : support.probability;
  supported.confirmed = supported.confirmed || support.confirmed > 0.5;
}

/// Landmarks that no particle believes in any more, and those that a single sighting left behind.
void FastSlam::forget_ghosts() {
  for (int k = store_.size() - 1; k >= 0; --k) {
    const Landmark& landmark = landmarks_[static_cast<std::size_t>(k)];
    const bool is_stale = !landmark.confirmed && way_since_m(k) > kTentativeWay_m;
    if (landmark.existence == 0.0 || is_stale) forget(k);
  }
}

void FastSlam::forget(int landmark) {
  Landmark& forgotten = landmarks_[static_cast<std::size_t>(landmark)];
  if (forgotten.confirmed) removed_.push_back(forgotten.id);
  store_.remove(landmark);
  forgotten = landmarks_.back();
  landmarks_.pop_back();
  const bool is_moved = landmark < store_.size();
  std::ranges::replace(unresolved_, store_.size(), landmark);
  if (is_moved && index_.find(forgotten.id)) index_.assign(forgotten.id, landmark);
}

/// A landmark that is new to some of the particles only.
void FastSlam::add_choices(std::span<const Observation> observations) {
  if (!any_contested()) return;
  for (const Association::Choice& choice : association_->choices()) {
    if (choice.landmark != ExclusiveMatch::kNothing || store_.size() >= options_.capacity) continue;
    const float* const takers = choice.column;
    if (std::none_of(takers, takers + particles_.count(), [](float t) { return t != 0.0F; })) continue;
    const auto index = static_cast<std::size_t>(choice.sighting);
    const LandmarkId id = add_unnamed(observations[index]);
    if (matched_[index] < 0) innovations_[index].landmark = id;
    float* const log_odds = store_.existence(store_.size() - 1);
    for (int i = 0; i < particles_.count(); ++i)
      if (takers[i] == 0.0F) log_odds[i] = kernels::kAbsent;
  }
}

LandmarkId FastSlam::add_unnamed(const Observation& observation) {
  const kernels::SeenLandmark z = seen(observation, std::numeric_limits<double>::infinity());
  const int landmark = store_.add(kernels::LandmarkForm::kPoint, estimate_.T_world_robot.position(), 1, true);
  place(landmark, z, {});
  std::fill_n(store_.existence(landmark), particles_.count(), 0.0F);
  const LandmarkId id{LandmarkId::Family::kNone, next_unnamed_++};
  landmarks_.push_back({.id = id,
                        .observations = 1,
                        .seen_at_way_m = way_m_,
                        .seen_at_scan = scan_,
                        .claimed_at_scan = scan_,
                        .confirmed = association_->model().confirmed() <= 0.0,
                        .existence = 0.5});
  return id;
}

}  // namespace waymark
