#include "waymark/ekf/ekf_slam.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "waymark/core/gaussian.hpp"
#include "waymark/core/text.hpp"
#include "waymark/ekf/negligible_change.hpp"
#include "waymark/models/observation_models.hpp"

namespace waymark {
namespace {

struct EkfBlock {
  enum : std::size_t { kPredict, kAssociate, kEstimate, kAdd };
};

constexpr double kStudentDof = 4.0;
constexpr int kStudentIterations = 3;

bool is_range(double range_m) { return std::isfinite(range_m) && range_m > kMinDistance_m; }

bool is_usable(const Measurement& value) {
  if (const auto* both = std::get_if<RangeBearing>(&value))
    return is_range(both->range_m) && std::isfinite(both->bearing_rad);
  if (const auto* range = std::get_if<Range>(&value)) return is_range(range->range_m);
  const auto* bearing = std::get_if<Bearing>(&value);
  return bearing != nullptr && std::isfinite(bearing->bearing_rad);
}

/// What an observation must bring before anything else is asked: its kind, an identity, finite numbers.
Outcome admissible(const Observation& observation) {
  const bool usable = observation.covariance.has_value() && observation.covariance->allFinite() &&
                      is_usable(observation.value);
  if (!usable) return Outcome::kUnusable;
  return observation.id ? Outcome::kMatched : Outcome::kUnidentified;
}

/// The noise of a sighting; the second row of one-dimensional ones is there for nothing.
Eigen::Matrix2d noise_of(const Observation& observation) {
  Eigen::Matrix2d R = *observation.covariance;
  if (!std::holds_alternative<RangeBearing>(observation.value)) R(0, 1) = R(1, 0) = 0.0, R(1, 1) = 1.0;
  return R;
}

double log_density(const ekf::Sighting& sighting, double nis, const Eigen::Matrix2d& S) {
  return sighting.rows == 2 ? log_gaussian<2>(nis, S) : log_gaussian<1>(nis, S.topLeftCorner<1, 1>());
}

/// z - h at one point, Jacobians at another.
template <ObservationModel Model>
ekf::Sighting sight_as(const typename Model::Value& z, const Linearization<Model::kDim>& expected,
                       const Linearization<Model::kDim>& jacobians) {
  ekf::Sighting sighting;
  sighting.rows = Model::kDim;
  sighting.nu.head<Model::kDim>() = Model::innovation(z, expected.predicted);  // Vincke (10)
  sighting.H_pose.topRows<Model::kDim>() = jacobians.H_pose;
  sighting.H_landmark.topLeftCorner<Model::kDim, 2>() = jacobians.H_landmark;
  return sighting;
}

}  // namespace

ekf::Compression compression(const EkfOptions& options) {
  if (options.odometry.estimate) return {options.region, options.capacity};
  switch (options.compressed) {
    case Compress::kAlways:
      return {options.region, std::max(options.region, options.loaded)};
    case Compress::kNever:
      return {options.region, options.capacity};
    case Compress::kAuto:
      break;
  }
  return {options.region, std::max(6 * options.region, options.loaded)};
}

EkfSlam::EkfSlam(const EkfOptions& options, const LandmarkSensor& sensor, int threads)
    : errors_(sensor.errors),
      odometry_(options.odometry, errors_.pairs()),
      state_(2, options.capacity, options.consistency, compression(options), threads,
             errors_.pairs() + odometry_.pairs()),
      completed_(sensor),
      options_(options),
      gate_(options.gate),
      T_robot_sensor_(sensor.T_robot_sensor()),
      index_(static_cast<std::size_t>(options.capacity)),
      management_(options.evict, options.capacity) {
  if (options.unknown) unnamed_.emplace(*options.unknown, options.gate, sensor);
  landmarks_.reserve(static_cast<std::size_t>(options.capacity));
  removed_.reserve(static_cast<std::size_t>(options.capacity));
  sightings_.reserve(ekf::CompressedState::kMaxSightings);
  noises_.reserve(ekf::CompressedState::kMaxSightings);
  refined_.reserve(ekf::CompressedState::kMaxSightings);
  seen_.reserve(ekf::CompressedState::kMaxSightings);
  errors_.start(state_);
  odometry_.start(state_);
}

Result<void> EkfSlam::load(const MapState& map) {
  if (auto fits = check_fits(map, 2, options_.capacity); !fits) return fits;
  if (!landmarks_.empty()) return Error{"map: a filter takes one only before anything else"};
  if (std::ssize(map.ids) > state_.most_loaded())
    return Error{concat("map: ", map.ids.size(), " landmarks, but EkfOptions::loaded is ", options_.loaded)};
  state_.load(mean_of(map), map.covariance);
  for (std::size_t i = 0; i < map.ids.size(); ++i) {
    const auto landmark = static_cast<int>(i);
    landmarks_.push_back({.id = map.ids[i],
                          .observations = map.observations[i],
                          .place_m = state_.landmark(landmark).head<2>()});
    index_.assign(map.ids[i], landmark);
    management_.added();
    if (!unnamed_) continue;
    note_sigma(landmark);
    if (map.ids[i].family == LandmarkId::Family::kNone)
      unnamed_->next_number = std::max(unnamed_->next_number, map.ids[i].number + 1);
  }
  return {};
}

void EkfSlam::hold_landmarks() {
  held_ = true;
  state_.hold_landmarks();
}

void EkfSlam::predict(const Motion& motion) {
  BlockTimer timer(blocks_, EkfBlock::kPredict);
  if (!is_still(motion) && is_finite(motion)) {
    odometry_.predict(state_, motion);
    errors_.drive(way_m(motion));
    way_m_ += way_m(motion);
  }
  timer.finish(EkfBlock::kPredict);
}

const Correction& EkfSlam::correct(std::span<const Observation> given) {
  BlockTimer timer(blocks_, EkfBlock::kAssociate);
  const std::span<const Observation> observations = completed_.of(given);
  prepare(observations.size());
  for (std::size_t i = 0; i < observations.size(); ++i) associate(i, observations[i]);
  if (recovery_.is_lost(innovations_))
    recovery_.recover(innovations_, [&](const Motion& slip) { gate_again(slip, observations); });
  if (unnamed_) match_unnamed(observations);
  timer.finish(EkfBlock::kAssociate);
  update(observations);
  timer.finish(EkfBlock::kEstimate);
  if (unnamed_) {
    settle_leftovers(observations);
    update_existence();
    merge_duplicates();
    forget_ghosts();
  }
  for (std::size_t i = 0; i < observations.size(); ++i)
    if (innovations_[i].outcome == Outcome::kAdded) add(i, observations[i]);
  timer.finish(EkfBlock::kAdd);
  correction_ = {innovations_, removed_};
  return correction_;
}

void EkfSlam::prepare(std::size_t count) {
  innovations_.assign(count, {});
  matched_.assign(count, -1);
  removed_.clear();
  management_.begin_scan();
  errors_.begin_scan();
  viewpoint_of_scan_ = -1;
}

bool EkfSlam::already_seen(std::size_t index, LandmarkId id) const {
  return std::any_of(innovations_.begin(), innovations_.begin() + static_cast<std::ptrdiff_t>(index),
                     [id](const Innovation& earlier) {
                       return earlier.landmark == id &&
                              (earlier.outcome == Outcome::kMatched || earlier.outcome == Outcome::kAdded ||
                               earlier.outcome == Outcome::kPending);
                     });
}

/// Decides what becomes of one observation, all at the pose before the update.
void EkfSlam::associate(std::size_t index, const Observation& observation) {
  Innovation& innovation = innovations_[index];
  innovation.outcome = admissible(observation);
  if (unnamed_ && !std::holds_alternative<RangeBearing>(observation.value))
    innovation.outcome = Outcome::kUnusable;
  if (innovation.outcome != Outcome::kMatched) return;
  innovation.landmark = *observation.id;
  if (already_seen(index, innovation.landmark)) {
    innovation.outcome = Outcome::kDuplicate;
    return;
  }
  errors_.sight(state_, innovation.landmark);
  const auto landmark = index_.find(innovation.landmark);
  if (!landmark) {
    innovation.outcome = of_no_landmark();  // added if add() finds room
    return;
  }
  matched_[index] = *landmark;
  compare(innovation, linearize(*landmark, observation));
}

/// Gates one linearised sighting, and tells the map management how useful its landmark was.
void EkfSlam::compare(Innovation& innovation, const std::optional<ekf::Sighting>& sighting) {
  innovation.outcome = Outcome::kUnusable;
  if (!sighting) return;
  const Eigen::Matrix2d S = state_.innovation_covariance(*sighting);
  const auto nis = mahalanobis_squared<2>(sighting->nu, S);
  if (!nis) return;
  if (innovation.dof == 0) innovation.log_density = log_density(*sighting, *nis, S);
  innovation.dof = sighting->rows;
  innovation.nis = *nis;
  innovation.gate = gate_.threshold(sighting->rows);
  innovation.outcome = *nis > innovation.gate ? Outcome::kGated : Outcome::kMatched;
  if (!management_.evicts()) return;
  if (innovation.outcome == Outcome::kMatched)
    management_.matched(sighting->landmark,
                        {state_.pose().covariance, state_.pose_correlation(*sighting), S, sighting->H_pose});
  else
    management_.missed(sighting->landmark);
}

/// Makes the pose less sure by a slip, and gates again what was refused.
void EkfSlam::gate_again(const Motion& slip, std::span<const Observation> observations) {
  state_.predict(slip);
  for (std::size_t i = 0; i < observations.size(); ++i)
    if (innovations_[i].outcome == Outcome::kGated)
      compare(innovations_[i], linearize(matched_[i], observations[i]));
}

/// Innovation at the present estimate, Jacobians where the consistency mode wants them.
std::optional<ekf::Sighting> EkfSlam::linearize(int landmark, const Observation& observation) const {
  const View here{state_.pose().T_world_robot, state_.landmark(landmark)};
  const View at{state_.linearization_pose(), state_.linearization_landmark(landmark)};
  auto sighting = sight(observation.value, here, at, T_robot_sensor_);
  if (!sighting) return std::nullopt;
  const double range_m = (here.p_world.head<2>() - here.T_world_robot.position()).norm();
  const ekf::SightingError error =
      error_of(landmarks_[static_cast<std::size_t>(landmark)].id, range_m, observation.value);
  sighting->landmark = landmark;
  sighting->errors = error.terms;
  sighting->nu -= state_.expected(error.terms);
  sighting->R = noise_of(observation) + error.unmodelled;
  return sighting;
}

/// What lasting errors do to the part that was measured: its rows first.
ekf::SightingError EkfSlam::error_of(LandmarkId id, double range_m, const Measurement& value) const {
  ekf::SightingError error = errors_.of(id, range_m);
  if (std::holds_alternative<RangeBearing>(value)) return error;
  const int row = std::holds_alternative<Bearing>(value) ? 1 : 0;
  for (ekf::ErrorTerm& term : error.terms) {
    term.J.row(0) = term.J.row(row).eval();
    term.J.row(1).setZero();
  }
  error.unmodelled = Eigen::Vector2d(error.unmodelled(row, row), 0.0).asDiagonal().toDenseMatrix().eval();
  return error;
}

/// The same where the update would go.
std::optional<ekf::Sighting> EkfSlam::linearize_at_proposal(const ekf::Sighting& before,
                                                            const Observation& observation) const {
  const View there{state_.proposed_pose(), state_.proposed_landmark(before.landmark)};
  auto sighting = sight(observation.value, there, there, T_robot_sensor_);
  if (!sighting) return std::nullopt;
  sighting->landmark = before.landmark;
  sighting->errors = before.errors;
  sighting->nu -= state_.proposed_expected(before.errors);
  sighting->R = before.R;
  return sighting;
}

/// z - h and the Jacobians of h; nothing where a landmark is believed to be at the sensor itself.
std::optional<ekf::Sighting> EkfSlam::sight(const Measurement& value, const View& here, const View& at,
                                            const Pose2& T_robot_sensor) {
  const auto distance_m = [&](const View& view) {
    return (view.p_world.head<2>() - view.T_world_robot * T_robot_sensor.position()).norm();
  };
  // Only with first estimates are they different points.
  const bool is_same = here.T_world_robot == at.T_world_robot && here.p_world == at.p_world;
  if (!(distance_m(here) > kMinDistance_m)) return std::nullopt;
  if (!is_same && !(distance_m(at) > kMinDistance_m)) return std::nullopt;
  const auto as = [&]<class Model>(Model, const typename Model::Value& z) {
    const auto expected = Model::linearize(here.T_world_robot, T_robot_sensor, here.p_world.head<2>());
    if (is_same) return sight_as<Model>(z, expected, expected);
    return sight_as<Model>(z, expected,
                           Model::linearize(at.T_world_robot, T_robot_sensor, at.p_world.head<2>()));
  };
  if (const auto* range = std::get_if<Range>(&value)) return as(RangeModel{}, *range);
  if (const auto* bearing = std::get_if<Bearing>(&value)) return as(BearingModel{}, *bearing);
  return as(RangeBearingModel{}, std::get<RangeBearing>(value));
}

/// In blocks of at most kMaxSightings; a later block is linearised at what the earlier ones found.
void EkfSlam::update(std::span<const Observation> observations) {
  for (std::size_t next = 0; next < observations.size();) {
    sightings_.clear();
    noises_.clear();
    seen_.clear();
    for (; next < observations.size() && sightings_.size() < ekf::CompressedState::kMaxSightings; ++next)
      if (innovations_[next].outcome == Outcome::kMatched) collect(next, observations[next]);
    const bool done = !sightings_.empty() && state_.propose(sightings_) && refine(observations);
    if (done) state_.accept();
    for (const std::size_t i : seen_) {
      if (done)
        ++landmarks_[static_cast<std::size_t>(matched_[i])].observations;
      else
        innovations_[i].outcome = Outcome::kUnusable;
    }
  }
}

void EkfSlam::collect(std::size_t index, const Observation& observation) {
  const auto sighting = linearize(matched_[index], observation);
  if (!sighting) {
    innovations_[index].outcome = Outcome::kUnusable;
    return;
  }
  sightings_.push_back(*sighting);
  noises_.push_back(sighting->R);
  seen_.push_back(index);
}

/// Linearises the block anew at what is proposed until that no longer matters: the iterated filter (Bell and
/// Cathey 1993), and with heavy tails its reweighted form. First estimates stay what they are. False if an
/// innovation covariance is not positive definite.
bool EkfSlam::refine(std::span<const Observation> observations) {
  if (options_.consistency == ekf::Consistency::kFej) return true;
  const bool reweights = options_.likelihood == ekf::Likelihood::kStudent;
  const int most = reweights ? std::max(options_.iterations, kStudentIterations) : options_.iterations;
  for (int i = 0; i < most && relinearize(observations); ++i)
    if (!state_.propose(sightings_)) return false;
  return true;
}

/// False, and nothing changed, if the proposal is as good as linear, or leads to where nothing can be seen.
bool EkfSlam::relinearize(std::span<const Observation> observations) {
  refined_.clear();
  double change = 0.0;
  for (std::size_t k = 0; k < seen_.size(); ++k) {
    const ekf::Sighting& before = sightings_[k];
    auto there = linearize_at_proposal(before, observations[seen_[k]]);
    if (!there) return false;
    const Eigen::Vector2d bent = there->nu - (before.nu - state_.explained(before));
    const double weight = heaviness(*there, noises_[k]);
    there->R = weight * noises_[k];
    change = std::max({change, bent.dot(noises_[k].llt().solve(bent)),
                       std::abs(std::log(there->R(0, 0) / before.R(0, 0)))});
    refined_.push_back(*there);
  }
  if (change < ekf::kNegligibleChange) return false;
  for (std::size_t k = 0; k < seen_.size(); ++k) sightings_[k] = state_.moved_back(refined_[k]);
  return true;
}

/// By how much a Student-t likelihood widens the noise R of a sighting of which this residual is left (Lange,
/// Little, Taylor 1989).
double EkfSlam::heaviness(const ekf::Sighting& left, const Eigen::Matrix2d& R) const {
  if (options_.likelihood == ekf::Likelihood::kGaussian) return 1.0;
  return (kStudentDof + left.nu.dot(R.llt().solve(left.nu))) / (kStudentDof + left.rows);
}

/// Whether there is room for one more landmark, if need be by removing one.
bool EkfSlam::make_room() {
  if (state_.landmarks() < state_.capacity()) return true;
  const auto least_useful = management_.evicts() ? management_.least_useful() : std::nullopt;
  if (least_useful) remove(*least_useful);
  return least_useful.has_value();
}

void EkfSlam::remove(int landmark) {
  const Landmark gone = landmarks_[static_cast<std::size_t>(landmark)];
  const Landmark& last = landmarks_.back();
  state_.remove(landmark);
  management_.removed(landmark);
  if (last.is_viewpoint) renumber_viewpoint(static_cast<int>(std::ssize(landmarks_)) - 1, landmark);
  if (has_name(last)) index_.assign(last.id, landmark);
  landmarks_[static_cast<std::size_t>(landmark)] = last;
  landmarks_.pop_back();
  if (has_name(gone)) index_.erase(gone.id);
  if (is_in_map(gone)) removed_.push_back(gone.id);
}

/// A point that was seen from the robot: it turns with it.
int EkfSlam::append(const Eigen::Vector2d& p_world, const Eigen::Matrix2d& noise,
                    const ekf::ErrorTerms& errors, const Landmark& landmark) {
  Eigen::Matrix3d G_pose = Eigen::Matrix3d::Zero();
  G_pose.topLeftCorner<2, 2>().setIdentity();
  G_pose.block<2, 1>(0, 2) = perpendicular(p_world - state_.linearization_pose().position());
  Eigen::Matrix3d added = Eigen::Matrix3d::Zero();
  added.topLeftCorner<2, 2>() = noise;
  management_.added(landmark.is_viewpoint);
  landmarks_.push_back(landmark);
  landmarks_.back().seen_at_way_m = way_m_;
  return state_.add({p_world.x(), p_world.y(), 0.0}, G_pose, added, errors);
}

void EkfSlam::add(std::size_t index, const Observation& observation) {
  if (!std::holds_alternative<RangeBearing>(observation.value)) {
    defer(index, observation);
    return;
  }
  if (!make_room()) {
    innovations_[index].outcome = Outcome::kMapFull;
    return;
  }
  if (!observation.id) name(innovations_[index]);
  const LandmarkId id = innovations_[index].landmark;
  const auto& z = std::get<RangeBearing>(observation.value);
  ekf::SightingError error = errors_.of(id, z.range_m);
  const Eigen::Vector2d expected_error = state_.expected(error.terms);
  const auto inverse = RangeBearingModel::locate(
      state_.pose().T_world_robot, T_robot_sensor_,
      {z.range_m - expected_error[0], wrap_angle(z.bearing_rad - expected_error[1])});
  const Eigen::Matrix2d& G = inverse.G_measurement;
  for (ekf::ErrorTerm& term : error.terms) term.J.topRows<2>() = (-G * term.J.topRows<2>()).eval();
  const int landmark =
      append(inverse.p_world, G * (*observation.covariance + error.unmodelled) * G.transpose(), error.terms,
             {.id = id, .observations = 1, .place_m = inverse.p_world});
  if (observation.id)
    index_.assign(id, landmark);
  else
    landmarks_.back().existence.emplace();
  if (unnamed_) note_sigma(landmark);
}

std::optional<CalibrationEstimate> EkfSlam::calibration() const {
  const CalibrationEstimate odometry = odometry_.calibration(state_);
  const CalibrationEstimate sensor = errors_.calibration(state_);
  const CalibrationEstimate both{odometry.mean + sensor.mean, odometry.sigmas + sensor.sigmas,
                                 odometry.prior_sigmas + sensor.prior_sigmas};
  if (both.sigmas.isZero(0.0)) return std::nullopt;
  return both;
}

Snapshot EkfSlam::snapshot() const {
  Snapshot snapshot{{}, state_.pose(), {}};
  for (int i = 0; i < state_.landmarks(); ++i) {
    const Landmark& landmark = landmarks_[static_cast<std::size_t>(i)];
    if (!is_in_map(landmark)) continue;
    snapshot.landmarks.push_back(
        {landmark.id, state_.landmark(i), state_.landmark_covariance(i), landmark.observations});
  }
  return snapshot;
}

MapState EkfSlam::save() const {
  MapState map;
  map.landmark_dimension = state_.dimension();
  map.T_world_robot = state_.pose().T_world_robot;
  std::vector<Eigen::Index> rows{0, 1, 2};
  for (std::size_t i = 0; i < landmarks_.size(); ++i) {
    const Landmark& landmark = landmarks_[i];
    if (!is_in_map(landmark)) continue;
    map.ids.push_back(landmark.id);
    map.observations.push_back(landmark.observations);
    const auto first = static_cast<Eigen::Index>(3 + 2 * i);
    rows.insert(rows.end(), {first, first + 1});
  }
  map.landmarks = Eigen::VectorXd(state_.mean()(rows)).tail(static_cast<Eigen::Index>(rows.size()) - 3);
  map.covariance = state_.covariance()(rows, rows);
  return map;
}

}  // namespace waymark
