#include "waymark/ekf/ekf_slam.hpp"

#include <algorithm>
#include <optional>

#include "waymark/core/gaussian.hpp"
#include "waymark/ekf/duplicates.hpp"
#include "waymark/ekf/existence_update.hpp"

namespace waymark {
namespace {

struct EkfBlock {
  enum : std::size_t { kPredict, kAssociate, kEstimate, kAdd };
};

/// What an observation must bring before anything else is asked.
Outcome admissible(const Observation& observation) {
  if (!ekf::is_usable(observation)) return Outcome::kUnusable;
  return observation.id ? Outcome::kMatched : Outcome::kUnidentified;
}

double log_density(const ekf::LinearizedObservation& linearization, double nis, const Eigen::Matrix2d& S) {
  return linearization.rows == 2 ? log_gaussian<2>(nis, S) : log_gaussian<1>(nis, S.topLeftCorner<1, 1>());
}

Eigen::Vector2d standardised(const ekf::LinearizedObservation& linearization, const Eigen::Matrix2d& S) {
  Eigen::Vector2d components = linearization.nu.cwiseQuotient(S.diagonal().cwiseSqrt());
  if (linearization.rows == 1) components[1] = 0.0;
  return components;
}

}  // namespace

EkfSlam::Unknown::Unknown(const UnknownAssociation& association, const GateOptions& gate,
                          const LandmarkSensor& observing, ekf::PointMap& map,
                          const ekf::PointObservation& observation)
    : sensor(observing),
      model(association.options, observing),
      nearby(observing.max_range_m),
      matcher(association, gate, model, map, observation) {}

EkfSlam::EkfSlam(const EkfOptions& options, const LandmarkSensor& sensor, int threads)
    : errors_(sensor.errors),
      odometry_(options.odometry, errors_.pairs()),
      map_(options, errors_.pairs() + odometry_.pairs(), threads),
      observation_(map_.state(), errors_, sensor.T_robot_sensor()),
      completed_(sensor),
      gate_(options.gate),
      faults_(sensor),
      iterated_(options.iterations, options.likelihood, options.consistency),
      deferred_(map_, observation_, options.consistency) {
  if (options.unknown) unknown_.emplace(*options.unknown, options.gate, sensor, map_, observation_);
  block_.reserve(ekf::CompressedState::kMaxObservations);
  seen_.reserve(ekf::CompressedState::kMaxObservations);
  errors_.start(map_.state());
  odometry_.start(map_.state());
}

void EkfSlam::hold_landmarks() {
  held_ = true;
  map_.state().hold_landmarks();
}

void EkfSlam::place_robot(const PoseEstimate& pose) {
  map_.state().place_robot(pose);
  faults_.forget();
}

void EkfSlam::predict(const Motion& motion) {
  BlockTimer timer(blocks_, EkfBlock::kPredict);
  if (!is_still(motion) && is_finite(motion)) {
    odometry_.predict(map_.state(), motion);
    errors_.drive(travelled_m(motion));
    map_.table().travel(travelled_m(motion));
    faults_.predict(motion);
  }
  timer.finish(EkfBlock::kPredict);
}

// Vincke Algorithm 1
const Correction& EkfSlam::correct(std::span<const Observation> given) {
  BlockTimer timer(blocks_, EkfBlock::kAssociate);
  const std::span<const Observation> observations = completed_.of(given);
  begin_scan(observations.size());
  // Match: innovation (10) and its covariance (11) against the gate.
  for (std::size_t i = 0; i < observations.size(); ++i) associate(i, observations[i]);
  isolate_faults(observations);
  if (unknown_) associate_unknown(observations);
  timer.finish(EkfBlock::kAssociate);
  // Estimate: gain, state and covariance (12).
  update(observations);
  timer.finish(EkfBlock::kEstimate);
  // Manage the map, and initialise new landmarks in the corrected state.
  if (unknown_) {
    classify_unmatched(observations);
    judge_landmarks();
  }
  for (std::size_t i = 0; i < observations.size(); ++i) {
    begin_anew_where_wrong(i);
    if (innovations_[i].outcome == Outcome::kAdded) add(i, observations[i]);
  }
  timer.finish(EkfBlock::kAdd);
  correction_ = {innovations_, map_.table().removed()};
  return correction_;
}

void EkfSlam::begin_scan(std::size_t count) {
  innovations_.assign(count, {});
  matched_.assign(count, -1);
  map_.table().begin_scan();
  map_.management().begin_scan();
  errors_.begin_scan();
  deferred_.begin_scan();
}

bool EkfSlam::already_seen(std::size_t index, LandmarkId id) const {
  return std::any_of(innovations_.begin(), innovations_.begin() + static_cast<std::ptrdiff_t>(index),
                     [id](const Innovation& earlier) {
                       return earlier.landmark == id &&
                              (earlier.outcome == Outcome::kMatched || earlier.outcome == Outcome::kAdded ||
                               earlier.outcome == Outcome::kDeferred);
                     });
}

/// Decides what becomes of one observation, all at the pose before the update.
void EkfSlam::associate(std::size_t index, const Observation& observation) {
  Innovation& innovation = innovations_[index];
  innovation.outcome = admissible(observation);
  if (unknown_ && !std::holds_alternative<RangeBearing>(observation.value))
    innovation.outcome = Outcome::kUnusable;
  if (innovation.outcome != Outcome::kMatched) return;
  innovation.landmark = *observation.id;
  if (already_seen(index, innovation.landmark)) {
    innovation.outcome = Outcome::kDuplicate;
    return;
  }
  errors_.assign(map_.state(), innovation.landmark);
  const auto landmark = map_.table().find(innovation.landmark);
  if (!landmark && faults_.is_distrusted(innovation.landmark)) {
    innovation.outcome = Outcome::kDistrusted;
    return;
  }
  if (!landmark) {
    innovation.outcome = of_no_landmark();  // added if add() finds room
    return;
  }
  matched_[index] = *landmark;
  map_.table().claim(*landmark);
  gate(innovation, linearize(index, observation));
}

/// Those without identity: each is of a landmark that is not claimed yet, or left for classify_unmatched().
void EkfSlam::associate_unknown(std::span<const Observation> observations) {
  unknown_->nearby.refresh(map_, observation_.T_world_sensor().position());
  for (const auto& match : unknown_->matcher.match(observations, innovations_, unknown_->nearby)) {
    const auto index = static_cast<std::size_t>(match.observation);
    matched_[index] = match.linearization.landmark;
    map_.table().claim(match.linearization.landmark);
    innovations_[index].landmark = map_.table()[match.linearization.landmark].id;
    gate(innovations_[index], match.linearization);
    errors_.assign(map_.state(), innovations_[index].landmark);
  }
}

std::optional<ekf::LinearizedObservation> EkfSlam::linearize(std::size_t index,
                                                             const Observation& observation) const {
  return observation_.linearize(matched_[index], innovations_[index].landmark, observation);
}

/// Gates one linearised observation, and tells the map management how useful its landmark was.
void EkfSlam::gate(Innovation& innovation, const std::optional<ekf::LinearizedObservation>& linearization) {
  const bool noted = innovation.dof != 0 && innovation.outcome == Outcome::kMatched;
  innovation.outcome = Outcome::kUnusable;
  if (!linearization) return;
  const Eigen::Matrix2d S = state().innovation_covariance(*linearization);
  const auto nis = mahalanobis_squared<2>(linearization->nu, S);
  if (!nis) return;
  if (innovation.dof == 0) {
    innovation.log_density = log_density(*linearization, *nis, S);
    innovation.standardised = standardised(*linearization, S);
  }
  innovation.dof = linearization->rows;
  innovation.nis = *nis;
  innovation.gate = gate_.threshold(linearization->rows);
  innovation.outcome = *nis > innovation.gate ? Outcome::kGated : Outcome::kMatched;
  if (noted) return;
  ekf::MapManagement& management = map_.management();
  if (innovation.outcome == Outcome::kMatched)
    management.matched(linearization->landmark,
                       {state().active().pose().covariance, state().pose_correlation(*linearization), S});
  else
    management.missed(linearization->landmark);
}

/// Moves the robot, or makes its pose less sure, and gates again all that was gated or accepted.
void EkfSlam::gate_again(const Motion& added_motion, std::span<const Observation> observations) {
  map_.state().predict(added_motion);
  for (std::size_t i = 0; i < observations.size(); ++i)
    if (innovations_[i].outcome == Outcome::kGated || innovations_[i].outcome == Outcome::kMatched)
      gate(innovations_[i], linearize(i, observations[i]));
}

/// The robot's fault is mended at once, that of landmarks when the others have corrected the state.
void EkfSlam::isolate_faults(std::span<const Observation> observations) {
  faults_.review(observations, innovations_, map_.table());
  if (!faults_.wants_relocation()) return;
  faults_.relocate([this] { return map_.save(); }, state().active().pose().T_world_robot, innovations_,
                   [&](const Motion& motion) { gate_again(motion, observations); });
}

/// A landmark that is not where the map has it is removed, and added where it is seen, unless it may be
/// anywhere.
void EkfSlam::begin_anew_where_wrong(std::size_t index) {
  if (held_ || innovations_[index].outcome != Outcome::kGated || !faults_.is_landmark_wrong(index)) return;
  const auto landmark = map_.table().find(innovations_[index].landmark);
  if (!landmark) return;
  map_.remove(*landmark);
  innovations_[index].outcome =
      faults_.is_distrusted(innovations_[index].landmark) ? Outcome::kDistrusted : Outcome::kAdded;
}

/// In blocks of at most kMaxObservations; a later block is linearised at what the earlier ones found.
void EkfSlam::update(std::span<const Observation> observations) {
  for (std::size_t next = 0; next < observations.size();) {
    block_.clear();
    seen_.clear();
    for (; next < observations.size() && block_.size() < ekf::CompressedState::kMaxObservations; ++next)
      if (innovations_[next].outcome == Outcome::kMatched) collect(next, observations[next]);
    if (block_.empty()) continue;
    const bool done =
        iterated_.apply(map_.state(), block_, [&](std::size_t k, const ekf::LinearizedObservation& before) {
          return observation_.linearize_at_proposal(before, observations[seen_[k]].value);
        });
    for (const std::size_t i : seen_) {
      if (done)
        map_.table().observe(matched_[i]);
      else
        innovations_[i].outcome = Outcome::kUnusable;
    }
  }
}

void EkfSlam::collect(std::size_t index, const Observation& observation) {
  const auto linearization = linearize(index, observation);
  if (!linearization) {
    innovations_[index].outcome = Outcome::kUnusable;
    return;
  }
  block_.push_back(*linearization);
  seen_.push_back(index);
}

/// What fits no landmark now that the others have corrected the state begins one.
void EkfSlam::classify_unmatched(std::span<const Observation> observations) {
  unknown_->nearby.refresh(map_, observation_.T_world_sensor().position());
  for (std::size_t i = 0; i < observations.size(); ++i) {
    if (innovations_[i].outcome != Outcome::kUnidentified) continue;
    const bool is_near = unknown_->matcher.is_near_a_landmark(observations[i], unknown_->nearby);
    innovations_[i].outcome = is_near ? Outcome::kAmbiguous : of_no_landmark();
  }
}

/// Tentative landmarks are confirmed or removed. At most one pair is merged per scan: the rest of them are
/// still there at the next.
void EkfSlam::judge_landmarks() {
  const ekf::NearbyLandmarks& nearby = unknown_->nearby;
  ekf::update_existence(map_, nearby, observation_, unknown_->model, unknown_->sensor);
  const auto duplicate = ekf::find_duplicate(map_, nearby, unknown_->model, gate_.threshold(2));
  if (duplicate && ekf::merge(map_, *duplicate)) ++merges_;
  ekf::remove_false_tracks(map_);
}

void EkfSlam::add(std::size_t index, const Observation& observation) {
  Innovation& innovation = innovations_[index];
  if (!std::holds_alternative<RangeBearing>(observation.value)) {
    innovation.outcome = deferred_.observe(innovation.landmark, observation);
    return;
  }
  if (!map_.make_room()) {
    innovation.outcome = Outcome::kMapFull;
    return;
  }
  LandmarkRecord record{.id = innovation.landmark};
  if (!observation.id) {
    record = {.id = map_.table().unused_id(), .identity = Identity::kUnknown, .existence = Existence{}};
    innovation.landmark = record.id;
    errors_.assign(map_.state(), record.id);
  }
  const ekf::LocatedPoint located = observation_.locate(record.id, observation);
  const int landmark = map_.append(located.p_world, located.noise, located.errors, record);
  if (unknown_) map_.note_sigma(landmark);
}

std::optional<CalibrationEstimate> EkfSlam::calibration() const {
  const CalibrationEstimate odometry = odometry_.calibration(state());
  const CalibrationEstimate sensor = errors_.calibration(state());
  const CalibrationEstimate both{odometry.mean + sensor.mean, odometry.sigmas + sensor.sigmas,
                                 odometry.prior_sigmas + sensor.prior_sigmas};
  if (both.sigmas.isZero(0.0)) return std::nullopt;
  return both;
}

}  // namespace waymark
