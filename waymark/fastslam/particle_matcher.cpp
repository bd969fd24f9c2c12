#include "waymark/fastslam/particle_matcher.hpp"

#include <algorithm>
#include <cmath>

#include "waymark/core/gaussian.hpp"
#include "waymark/kernels/particle_likelihood.hpp"
#include "waymark/models/observation_models.hpp"

namespace waymark::fastslam {
namespace {

double range_m(const Observation& observation) { return std::get<RangeBearing>(observation.value).range_m; }

int heaviest(std::span<const double> weights) {
  return static_cast<int>(std::max_element(weights.begin(), weights.end()) - weights.begin());
}

/// From where one particle expects the observation, as far as the gate may reach, m.
double candidate_radius_m(const Observation& observation, double inflation, double gate,
                          const Eigen::Matrix3d& P) {
  const Eigen::Matrix2d& R = *observation.covariance;
  const double across = range_m(observation) * range_m(observation);
  const double variance = P(0, 0) + P(1, 1) + inflation * R(0, 0) + across * (P(2, 2) + inflation * R(1, 1));
  return std::sqrt(gate * variance);
}

/// The choice of the majority is what is told of the observation, and what its landmark is marked with.
void report_choice(const Association::Choice& choice, Scan& scan, Belief& belief) {
  const std::span<const double> weights = belief.particles.weights();
  double weight = 0.0;
  for (std::size_t i = 0; i < weights.size(); ++i) weight += choice.column[i] != 0.0F ? weights[i] : 0.0;
  const auto index = as_index(choice.observation);
  Innovation& innovation = scan.innovations[index];
  if (choice.landmark == GreedyMatch::kNothing) {
    if (weight > 0.0 && innovation.outcome == Outcome::kUnidentified) innovation.outcome = Outcome::kAdded;
    return;
  }
  if (weight <= 0.5) return;
  innovation.outcome = Outcome::kMatched;
  innovation.landmark = belief.landmarks[choice.landmark].id;
  scan.landmarks[index] = choice.landmark;
  belief.observe(choice.landmark, scan.observations[index]);
}

}  // namespace

ParticleMatcher::ParticleMatcher(const AssociationModel& model, const SensorModel& sensor,
                                 ParticleBlocks& blocks)
    : association_(model, blocks), model_(sensor) {}

bool ParticleMatcher::any_ambiguous() const {
  return std::ranges::any_of(ambiguous_, [](char c) { return c != 0; });
}

void ParticleMatcher::match(Scan& scan, const InnovationGate& gate, int room, Belief& belief) {
  association_.begin_split();
  ambiguous_.resize(scan.size());
  for (std::size_t i = 0; i < scan.size(); ++i)
    ambiguous_[i] = scan.is(i, Outcome::kUnidentified) &&
                    std::holds_alternative<RangeBearing>(scan.observations[i].value);
  // Existence is judged by what is near, whether anything is to be decided or not.
  if (!any_ambiguous()) return association_.index(belief.store, heaviest(belief.particles.weights()));
  belief.load_sample();
  decide(scan, gate, room, belief);
}

std::span<const std::size_t> ParticleMatcher::match_ambiguous(Scan& scan, const InnovationGate& gate,
                                                              int room, Belief& belief) {
  if (!any_ambiguous()) return {};
  decide(scan, gate, room, belief);
  return matched_;
}

void ParticleMatcher::decide(Scan& scan, const InnovationGate& gate, int room, Belief& belief) {
  const int particle = heaviest(belief.particles.weights());
  association_.index(belief.store, particle);
  association_.begin();
  const Pose2 T_world_sensor =
      belief.particles.pose(particle) * belief.pending.increment * model_.sensor().T_robot_sensor();
  for (std::size_t i = 0; i < scan.size(); ++i)
    if (is_ambiguous(i)) find_candidates(i, scan, gate, T_world_sensor, belief);
  association_.solve(static_cast<int>(scan.size()), belief.store.size());
  take_decisions(scan, room, belief);
}

void ParticleMatcher::find_candidates(std::size_t index, const Scan& scan, const InnovationGate& gate,
                                      const Pose2& T_world_sensor, Belief& belief) {
  const Observation& observation = scan.observations[index];
  const Eigen::Vector2d p_world =
      T_world_sensor * position_in_sensor(std::get<RangeBearing>(observation.value));
  const double radius_m =
      candidate_radius_m(observation, model_.inflation(), gate.threshold(2), belief.pose().covariance);
  association_.visit_near(p_world, radius_m, [&](int k) {
    if (belief.landmarks.is_claimed(k)) return;
    belief.store.gather(k);
    const InnovationMoments moments = gate.compare(observation, k, belief);
    const auto nis = mahalanobis_squared<2>(moments.mean, moments.covariance());
    if (nis && *nis <= gate.threshold(2))
      association_.consider(static_cast<int>(index), k, moments, range_m(observation),
                            belief.records[as_index(k)].existence_probability);
  });
}

void ParticleMatcher::take_decisions(Scan& scan, int room, Belief& belief) {
  matched_.clear();
  for (std::size_t i = 0; i < scan.size(); ++i) {
    if (!is_ambiguous(i) || association_.match().is_ambiguous(static_cast<int>(i))) continue;
    ambiguous_[i] = 0;
    const int landmark = association_.match().landmark_of(static_cast<int>(i));
    if (landmark != GreedyMatch::kNothing) {
      scan.match(i, landmark, belief.landmarks);
      matched_.push_back(i);
    } else {
      scan.innovations[i].outcome = room-- > 0 ? Outcome::kAdded : Outcome::kMapFull;
    }
  }
}

void ParticleMatcher::split(Scan& scan, ScanUpdate& update, Belief& belief) {
  if (!any_ambiguous()) return;
  for (std::size_t i = 0; i < scan.size(); ++i)
    if (is_ambiguous(i)) offer_choices(i, scan, belief);
  association_.split(belief.store);
  accept_choices(scan, update, belief);
  for (const Association::Choice& choice : choices()) report_choice(choice, scan, belief);
}

void ParticleMatcher::offer_choices(std::size_t index, const Scan& scan, Belief& belief) {
  ++splits_;
  const auto i = static_cast<int>(index);
  const Observation& observation = scan.observations[index];
  if (association_.offer_none(i, range_m(observation)) == nullptr) return;
  for (const ScoredPair& pair : association_.match().pairs()) {
    if (pair.observation != i || belief.landmarks.is_claimed(pair.landmark)) continue;
    const double existence = belief.records[as_index(pair.landmark)].existence_probability;
    const auto* choice = association_.offer(i, pair.landmark, range_m(observation), existence);
    if (choice == nullptr) continue;
    belief.store.gather(pair.landmark);
    list_likelihoods(model_.landmark_observation(observation, pair.landmark, belief), choice->column, belief);
  }
}

void ParticleMatcher::list_likelihoods(const kernels::LandmarkObservation& landmark_observation,
                                       float* column, Belief& belief) const {
  const kernels::Increment increment = increment_of(belief.pending);
  const Eigen::Vector2d origin_m = belief.origin_m();
  belief.blocks.run([&](std::size_t begin, std::size_t end) {
    BlockScratch scratch;
    const kernels::ParticleRange range{begin, end - begin};
    kernels::load_poses(belief.particles.world(begin), origin_m.x(), origin_m.y(), scratch.robots(),
                        range.count);
    kernels::list_log_likelihoods(landmark_observation, increment, scratch.robots(), column + begin, range);
  });
}

/// All choices of one observation weigh with the same power, or the power and not the likelihood would
/// choose.
double ParticleMatcher::power(int observation, const ScanUpdate& update, const Belief& belief) const {
  double least = 1.0;
  for (const Association::Choice& choice : choices())
    if (choice.observation == observation && choice.landmark != GreedyMatch::kNothing)
      least = std::min(least, update.power(choice.landmark, belief));
  return least;
}

void ParticleMatcher::accept_choices(const Scan& scan, ScanUpdate& update, Belief& belief) const {
  for (const Association::Choice& choice : choices()) {
    const double e = power(choice.observation, update, belief);
    const double constant = e * Association::log_weight(choice);
    const std::span<double> log_weights = belief.particles.log_weights();
    for (std::size_t i = 0; i < log_weights.size(); ++i)
      log_weights[i] += choice.column[i] != 0.0F ? constant : 0.0;
    if (choice.landmark == GreedyMatch::kNothing) continue;
    const Observation& observation = scan.observations[as_index(choice.observation)];
    update.accept_by(choice.column, model_.landmark_observation(observation, choice.landmark, belief), e);
  }
}

}  // namespace waymark::fastslam
