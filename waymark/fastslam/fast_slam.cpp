#include "waymark/fastslam/fast_slam.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/LU>

#include "waymark/core/gaussian.hpp"
#include "waymark/models/observation_models.hpp"

namespace waymark {
namespace {

using kernels::LandmarkForm;
using kernels::SeenLandmark;
using kernels::SightingKind;

enum Block : std::size_t { kAssociate, kCompare, kUpdate, kEstimate, kResample, kAdd };

// Particles draw from the collected motion at the latest when its heading is this unsure: a Gaussian (x, y,
// theta) is then still a good picture of it, the sagitta 1 - cos(3 sigma) being 0.4 % of the distance.
constexpr double kMaxPendingHeadingSigma_rad = 0.5;

// A misread identity is an odd one out. So many gated sightings without an accepted one between them mean
// that the particles are lost, and a lost set that gates would stay lost.
constexpr int kMostGatedInARow = 5;
constexpr int kMostDoublings = 8;
const Eigen::Vector3d kSmallestSlip(0.02, 0.02, 0.02);

// What a float can tell: a sensor is not believed to be sharper than that, as a part of its range and in rad.
constexpr double kSharpestSigma = 1e-6;

// Sightings nearer to each other than this are as good as one.
constexpr double kLeastWay_m = 1e-3;

// A sighting that brings less news than this is not asked whether it should move particles.
constexpr double kLeastNews = 0.1;
// So many particles FastSlamOptions::move_above is for; more can afford to lose more.
constexpr double kParticlesOfMoveAbove = 100.0;

// A landmark that leaves the view does so by an edge, not by the limits of range, if it is so many standard
// deviations off those; and it must not cross a wide angle between two scans.
constexpr double kLimitMargin = 3.0;
constexpr double kMostEdgeTurn_rad = 0.2;
constexpr double kMissedByChance = 1e-3;
constexpr double kMostMissed = 0.25;

// Whether a landmark may become a point is asked at every so many sightings of it.
constexpr int kSightingsPerRefinement = 4;

/// The numbers of a measurement; what was not measured is 0.
struct Measured {
  SightingKind kind = SightingKind::kRangeBearing;
  double range_m = 0.0;
  double bearing_rad = 0.0;
};

std::optional<Measured> measured(const Measurement& value) {
  if (const auto* z = std::get_if<RangeBearing>(&value))
    return Measured{SightingKind::kRangeBearing, z->range_m, z->bearing_rad};
  if (const auto* z = std::get_if<Range>(&value)) return Measured{SightingKind::kRange, z->range_m, 0.0};
  if (const auto* z = std::get_if<Bearing>(&value))
    return Measured{SightingKind::kBearing, 0.0, z->bearing_rad};
  return std::nullopt;
}

/// 0 unless the range is all that was measured.
double range_alone_m(const Observation& observation) {
  const auto* z = std::get_if<Range>(&observation.value);
  return z != nullptr ? z->range_m : 0.0;
}

/// In so many scans a landmark in view is seen at least once, but for one time in a thousand; 0 where that
/// would take too many, or there are no edges.
std::size_t scans_to_tell_an_edge(const LandmarkSensor& sensor) {
  const double missed = 1.0 - sensor.detection_probability;
  if (missed > kMostMissed || sensor.field_of_view_deg >= 360.0) return 0;
  return static_cast<std::size_t>(std::ceil(std::log(kMissedByChance) / std::log(missed)));
}

int dimension(SightingKind kind) { return kind == SightingKind::kRangeBearing ? 2 : 1; }

bool is_positive_definite(const Eigen::Matrix2d& R, SightingKind kind) {
  if (!R.allFinite() || !(R(0, 0) > 0.0)) return false;
  return dimension(kind) == 1 || R.determinant() > 0.0;
}

/// What an observation must bring before anything else is asked: its kind, numbers that are finite as floats,
/// noise.
bool is_usable(const Observation& observation) {
  const auto z = measured(observation.value);
  if (!z || !observation.covariance) return false;
  const bool has_range = z->kind != SightingKind::kBearing;
  return std::isfinite(static_cast<float>(z->range_m)) && std::isfinite(z->bearing_rad) &&
         (!has_range || z->range_m > kMinDistance_m) &&
         is_positive_definite(*observation.covariance, z->kind);
}

/// The belief's spread as a motion from its mean.
Motion spread_of(const PoseEstimate& pose) {
  Motion spread;
  const Eigen::Matrix3d G = compose_jacobian_right(pose.T_world_robot);
  spread.covariance = G.transpose() * pose.covariance * G;
  return spread;
}

kernels::SensorMount mount_of(const LandmarkSensor& sensor) {
  const double yaw_rad = to_radians(sensor.yaw_deg);
  return {static_cast<float>(sensor.x_m),
          static_cast<float>(sensor.y_m),
          static_cast<float>(std::cos(yaw_rad)),
          static_cast<float>(std::sin(yaw_rad)),
          static_cast<float>(0.5 * to_radians(sensor.field_of_view_deg)),
          static_cast<float>(1.0 / std::max(sensor.max_range_m, kMinDistance_m)),
          static_cast<float>(sensor.min_range_m)};
}

kernels::View view_of(const LandmarkSensor& sensor, const kernels::SensorMount& mount) {
  const Eigen::Matrix2d R = noise_covariance(sensor, RangeBearing{sensor.max_range_m, 0.0});
  return {mount, static_cast<float>(sensor.min_range_m), static_cast<float>(sensor.max_range_m),
          static_cast<float>(R(0, 0)), static_cast<float>(R(1, 1))};
}

}  // namespace

FastSlam::FastSlam(const FastSlamOptions& options, const LandmarkSensor& sensor, int threads)
    : completed_(sensor),
      options_(options),
      gate_(options.gate),
      sensor_(sensor),
      mount_(mount_of(sensor)),
      seed_(options.seed),
      particle_blocks_(options.particles, threads),
      particles_(options.particles, options.initial.T_world_robot),
      calibration_(sensor, options.seed, particle_blocks_),
      store_(particle_blocks_),
      gate_sample_(options.particles),
      move_(particle_blocks_),
      history_(sensor),
      edge_scans_(scans_to_tell_an_edge(sensor)),
      resampling_(particle_blocks_),
      bins_(options.kld_error > 0.0 ? static_cast<std::size_t>(options.particles) : 1),
      index_(static_cast<std::size_t>(options.capacity)),
      nobody_(particle_blocks_.capacity()),
      estimate_(options.initial) {
  if (options.unknown) {
    association_.emplace(AssociationModel(*options.unknown, sensor), particle_blocks_);
    view_ = view_of(sensor, mount_);
  }
  if (!options.initial.covariance.isZero(0.0))
    fastslam::step(particles_, spread_of(options.initial), options.initial.T_world_robot.position(), {},
                   {seed_, StreamPurpose::kInitialisation, 0}, particle_blocks_);
}

void FastSlam::predict(const Motion& motion) {
  if (is_still(motion) || !is_finite(motion)) return;
  pending_ = compose(pending_, motion);
  way_m_ += way_m(motion);
  moved_ = true;
  history_.move(motion.increment);
  if (pending_.covariance(2, 2) < kMaxPendingHeadingSigma_rad * kMaxPendingHeadingSigma_rad) return;
  BlockTimer timer(table_, kUpdate);
  accepted_.clear();
  move_particles();
  estimate_ = fastslam::estimate(particles_, particle_blocks_);
  timer.finish(kUpdate);
}

/// The particles make the motion that they owe, and take in the accepted sightings.
void FastSlam::move_particles() {
  const Eigen::Vector2d origin_m = estimate_.T_world_robot.position();
  estimate_ = pose();
  fastslam::step(particles_, pending_, origin_m, accepted_, {seed_, StreamPurpose::kMotion, step_++},
                 particle_blocks_);
  pending_ = {};
}

const Correction& FastSlam::correct(std::span<const Observation> given) {
  BlockTimer timer(table_, kAssociate);
  const std::span<const Observation> observations = completed_.of(given);
  history_.scan();
  ++scan_;
  associate(observations);
  correction_ = {innovations_, {}};
  timer.finish(kAssociate);
  if (!any(Outcome::kMatched) && !any(Outcome::kAdded) && !any_contested()) return correction_;

  compare(observations);
  timer.finish(kCompare);
  move_particles();
  if (any(Outcome::kMatched)) weigh();
  timer.finish(kUpdate);
  if (any(Outcome::kMatched)) estimate_ = fastslam::estimate(particles_, particle_blocks_);
  timer.finish(kEstimate);
  miss();
  refine();
  if (association_) {
    update_existence();
    forget_ghosts();
    add_choices(observations);
  }
  resample();
  timer.finish(kResample);
  add(observations);
  timer.finish(kAdd);
  correction_ = {innovations_, removed_};
  moved_ = false;
  return correction_;
}

bool FastSlam::any(Outcome outcome) const {
  return std::ranges::any_of(innovations_, [outcome](const Innovation& i) { return i.outcome == outcome; });
}

void FastSlam::associate(std::span<const Observation> observations) {
  innovations_.assign(observations.size(), {});
  moments_.assign(observations.size(), {});
  matched_.assign(observations.size(), -1);
  contested_.assign(observations.size(), 0);
  removed_.clear();
  int room = options_.capacity - store_.size();
  for (std::size_t i = 0; i < observations.size(); ++i) {
    Innovation& innovation = innovations_[i];
    if (observations[i].id) innovation.landmark = *observations[i].id;
    innovation.outcome = screen(i, observations[i]);
    if (innovation.outcome == Outcome::kAdded && room-- <= 0) innovation.outcome = Outcome::kMapFull;
    if (innovation.outcome == Outcome::kMatched) take_match(i, *index_.find(innovation.landmark));
  }
  if (association_) match_unnamed(observations);
}

void FastSlam::take_match(std::size_t index, int landmark) {
  Landmark& matched = landmarks_[static_cast<std::size_t>(landmark)];
  matched_[index] = landmark;
  matched.claimed_before = std::exchange(matched.claimed_at_scan, scan_);
  innovations_[index].landmark = matched.id;
  innovations_[index].outcome = Outcome::kMatched;
}

/// What is to be done with an observation as far as its identity goes.
Outcome FastSlam::screen(std::size_t index, const Observation& observation) const {
  if (!is_usable(observation)) return Outcome::kUnusable;
  if (!observation.id) return Outcome::kUnidentified;
  const auto seen_before = [&](const Innovation& earlier) {
    return earlier.landmark == *observation.id &&
           (earlier.outcome == Outcome::kMatched || earlier.outcome == Outcome::kAdded);
  };
  const auto end = innovations_.begin() + static_cast<std::ptrdiff_t>(index);
  if (std::any_of(innovations_.begin(), end, seen_before)) return Outcome::kDuplicate;
  const auto landmark = index_.find(*observation.id);
  if (!landmark) return Outcome::kAdded;
  const bool fits = fastslam::can_take(store_.form(*landmark), measured(observation.value)->kind);
  return fits ? Outcome::kMatched : Outcome::kUnusable;
}

/// What a sighting tells after that way since the last one of the same landmark. The particles have no states
/// for errors that outlive a sighting. Errors that fall to exp(-w / lasting_way) after a way w leave a run of
/// sightings a way w apart with as much news, each, as one of variance 1 / tanh(w / (2 lasting_way)) would
/// bring that errs anew every time: they count as such.
SeenLandmark FastSlam::seen(const Observation& observation, double way_since_m) const {
  const Measured z = *measured(observation.value);
  const SensorErrors& e = sensor_.errors;
  const double repeated = 1.0 / std::tanh(std::max(way_since_m, kLeastWay_m) / (2.0 * e.lasting_way_m));
  const auto variance = [&](int i, double shared, double lasting, double sharpest) {
    const double inflation = options_.noise_inflation * options_.noise_inflation;
    const double R =
        inflation * (*observation.covariance)(i, i) + shared * shared + repeated * lasting * lasting;
    return static_cast<float>(std::max(R, sharpest * sharpest));
  };
  const double direction_rad = z.bearing_rad + to_radians(sensor_.yaw_deg);
  SeenLandmark seen{z.kind, static_cast<float>(z.range_m), static_cast<float>(std::cos(direction_rad)),
                    static_cast<float>(std::sin(direction_rad))};
  if (z.kind != SightingKind::kBearing)
    seen.R_rr =
        variance(0, 0.0, e.lasting_range_sigma_ratio * z.range_m, kSharpestSigma * std::max(1.0, z.range_m));
  seen.range_errors = calibration_.columns();
  if (z.kind != SightingKind::kRange)
    seen.R_bb = variance(z.kind == SightingKind::kBearing ? 0 : 1, to_radians(e.shared_bearing_sigma_deg),
                         to_radians(e.lasting_bearing_sigma_deg), kSharpestSigma);
  if (z.kind == SightingKind::kRangeBearing)
    seen.R_rb = static_cast<float>(options_.noise_inflation * options_.noise_inflation *
                                   (*observation.covariance)(0, 1));
  return seen;
}

/// Finds the sightings of known landmarks that the set as a whole expected: a gate on each particle would let
/// those starve that the odometry happened to lead astray. Each is judged by itself, before any of them moves
/// or weighs a particle, so their order does not matter.
void FastSlam::compare(std::span<const Observation> observations) {
  gate_sample_.load(particles_, estimate_.T_world_robot.position());
  for (std::size_t i = 0; i < observations.size(); ++i)
    if (innovations_[i].outcome == Outcome::kMatched) judge(observations[i], i);
  if (is_lost()) widen(observations);
  accepted_.clear();
  find_edges(observations);
  const std::int64_t moves = moves_;
  for (std::size_t i = 0; i < observations.size(); ++i) {
    if (innovations_[i].outcome != Outcome::kMatched) continue;
    // What was compared before another sighting moved the particles is compared again.
    if (moves_ != moves) moments_[i] = compare(observations[i], matched_[i]);
    accept(observations[i], matched_[i], moments_[i]);
  }
  for (const EdgeSighting& edge : edges_) accept(edge);
  if (association_) settle_contested(observations);
}

fastslam::InnovationMoments FastSlam::compare(const Observation& observation, int landmark) {
  return gate_sample_.compare(sighting(observation, landmark), fastslam::increment_of(pending_));
}

kernels::Sighting FastSlam::sighting(const Observation& observation, int landmark) const {
  return {seen(observation, way_since_m(landmark)), mount_,
          store_.view(landmark, estimate_.T_world_robot.position())};
}

/// NIS of the mixture: mean and covariance of the innovation over all particles.
void FastSlam::judge(const Observation& observation, std::size_t index) {
  const int landmark = matched_[index];
  store_.touch(landmark);
  moments_[index] = compare(observation, landmark);
  const Eigen::Vector2d& nu = moments_[index].mean;
  const Eigen::Matrix2d S = moments_[index].covariance();
  const int dof = dimension(measured(observation.value)->kind);
  const auto nis = dof == 2 ? mahalanobis_squared<2>(nu, S)
                            : mahalanobis_squared<1>(nu.head<1>(), S.topLeftCorner<1, 1>());
  Innovation& innovation = innovations_[index];
  if (nis && innovation.dof == 0)
    innovation.log_density =
        dof == 2 ? log_gaussian<2>(*nis, S) : log_gaussian<1>(*nis, S.topLeftCorner<1, 1>());
  innovation.dof = nis ? dof : 0;
  innovation.nis = nis.value_or(0.0);
  innovation.gate = gate_.threshold(dof);
  innovation.outcome = !nis                     ? Outcome::kUnusable
                       : *nis > innovation.gate ? Outcome::kGated
                                                : Outcome::kMatched;
}

bool FastSlam::is_lost() {
  for (const Innovation& innovation : innovations_) {
    if (innovation.outcome == Outcome::kMatched) gated_in_a_row_ = 0;
    if (innovation.outcome == Outcome::kGated) ++gated_in_a_row_;
  }
  return gated_in_a_row_ >= kMostGatedInARow && mostly_gated();
}

bool FastSlam::mostly_gated() const {
  const auto count = [this](Outcome outcome) {
    return std::ranges::count(innovations_, outcome, &Innovation::outcome);
  };
  return count(Outcome::kGated) > count(Outcome::kMatched);
}

/// The robot slipped as its odometry says it never does: the motion that is still to be drawn is made less
/// sure, step by step, until most of what is seen can be believed.
void FastSlam::widen(std::span<const Observation> observations) {
  ++slips_;
  gated_in_a_row_ = 0;
  moved_ = true;
  Motion slip;
  slip.covariance = kSmallestSlip.cwiseAbs2().asDiagonal();
  for (int doublings = 0; doublings < kMostDoublings && mostly_gated(); ++doublings) {
    pending_ = compose(pending_, slip);
    slip.covariance *= 4.0;
    for (std::size_t i = 0; i < observations.size(); ++i)
      if (innovations_[i].outcome == Outcome::kGated) judge(observations[i], i);
  }
}

void FastSlam::accept(const Observation& observation, int landmark,
                      const fastslam::InnovationMoments& moments) {
  accept(sighting(observation, landmark), landmark, news(landmark), moments);
  count_sighting(landmark);
  landmarks_[static_cast<std::size_t>(landmark)].range_m = range_alone_m(observation);
}

void FastSlam::accept(const kernels::Sighting& sighting, int landmark, double news,
                      const fastslam::InnovationMoments& moments) {
  const bool may_move = store_.modes(landmark) == 1 && way_since_m(landmark) > kLeastWay_m;
  const bool is_taken = may_move && move_by(sighting, news, moments);
  const bool shapes = options_.proposal == ProposalKind::kSightings;
  accepted_.push_back({sighting, is_taken ? 0.0 : news, shapes});
}

/// A sighting of a landmark that comes back, where particles disagree on what they see, moves them; then it
/// does not weigh them. From a robot that has stood since the last sighting none does.
bool FastSlam::move_by(const kernels::Sighting& sighting, double news, fastslam::InnovationMoments moments) {
  if (news < kLeastNews) return false;
  const double spread_above = options_.move_above * particles_.count() / kParticlesOfMoveAbove;
  const kernels::Increment increment = fastslam::increment_of(pending_);
  const Eigen::Vector2d origin_m = estimate_.T_world_robot.position();
  const SightingKind kind = sighting.seen.kind;
  const std::int64_t moves = moves_;
  for (int k = 0; k < dimension(kind); ++k) {
    if (!(news * moments.spread(k, k) > spread_above * moments.noise(k, k))) continue;
    const bool bearing = kind != SightingKind::kRange && (k == 1 || kind != SightingKind::kRangeBearing);
    move_.take_in(sighting, bearing, moments.covariance()(k, k), news, increment, origin_m, particles_,
                  calibration_, store_);
    ++moves_;
    gate_sample_.load(particles_, origin_m);
    moments = gate_sample_.compare(sighting, increment);
  }
  return moves_ != moves;
}

/// A landmark that was seen by its range alone and now is not, or now is and was not, at a range well within
/// the sensor's limits: it crossed an edge of the field of view. Whether it was missed by chance instead
/// shows in as many scans as it takes.
void FastSlam::find_edges(std::span<const Observation> observations) {
  edges_.clear();
  if (edge_scans_ == 0 || history_.earlier() <= edge_scans_) return;
  const auto patience = static_cast<std::int64_t>(edge_scans_);
  for (std::size_t k = 0; k < landmarks_.size(); ++k)
    if (landmarks_[k].range_m > 0.0 && scan_ - landmarks_[k].claimed_at_scan == patience)
      add_edge(static_cast<int>(k), landmarks_[k].range_m, edge_scans_);
  for (std::size_t i = 0; i < observations.size(); ++i) {
    if (innovations_[i].outcome != Outcome::kMatched) continue;
    const Measured z = *measured(observations[i].value);
    const int landmark = matched_[i];
    if (z.kind == SightingKind::kRange &&
        scan_ - landmarks_[static_cast<std::size_t>(landmark)].claimed_before > patience)
      add_edge(landmark, z.range_m, 1);
  }
}

/// It crossed the edge between the scans `age` and `age` - 1 scans ago.
void FastSlam::add_edge(int landmark, double range_m, std::size_t age) {
  const Pose2 T_now_before = history_.T_now_at(age);
  const Pose2 change = T_now_before.inverse() * history_.T_now_at(age - 1);
  const double margin_m = kLimitMargin * sensor_.range_sigma_m + change.position().norm();
  if (range_m < sensor_.min_range_m + margin_m || range_m > sensor_.max_range_m - margin_m) return;
  const double turned_rad = std::abs(change.theta_rad) + change.position().norm() / range_m;
  if (turned_rad > kMostEdgeTurn_rad) return;
  const Pose2 half{0.5 * change.x_m, 0.5 * change.y_m, 0.5 * change.theta_rad};
  EdgeSighting edge{landmark, {}, mount_};
  edge.seen.kind = SightingKind::kViewEdge;
  const double sigma_rad = std::hypot(to_radians(sensor_.bearing_sigma_deg), turned_rad / std::sqrt(12.0));
  edge.seen.R_bb = static_cast<float>(sigma_rad * sigma_rad);
  const Pose2 T_now_sensor = T_now_before * half * sensor_.T_robot_sensor();
  edge.mount.x = static_cast<float>(T_now_sensor.x_m);
  edge.mount.y = static_cast<float>(T_now_sensor.y_m);
  edge.mount.cos_yaw = static_cast<float>(std::cos(T_now_sensor.theta_rad));
  edge.mount.sin_yaw = static_cast<float>(std::sin(T_now_sensor.theta_rad));
  edges_.push_back(edge);
}

void FastSlam::accept(const EdgeSighting& edge) {
  store_.touch(edge.landmark);
  const kernels::Sighting sighting{edge.seen, edge.mount,
                                   store_.view(edge.landmark, estimate_.T_world_robot.position())};
  gate_sample_.load(particles_, estimate_.T_world_robot.position());
  const auto moments = gate_sample_.compare(sighting, fastslam::increment_of(pending_));
  const double nis = moments.mean[0] * moments.mean[0] / moments.covariance()(0, 0);
  if (nis <= gate_.threshold(1)) accept(sighting, edge.landmark, 1.0, moments);
}

/// 1 for a landmark that comes back after a long way, next to nothing for one that has just been seen.
double FastSlam::news(int landmark) const {
  return options_.evidence_way_m > 0.0 ? -std::expm1(-way_since_m(landmark) / options_.evidence_way_m) : 1.0;
}

double FastSlam::way_since_m(int landmark) const {
  return way_m_ - landmarks_[static_cast<std::size_t>(landmark)].seen_at_way_m;
}

void FastSlam::count_sighting(int landmark) {
  Landmark& sighted = landmarks_[static_cast<std::size_t>(landmark)];
  ++sighted.observations;
  sighted.seen_at_way_m = way_m_;
  sighted.seen_at_scan = scan_;
}

void FastSlam::weigh() {
  if (fastslam::normalise_weights(particles_, particle_blocks_)) {
    fastslam::temper_weights(particles_, options_.temper_below * particles_.count(), particle_blocks_);
    return;
  }
  for (Innovation& innovation : innovations_)
    if (innovation.outcome == Outcome::kMatched) innovation.outcome = Outcome::kUnusable;
}

/// Landmarks of several hypotheses that were expected and are not seen lose those that were.
void FastSlam::miss() {
  if (!(sensor_.detection_probability > 0.0)) return;
  for (const int k : unresolved_)
    if (store_.modes(k) > 1 && landmarks_[static_cast<std::size_t>(k)].claimed_at_scan != scan_) miss(k);
}

void FastSlam::miss(int landmark) {
  store_.touch(landmark);
  const Eigen::Vector2d origin_m = estimate_.T_world_robot.position();
  const kernels::Sighting sighting{{}, mount_, store_.view(landmark, origin_m)};
  particle_blocks_.run([&](std::size_t begin, std::size_t end) {
    fastslam::BlockScratch scratch;
    const kernels::ParticleRange range{begin, end - begin};
    kernels::miss_modes(sighting, sensor_.detection_probability,
                        fastslam::load_sensors(particles_, mount_, origin_m, range, scratch), range);
  });
}

/// Landmarks may have become simpler.
void FastSlam::refine() {
  for (const int k : unresolved_) {
    const Landmark& landmark = landmarks_[static_cast<std::size_t>(k)];
    if (store_.modes(k) > 1) {
      store_.touch(k);
      fastslam::tidy_modes(store_, k, particles_, particle_blocks_);
    }
    if (landmark.seen_at_scan == scan_ && landmark.observations % kSightingsPerRefinement == 0)
      fastslam::become_point_if_linear(store_, k, particles_, mount_, particle_blocks_);
  }
  std::erase_if(unresolved_, [this](int k) { return store_.form(k) == LandmarkForm::kPoint; });
}

/// Only after a motion: clones of a robot that stands still would stay clones.
void FastSlam::resample() {
  if (!moved_ ||
      fastslam::effective_particles(particles_.weights()) >= options_.resample_below * particles_.count())
    return;
  const double u = RandomStream(seed_, StreamPurpose::kResampling, step_).uniform();
  const auto ancestors = resampling_.choose_ancestors(particles_.weights(), u, next_count());
  particles_.replace_by_ancestors(ancestors, particle_blocks_);
  calibration_.replace_by_ancestors(ancestors);
  store_.resample(ancestors);
  ++resamplings_;
}

/// As many as the spread of the set wants (Fox 2003), or always the same.
std::size_t FastSlam::next_count() {
  if (!(options_.kld_error > 0.0)) return particles_.weights().size();
  const double wanted = std::ceil(fastslam::kld_particles(bins_.count(particles_), options_.kld_error));
  const int least = std::min(options_.kld_least, options_.particles);
  return static_cast<std::size_t>(
      std::clamp(wanted, static_cast<double>(least), static_cast<double>(options_.particles)));
}

void FastSlam::add(std::span<const Observation> observations) {
  for (std::size_t i = 0; i < observations.size(); ++i) {
    if (innovations_[i].outcome != Outcome::kAdded || contested_[i] != 0) continue;
    if (!observations[i].id) {
      innovations_[i].landmark = add_unnamed(observations[i]);
      continue;
    }
    const SeenLandmark z = seen(observations[i], std::numeric_limits<double>::infinity());
    const bool guess = options_.init == LandmarkStart::kGuess && z.kind != SightingKind::kRangeBearing;
    const fastslam::FirstForm first =
        guess ? fastslam::FirstForm{} : fastslam::first_form(z, sensor_, history_);
    const int landmark = store_.add(first.form, estimate_.T_world_robot.position(), first.modes);
    if (guess)
      fastslam::place_by_guess(
          store_, landmark, z, sensor_, particles_,
          {seed_, StreamPurpose::kInitialisation, static_cast<std::uint64_t>(landmark) + 1},
          particle_blocks_);
    else
      place(landmark, z, first.guess);
    index_.assign(innovations_[i].landmark, landmark);
    if (store_.form(landmark) != LandmarkForm::kPoint) unresolved_.push_back(landmark);
    landmarks_.push_back({.id = innovations_[i].landmark,
                          .observations = 1,
                          .seen_at_way_m = way_m_,
                          .seen_at_scan = scan_,
                          .claimed_at_scan = scan_,
                          .range_m = range_alone_m(observations[i])});
  }
}

void FastSlam::place(int landmark, const SeenLandmark& seen, const kernels::FirstGuess& guess) {
  const Eigen::Vector2d origin_m = estimate_.T_world_robot.position();
  const kernels::Sighting sighting{seen, mount_, store_.view(landmark, origin_m)};
  particle_blocks_.run([&](std::size_t begin, std::size_t end) {
    fastslam::BlockScratch scratch;
    const kernels::ParticleRange range{begin, end - begin};
    kernels::place_landmark(sighting, guess,
                            fastslam::load_sensors(particles_, mount_, origin_m, range, scratch), range);
  });
}

PoseEstimate FastSlam::pose() const {
  return is_still(pending_) ? estimate_ : propagate(estimate_, pending_);
}

/// Mean and covariance of the mixture: sum w (Sigma_i + d_i d_i^T), d_i = m_i - mean.
LandmarkEstimate FastSlam::landmark(int index) const {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  Eigen::Matrix2d second = Eigen::Matrix2d::Zero();
  Eigen::Matrix2d within = Eigen::Matrix2d::Zero();
  const Eigen::Vector2d near = store_.at(index, 0).mean;
  for (int i = 0; i < particles_.count(); ++i) {
    const fastslam::PointGaussian m = store_.at(index, i);
    const Eigen::Vector2d d = m.mean - near;
    const double w = particles_.weights()[static_cast<std::size_t>(i)];
    mean += w * d;
    within += w * m.covariance;
    second += w * d * d.transpose();
  }
  LandmarkEstimate estimate;
  estimate.id = landmarks_[static_cast<std::size_t>(index)].id;
  estimate.observations = landmarks_[static_cast<std::size_t>(index)].observations;
  estimate.position_m.head<2>() = near + mean;
  estimate.covariance.topLeftCorner<2, 2>() = within + second - mean * mean.transpose();
  estimate.within = Eigen::Matrix3d::Zero();
  estimate.within->topLeftCorner<2, 2>() = within;
  return estimate;
}

Snapshot FastSlam::snapshot() const {
  Snapshot snapshot{{}, pose(), {}};
  for (const int k : confirmed()) snapshot.landmarks.push_back(landmark(k));
  return snapshot;
}

/// Moment-matched: the spread of (pose, landmarks) over the particles plus the particles' own landmark
/// covariances.
MapState FastSlam::save() const {
  fastslam::ParticleBlocks blocks(particles_.count());
  const Pose2 T_world_robot = fastslam::estimate(particles_, blocks).T_world_robot;
  MapState map;
  const std::vector<int> saved = confirmed();
  map.landmarks.resize(2 * static_cast<Eigen::Index>(saved.size()));
  for (std::size_t k = 0; k < saved.size(); ++k) {
    const LandmarkEstimate estimate = landmark(saved[k]);
    map.ids.push_back(estimate.id);
    map.observations.push_back(estimate.observations);
    map.landmarks.segment<2>(2 * static_cast<Eigen::Index>(k)) = estimate.position_m.head<2>();
  }
  Eigen::MatrixXd P = joint_covariance(T_world_robot, saved, map.landmarks);

  // The robot's rows follow the motion that the particles have not made yet.
  const Eigen::Matrix3d F = compose_jacobian_left(T_world_robot, pending_.increment);
  const Eigen::Matrix3d G = compose_jacobian_right(T_world_robot);
  P.topRows<3>() = (F * P.topRows<3>()).eval();
  P.leftCols<3>() = (P.leftCols<3>() * F.transpose()).eval();
  P.topLeftCorner<3, 3>() += G * pending_.covariance * G.transpose();
  map.T_world_robot = T_world_robot * pending_.increment;
  map.covariance = 0.5 * (P + P.transpose());
  return map;
}

std::vector<int> FastSlam::confirmed() const {
  std::vector<int> confirmed;
  for (int k = 0; k < store_.size(); ++k)
    if (landmarks_[static_cast<std::size_t>(k)].confirmed) confirmed.push_back(k);
  return confirmed;
}

Eigen::MatrixXd FastSlam::joint_covariance(const Pose2& T_world_robot, const std::vector<int>& indices,
                                           const Eigen::VectorXd& landmarks) const {
  Eigen::MatrixXd P = Eigen::MatrixXd::Zero(3 + landmarks.size(), 3 + landmarks.size());
  Eigen::VectorXd deviation(P.rows());
  for (int i = 0; i < particles_.count(); ++i) {
    const double w = particles_.weights()[static_cast<std::size_t>(i)];
    deviation.head<3>() = difference(particles_.pose(i), T_world_robot);
    for (Eigen::Index k = 0; 2 * k < landmarks.size(); ++k) {
      const fastslam::PointGaussian m = store_.at(indices[static_cast<std::size_t>(k)], i);
      deviation.segment<2>(3 + 2 * k) = m.mean - landmarks.segment<2>(2 * k);
      P.block<2, 2>(3 + 2 * k, 3 + 2 * k) += w * m.covariance;
    }
    P += w * deviation * deviation.transpose();  // Francisco (2)
  }
  return P;
}

}  // namespace waymark
