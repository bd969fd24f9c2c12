#include "waymark/fastslam/particle_existence.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "waymark/kernels/particle_existence.hpp"

namespace waymark::fastslam {
namespace {

// Particles of so little weight together do not keep a landmark.
constexpr double kMinSupport = 0.01;

}  // namespace

Support support(const float* log_odds, double confirmed, const Particles& particles, ParticleBlocks& blocks) {
  const auto sure = static_cast<float>(confirmed);
  const auto sums = blocks.sum([&](std::size_t begin, std::size_t end) {
    std::array<double, 3> sum{};
    for (std::size_t i = begin; i < end; ++i) {
      const double w = log_odds[i] < 0.0F ? 0.0 : particles.weights()[i];
      sum[0] += w;
      sum[1] += log_odds[i] < sure ? 0.0 : w;
      sum[2] += w * static_cast<double>(log_odds[i]);
    }
    return sum;
  });
  const double mean = sums[0] > 0.0 ? sums[2] / sums[0] : 0.0;
  return {sums[0], sums[1], sums[0] / (1.0 + std::exp(-mean))};
}

ParticleExistence::ParticleExistence(const AssociationModel& model, const SensorModel& sensor,
                                     const ParticleBlocks& blocks)
    : model_(model), sensor_(sensor.sensor()), view_(sensor.view()), nobody_(blocks.capacity()) {}

void ParticleExistence::update(const Scan& scan, const ParticleMatcher& matcher, double reach,
                               Belief& belief) {
  find_landmarks_in_reach(matcher, reach, belief);
  for (const int k : scan.landmarks)
    if (k != Scan::kNone && belief.landmarks.is_claimed(k)) update_observed(k, belief);
  update_chosen(matcher, belief);
  for (const int k : in_reach_)
    if (!belief.landmarks.is_claimed(k)) update_observed_by(nobody_.data(), k, belief);
  for (const int k : in_reach_) record_support(k, belief);
}

void ParticleExistence::find_landmarks_in_reach(const ParticleMatcher& matcher, double reach,
                                                const Belief& belief) {
  in_reach_.clear();
  const PoseEstimate& robot = belief.estimate;
  const Eigen::Vector2d p_world = (robot.T_world_robot * sensor_.T_robot_sensor()).position();
  const double unsure_m = std::sqrt(reach * robot.covariance.topLeftCorner<2, 2>().trace());
  matcher.visit_near(p_world, sensor_.max_range_m + unsure_m, [&](int k) {
    if (belief.store.existence(k) != nullptr) in_reach_.push_back(k);
  });
}

/// Particles may have taken different observations for the same landmark.
void ParticleExistence::update_chosen(const ParticleMatcher& matcher, Belief& belief) {
  const auto choices = matcher.choices();
  for (std::size_t c = 0; c < choices.size(); ++c) {
    const int landmark = choices[c].landmark;
    if (landmark == GreedyMatch::kNothing) continue;
    if (belief.landmarks.is_claimed(landmark)) continue;
    belief.landmarks.claim(landmark);
    for (std::size_t other = c + 1; other < choices.size(); ++other)
      if (choices[other].landmark == landmark)
        for (int i = 0; i < belief.particles.count(); ++i) choices[c].column[i] += choices[other].column[i];
    update_observed_by(choices[c].column, landmark, belief);
  }
}

void ParticleExistence::update_observed(int landmark, Belief& belief) {
  belief.store.gather(landmark);
  float* const log_odds = belief.store.existence(landmark);
  if (log_odds == nullptr) return;
  belief.blocks.run([&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      log_odds[i] = static_cast<float>(model_.after_observation(static_cast<double>(log_odds[i])));
  });
}

/// The `takers` observed it; the others missed it if they have it in view.
void ParticleExistence::update_observed_by(const float* takers, int landmark, Belief& belief) {
  belief.store.gather(landmark);
  float* const log_odds = belief.store.existence(landmark);
  if (log_odds == nullptr) return;
  const auto missed = static_cast<float>(model_.missed());
  const kernels::LandmarkView view = belief.view(landmark);
  belief.run_with_sensors(view_.mount, [&](const auto& sensors, const kernels::ParticleRange& range) {
    alignas(64) float before[ParticleBlocks::kBlockSize];
    std::copy_n(log_odds + range.begin, range.count, before);
    kernels::miss_landmark(view, sensors, view_, missed, log_odds, range);
    for (std::size_t i = 0; i < range.count; ++i)
      if (takers[range.begin + i] != 0.0F)
        log_odds[range.begin + i] =
            static_cast<float>(model_.after_observation(static_cast<double>(before[i])));
  });
}

void ParticleExistence::record_support(int landmark, Belief& belief) const {
  const Support held =
      support(belief.store.existence(landmark), kConfirmedLogOdds, belief.particles, belief.blocks);
  belief.records[as_index(landmark)].existence_probability =
      held.present < kMinSupport ? 0.0 : held.probability;
  if (held.confirmed > 0.5) belief.landmarks.existence(landmark).confirm();
}

}  // namespace waymark::fastslam
