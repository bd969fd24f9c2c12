#include "waymark/fastslam/fast_slam.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "waymark/core/gaussian.hpp"
#include "waymark/fastslam/resampling.hpp"
#include "waymark/models/observation_models.hpp"

namespace waymark {
namespace {

enum Block : std::size_t { kAssociate, kPredict, kUpdate, kEstimate, kResample, kAdd };

// Particles draw from the collected motion at the latest when its heading is this unsure: a Gaussian (x, y,
// theta) is then still a good picture of it, the sagitta 1 - cos(3 sigma) being 0.4 % of the distance.
constexpr double kMaxPendingHeadingSigma_rad = 0.03;

// A misread identity is an odd one out. So many gated sightings without an accepted one between them mean
// that the particles are lost, and a lost set that gates would stay lost.
constexpr int kMostGatedInARow = 5;

// How much of a way a turn on the spot counts as: it shows a landmark from no new place, but at a new
// bearing.
constexpr double kMetresPerRadian = 0.3;

bool is_finite(const Motion& motion) {
  const Pose2& T = motion.increment;
  return std::isfinite(T.x_m) && std::isfinite(T.y_m) && std::isfinite(T.theta_rad) &&
         motion.covariance.allFinite();
}

bool is_positive_definite(const Eigen::Matrix2d& R) {
  return R.allFinite() && R(0, 0) > 0.0 && R.determinant() > 0.0;
}

/// What an observation must bring before anything else is asked: its kind, finite numbers, noise.
bool is_usable(const Observation& observation) {
  const auto* z = std::get_if<RangeBearing>(&observation.value);
  return z != nullptr && std::isfinite(z->range_m) && std::isfinite(z->bearing_rad) &&
         z->range_m > kMinDistance_m && observation.covariance &&
         is_positive_definite(*observation.covariance);
}

/// The belief's spread as a motion from its mean.
Motion spread_of(const PoseEstimate& pose) {
  Motion spread;
  const Eigen::Matrix3d G = compose_jacobian_right(pose.T_world_robot);
  spread.covariance = G.transpose() * pose.covariance * G;
  return spread;
}

}  // namespace

void describe(Schema& schema, FastSlamOptions& o) {
  schema.choice("fastslam.proposal", o.proposal, {"1.0", "2.0"},
                "FastSLAM 1.0 draws from the odometry alone, 2.0 from odometry and sightings");
  schema.integer("fastslam.particles", o.particles, {1, 10'000'000}, "number of particles");
  schema.real("fastslam.resample_below", o.resample_below, {0.0, 1.0},
              "resample when the effective number of particles falls below this part of them");
  schema.real(
      "fastslam.temper_below", o.temper_below, {0.0, 1.0},
      "flatten the weights when the effective number of particles would fall below this part of them");
  schema.real("fastslam.noise_inflation", o.noise_inflation, {0.1, 100.0},
              "factor on the standard deviations of observations; few particles need a blunter sensor");
  schema.real(
      "fastslam.evidence_way_m", o.evidence_way_m, {0.0, 1000.0},
      "a landmark seen again after this way counts 63 % in the weights; 0: every sighting counts in full");
  schema.integer("fastslam.capacity", o.capacity, {1, 1'000'000}, "most landmarks in the map");
}

FastSlam::FastSlam(const FastSlamOptions& options, const GateOptions& gate, const Pose2& T_robot_sensor,
                   std::uint64_t seed, int threads, const PoseEstimate& initial)
    : options_(options),
      gate_(gate),
      T_robot_sensor_(T_robot_sensor),
      seed_(seed),
      particle_blocks_(options.particles, threads),
      particles_(options.particles, initial.T_world_robot),
      store_(particle_blocks_),
      proposal_(options.particles),
      log_likelihood_(static_cast<std::size_t>(options.particles)),
      ancestors_(static_cast<std::size_t>(options.particles)),
      index_(static_cast<std::size_t>(options.capacity)),
      estimate_(initial) {
  if (!initial.covariance.isZero(0.0))
    fastslam::move(particles_, spread_of(initial), {seed_, StreamPurpose::kInitialisation, 0},
                   particle_blocks_);
}

void FastSlam::predict(const Motion& motion) {
  if (is_still(motion) || !is_finite(motion)) return;
  pending_ = compose(pending_, motion);
  way_m_ += motion.increment.position().norm() + kMetresPerRadian * std::abs(motion.increment.theta_rad);
  moved_ = true;
  if (pending_.covariance(2, 2) < kMaxPendingHeadingSigma_rad * kMaxPendingHeadingSigma_rad) return;
  BlockTimer timer(table_);
  move_particles();
  estimate_ = fastslam::estimate(particles_, particle_blocks_);
  timer.finish(kPredict);
}

void FastSlam::move_particles() {
  if (is_still(pending_)) return;
  estimate_ = pose();
  fastslam::move(particles_, pending_, {seed_, StreamPurpose::kMotion, step_++}, particle_blocks_);
  pending_ = {};
}

const Correction& FastSlam::correct(std::span<const Observation> observations) {
  BlockTimer timer(table_);
  associate(observations);
  timer.finish(kAssociate);
  correction_ = {innovations_, {}};
  if (!any(Outcome::kMatched) && !any(Outcome::kAdded)) return correction_;

  if (options_.proposal == ProposalKind::kMotion) move_particles();
  timer.finish(kPredict);
  if (options_.proposal == ProposalKind::kMotion)
    update(observations);
  else
    propose(observations);
  timer.finish(kUpdate);
  if (any(Outcome::kMatched)) estimate_ = fastslam::estimate(particles_, particle_blocks_);
  timer.finish(kEstimate);
  resample();
  timer.finish(kResample);
  add(observations);
  timer.finish(kAdd);
  moved_ = false;
  return correction_;
}

bool FastSlam::any(Outcome outcome) const {
  return std::ranges::any_of(innovations_, [outcome](const Innovation& i) { return i.outcome == outcome; });
}

std::span<const double> FastSlam::weights() const {
  return {particles_.weight.data(), particles_.weight.size()};
}

void FastSlam::associate(std::span<const Observation> observations) {
  innovations_.assign(observations.size(), {});
  int room = options_.capacity - store_.size();
  for (std::size_t i = 0; i < observations.size(); ++i) {
    Innovation& innovation = innovations_[i];
    if (observations[i].id) innovation.landmark = *observations[i].id;
    innovation.outcome = screen(i, observations[i]);
    if (innovation.outcome == Outcome::kAdded && room-- <= 0) innovation.outcome = Outcome::kMapFull;
  }
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
  return index_.find(*observation.id) ? Outcome::kMatched : Outcome::kAdded;
}

fastslam::Sighting FastSlam::sighting(const Observation& observation) const {
  return {std::get<RangeBearing>(observation.value), noise(observation), T_robot_sensor_};
}

Eigen::Matrix2d FastSlam::noise(const Observation& observation) const {
  return options_.noise_inflation * options_.noise_inflation * *observation.covariance;
}

void FastSlam::update(std::span<const Observation> observations) {
  for (std::size_t i = 0; i < observations.size(); ++i)
    if (innovations_[i].outcome == Outcome::kMatched) compare(observations[i], innovations_[i]);
  if (any(Outcome::kMatched)) weigh();
}

/// Updates the sighted landmark of all particles, or of none when the whole set did not expect the
/// observation: a gate on each particle would let those starve that the odometry happened to lead astray.
/// Weights stay those before the scan until all its observations are judged, so their order does not matter.
void FastSlam::compare(const Observation& observation, Innovation& innovation) {
  const int landmark = *index_.find(innovation.landmark);
  const auto before = store_.touch(landmark);
  const auto after = store_.draft();
  const fastslam::Sighting z = sighting(observation);
  const auto moments = particle_blocks_.sum([&](std::size_t begin, std::size_t end) {
    return fastslam::update_landmark(z, particles_, before, after, log_likelihood_.data(), begin, end);
  });
  judge(moments, innovation);
  if (innovation.outcome != Outcome::kMatched) return;
  store_.accept(landmark);
  const double part = evidence(landmark);
  for (std::size_t i = 0; i < log_likelihood_.size(); ++i)
    particles_.log_weight[i] += part * log_likelihood_[i];
  count_sighting(landmark);
}

/// FastSLAM 2.0: the sightings shape where each particle goes before it goes there; then its landmarks are
/// updated from where it went.
void FastSlam::propose(std::span<const Observation> observations) {
  estimate_ = pose();
  proposal_.start(particles_, pending_, particle_blocks_);
  for (std::size_t i = 0; i < observations.size(); ++i)
    if (innovations_[i].outcome == Outcome::kMatched) condition(observations[i], innovations_[i]);
  if (any(Outcome::kMatched)) weigh();
  proposal_.sample(particles_, {seed_, StreamPurpose::kMotion, step_++}, particle_blocks_);
  pending_ = {};
  for (std::size_t i = 0; i < observations.size(); ++i)
    if (innovations_[i].outcome == Outcome::kMatched) update_landmark(observations[i]);
}

void FastSlam::condition(const Observation& observation, Innovation& innovation) {
  const auto moments =
      proposal_.condition(std::get<RangeBearing>(observation.value), noise(observation), T_robot_sensor_,
                          particles_, store_.touch(*index_.find(innovation.landmark)), particle_blocks_);
  judge(moments, innovation);
  if (innovation.outcome == Outcome::kMatched)
    proposal_.accept(particles_, evidence(*index_.find(innovation.landmark)));
}

/// At the pose that was drawn, with the landmark as it was before the scan.
void FastSlam::update_landmark(const Observation& observation) {
  const int landmark = *index_.find(*observation.id);
  const auto before = store_.touch(landmark);
  const auto after = store_.draft();
  const fastslam::Sighting z = sighting(observation);
  particle_blocks_.run([&](std::size_t begin, std::size_t end) {
    fastslam::update_landmark(z, particles_, before, after, log_likelihood_.data(), begin, end);
  });
  store_.accept(landmark);
  count_sighting(landmark);
}

/// 1 for a landmark that comes back after a long way, next to nothing for one that has just been seen.
double FastSlam::evidence(int landmark) const {
  const double way_m = way_m_ - landmarks_[static_cast<std::size_t>(landmark)].seen_at_way_m;
  return options_.evidence_way_m > 0.0 ? -std::expm1(-way_m / options_.evidence_way_m) : 1.0;
}

void FastSlam::count_sighting(int landmark) {
  Landmark& sighted = landmarks_[static_cast<std::size_t>(landmark)];
  ++sighted.observations;
  sighted.seen_at_way_m = way_m_;
}

/// NIS of the mixture: mean and covariance of the innovation over all particles.
void FastSlam::judge(const fastslam::InnovationMoments& m, Innovation& innovation) {
  const Eigen::Vector2d nu(m[0], m[1]);
  const Eigen::Matrix2d S = Eigen::Matrix2d{{m[2], m[3]}, {m[3], m[4]}} - nu * nu.transpose();
  const auto nis = std::isfinite(m[5]) ? mahalanobis_squared<2>(nu, S) : std::nullopt;
  innovation.dof = nis ? 2 : 0;
  innovation.nis = nis.value_or(0.0);
  innovation.gate = gate_.threshold(2);
  if (!nis) {
    innovation.outcome = Outcome::kUnusable;
    return;
  }
  gated_in_a_row_ = *nis > innovation.gate ? gated_in_a_row_ + 1 : 0;
  if (gated_in_a_row_ > 0 && gated_in_a_row_ <= kMostGatedInARow) innovation.outcome = Outcome::kGated;
}

void FastSlam::weigh() {
  if (fastslam::normalise_weights(particles_, particle_blocks_)) {
    fastslam::temper_weights(particles_, options_.temper_below * particles_.count(), particle_blocks_);
    return;
  }
  for (Innovation& innovation : innovations_)
    if (innovation.outcome == Outcome::kMatched) innovation.outcome = Outcome::kUnusable;
}

/// Only after a motion: clones of a robot that stands still would stay clones.
void FastSlam::resample() {
  if (!moved_ || fastslam::effective_particles(weights()) >= options_.resample_below * particles_.count())
    return;
  const std::span<std::int32_t> ancestors(ancestors_.data(), ancestors_.size());
  const double u = RandomStream(seed_, StreamPurpose::kResampling, step_).uniform();
  fastslam::choose_ancestors(weights(), u, ancestors);
  fastslam::replace_by_ancestors(particles_, ancestors, particle_blocks_);
  store_.resample(ancestors);
  ++resamplings_;
}

void FastSlam::add(std::span<const Observation> observations) {
  for (std::size_t i = 0; i < observations.size(); ++i) {
    if (innovations_[i].outcome != Outcome::kAdded) continue;
    const int landmark = store_.add();
    const auto columns = store_.touch(landmark);
    const fastslam::Sighting z = sighting(observations[i]);
    particle_blocks_.run([&](std::size_t begin, std::size_t end) {
      fastslam::place_landmark(z, particles_, columns, begin, end);
    });
    index_.assign(innovations_[i].landmark, landmark);
    landmarks_.push_back({innovations_[i].landmark, 1, way_m_});
  }
}

PoseEstimate FastSlam::pose() const {
  return is_still(pending_) ? estimate_ : propagate(estimate_, pending_);
}

/// Mean and covariance of the mixture: sum w (Sigma_i + d_i d_i^T), d_i = m_i - mean.
LandmarkEstimate FastSlam::landmark(int index) const {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  Eigen::Matrix2d within = Eigen::Matrix2d::Zero();
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  for (int i = 0; i < particles_.count(); ++i) {
    const auto m = store_.at(index, i);
    mean += weights()[static_cast<std::size_t>(i)] * Eigen::Vector2d(m.x, m.y);
  }
  for (int i = 0; i < particles_.count(); ++i) {
    const auto m = store_.at(index, i);
    const Eigen::Vector2d d = Eigen::Vector2d(m.x, m.y) - mean;
    const double w = weights()[static_cast<std::size_t>(i)];
    within += w * Eigen::Matrix2d{{m.xx, m.xy}, {m.xy, m.yy}};
    spread += w * d * d.transpose();
  }
  LandmarkEstimate estimate;
  estimate.id = landmarks_[static_cast<std::size_t>(index)].id;
  estimate.observations = landmarks_[static_cast<std::size_t>(index)].observations;
  estimate.position_m.head<2>() = mean;
  estimate.covariance.topLeftCorner<2, 2>() = within + spread;
  estimate.within = Eigen::Matrix3d::Zero();
  estimate.within->topLeftCorner<2, 2>() = within;
  return estimate;
}

Snapshot FastSlam::snapshot() const {
  Snapshot snapshot{{}, pose(), {}};
  for (int k = 0; k < store_.size(); ++k) snapshot.landmarks.push_back(landmark(k));
  return snapshot;
}

/// Moment-matched: the spread of (pose, landmarks) over the particles plus the particles' own landmark
/// covariances.
MapState FastSlam::save() const {
  fastslam::ParticleBlocks blocks(particles_.count());
  const Pose2 T_world_robot = fastslam::estimate(particles_, blocks).T_world_robot;
  MapState map;
  map.landmarks.resize(2 * store_.size());
  for (int k = 0; k < store_.size(); ++k) {
    const LandmarkEstimate estimate = landmark(k);
    map.ids.push_back(estimate.id);
    map.observations.push_back(estimate.observations);
    map.landmarks.segment<2>(2 * k) = estimate.position_m.head<2>();
  }
  Eigen::MatrixXd P = joint_covariance(T_world_robot, map.landmarks);

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

Eigen::MatrixXd FastSlam::joint_covariance(const Pose2& T_world_robot,
                                           const Eigen::VectorXd& landmarks) const {
  Eigen::MatrixXd P = Eigen::MatrixXd::Zero(3 + landmarks.size(), 3 + landmarks.size());
  Eigen::VectorXd deviation(P.rows());
  for (int i = 0; i < particles_.count(); ++i) {
    const double w = weights()[static_cast<std::size_t>(i)];
    deviation.head<3>() = difference(particles_.pose(i), T_world_robot);
    for (int k = 0; k < store_.size(); ++k) {
      const auto m = store_.at(k, i);
      deviation.segment<2>(3 + 2 * k) = Eigen::Vector2d(m.x, m.y) - landmarks.segment<2>(2 * k);
      P.block<2, 2>(3 + 2 * k, 3 + 2 * k) += w * Eigen::Matrix2d{{m.xx, m.xy}, {m.xy, m.yy}};
    }
    P += w * deviation * deviation.transpose();
  }
  return P;
}

}  // namespace waymark
