#include "waymark/ekf/unknown_matcher.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "waymark/association/gate.hpp"
#include "waymark/core/as_index.hpp"
#include "waymark/core/gaussian.hpp"
#include "waymark/models/observation_models.hpp"

namespace waymark::ekf {
namespace {

// A third of the smallest submap: so many landmarks may be considered at once.
constexpr std::size_t kMaxConsidered = 48;
// Landmarks that one observation is compared with; the likeliest stay.
constexpr std::ptrdiff_t kMaxPerObservation = 6;
// Pairings that joint compatibility tries per scan.
constexpr int kMaxPairings = 2000;

/// -2 log N(nu; 0, S) but for a constant.
double cost_of(double nis, const Eigen::Matrix2d& S) { return nis + std::log(S.determinant()); }

double range_m(const Observation& observation) { return std::get<RangeBearing>(observation.value).range_m; }

}  // namespace

UnknownMatcher::UnknownMatcher(const UnknownAssociation& association, const GateOptions& gate,
                               const AssociationModel& model, PointMap& map, const PointObservation& sensor)
    : map_(map),
      sensor_(sensor),
      model_(model),
      gate_(Gate(gate).threshold(2)),
      jointly_(association.jointly),
      joint_(gate.probability, static_cast<int>(kMaxConsidered), kMaxPairings) {
  considered_.reserve(kMaxConsidered);
}

std::span<const UnknownMatch> UnknownMatcher::match(std::span<const Observation> observations,
                                                    std::span<const Innovation> innovations,
                                                    const NearbyLandmarks& nearby) {
  candidates_.clear();
  considered_.clear();
  for (std::size_t i = 0; i < observations.size(); ++i)
    if (innovations[i].outcome == Outcome::kUnidentified)
      find_candidates(static_cast<int>(i), observations[i], nearby);
  if (candidates_.empty()) return {};
  if (jointly_)
    match_jointly(observations);
  else
    match_greedily(observations);
  return candidates_;
}

/// From where an observation is expected to where its gate may reach, but for what is unsure of the landmark.
double UnknownMatcher::reach_m(const Observation& observation) const {
  const Eigen::Matrix3d P = map_.state().active().pose().covariance;
  const Eigen::Matrix2d& R = *observation.covariance;
  const double across_m = range_m(observation);
  return std::sqrt(P(0, 0) + P(1, 1)) + across_m * std::sqrt(P(2, 2)) +
         std::sqrt(R(0, 0) + across_m * across_m * R(1, 1));
}

/// Calls visit(observation, S, NIS) for the landmarks within the gate of an observation. Standard deviations
/// are added up to find them: whatever the correlations are, no error is larger.
template <class Visit>
void UnknownMatcher::visit_gated(const Observation& observation, const NearbyLandmarks& nearby,
                                 const Visit& visit) const {
  const double k_sigma = std::sqrt(gate_);
  const double reach = reach_m(observation);
  const Eigen::Vector2d p_world =
      sensor_.T_world_sensor() * position_in_sensor(std::get<RangeBearing>(observation.value));
  nearby.visit(p_world, k_sigma * (reach + nearby.sigma_m()), [&](int k) {
    const double far_m = (nearby.place(k) - p_world).norm();
    if (far_m > k_sigma * (reach + map_.sigma_m(k))) return;
    const auto linearization = sensor_.linearize(k, map_.table()[k].id, observation);
    if (!linearization) return;
    const Eigen::Matrix2d S = map_.state().innovation_covariance(*linearization);
    const auto nis = mahalanobis_squared<2>(linearization->nu, S);
    if (nis && *nis <= gate_) visit(*linearization, S, *nis);
  });
}

bool UnknownMatcher::is_near_a_landmark(const Observation& observation, const NearbyLandmarks& nearby) const {
  bool near = false;
  visit_gated(observation, nearby,
              [&](const LinearizedObservation&, const Eigen::Matrix2d&, double) { near = true; });
  return near;
}

void UnknownMatcher::find_candidates(int index, const Observation& observation,
                                     const NearbyLandmarks& nearby) {
  const auto first = std::ssize(candidates_);
  visit_gated(observation, nearby,
              [&](const LinearizedObservation& linearization, const Eigen::Matrix2d& S, double nis) {
                if (!map_.table().is_claimed(linearization.landmark))
                  candidates_.push_back({index, cost_of(nis, S), linearization});
              });
  std::sort(candidates_.begin() + first, candidates_.end(),
            [](const UnknownMatch& a, const UnknownMatch& b) { return a.cost < b.cost; });
  if (std::ssize(candidates_) > first + kMaxPerObservation)
    candidates_.erase(candidates_.begin() + first + kMaxPerObservation, candidates_.end());
  const auto refused = [this](const UnknownMatch& candidate) {
    return !consider(candidate.linearization.landmark);
  };
  candidates_.erase(std::remove_if(candidates_.begin() + first, candidates_.end(), refused),
                    candidates_.end());
}

/// False if that would be too many landmarks.
bool UnknownMatcher::consider(int landmark) {
  if (std::ranges::find(considered_, landmark) != considered_.end()) return true;
  if (considered_.size() == kMaxConsidered) return false;
  considered_.push_back(landmark);
  return true;
}

/// The log-odds that the landmark is observed, over the density of observations of nothing known.
double UnknownMatcher::bonus(const UnknownMatch& candidate, const Observation& observation) const {
  const double existence = map_.table()[candidate.linearization.landmark].existence.probability();
  return model_.log_odds_of_observation(existence) - model_.log_density_of_others(range_m(observation));
}

void UnknownMatcher::match_jointly(std::span<const Observation> observations) {
  joint_.clear();
  for (const UnknownMatch& c : candidates_)
    joint_.add({c.observation, c.linearization.landmark, c.linearization.nu, c.linearization.R,
                bonus(c, observations[as_index(c.observation)])});
  map_.state().consider(considered_);
  joint_.solve(static_cast<int>(observations.size()), [&](int a, int b) {
    return map_.state().common_covariance(candidates_[as_index(a)].linearization,
                                          candidates_[as_index(b)].linearization);
  });
  keep([this](int pair) { return joint_.pair_of(candidates_[as_index(pair)].observation) == pair; });
}

void UnknownMatcher::match_greedily(std::span<const Observation> observations) {
  greedy_.clear();
  for (const UnknownMatch& c : candidates_)
    greedy_.add({c.observation, c.linearization.landmark,
                 -0.5 * c.cost - kLogTwoPi + bonus(c, observations[as_index(c.observation)])});
  greedy_.solve(static_cast<int>(observations.size()), map_.state().landmarks(), 0.0);
  keep([this](int pair) {
    const UnknownMatch& c = candidates_[as_index(pair)];
    return greedy_.landmark_of(c.observation) == c.linearization.landmark;
  });
}

/// Leaves the matches of all candidates.
template <class IsMatch>
void UnknownMatcher::keep(const IsMatch& is_match) {
  std::size_t kept = 0;
  for (int pair = 0; pair < static_cast<int>(std::ssize(candidates_)); ++pair)
    if (is_match(pair)) candidates_[kept++] = candidates_[as_index(pair)];
  candidates_.resize(kept);
}

}  // namespace waymark::ekf
