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
    if (k != Scan::kNone && belief.landmarks.is_claimed(k)) note_observation(k, nullptr, belief);
  note_choices(matcher, belief);
  for (const int k : in_reach_)
    if (!belief.landmarks.is_claimed(k)) note_observation(k, nobody_.data(), belief);
  for (const int k : in_reach_) note_support(k, belief);
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
void ParticleExistence::note_choices(const ParticleMatcher& matcher, Belief& belief) {
  const auto choices = matcher.choices();
  for (std::size_t c = 0; c < choices.size(); ++c) {
    const int landmark = choices[c].landmark;
    if (landmark == GreedyMatch::kNothing) continue;
    if (belief.landmarks.is_claimed(landmark)) continue;
    belief.landmarks.claim(landmark);
    for (std::size_t other = c + 1; other < choices.size(); ++other)
      if (choices[other].landmark == landmark)
        for (int i = 0; i < belief.particles.count(); ++i) choices[c].column[i] += choices[other].column[i];
    note_observation(landmark, choices[c].column, belief);
  }
}

/// `takers` (all: null) saw it; the others should have if they have it in view.
void ParticleExistence::note_observation(int landmark, const float* takers, Belief& belief) {
  belief.store.touch(landmark);
  float* const log_odds = belief.store.existence(landmark);
  if (log_odds == nullptr) return;
  const Eigen::Vector2d origin_m = belief.origin_m();
  const auto missed = static_cast<float>(model_.missed());
  belief.blocks.run([&](std::size_t begin, std::size_t end) {
    alignas(64) float before[ParticleBlocks::kBlockSize];
    std::copy(log_odds + begin, log_odds + end, before);
    if (takers != nullptr) {
      BlockScratch scratch;
      const kernels::ParticleRange range{begin, end - begin};
      const auto sensors = load_sensors(belief.particles, view_.mount, origin_m, range, scratch);
      kernels::miss_landmark(belief.store.view(landmark, origin_m), sensors, view_, missed, log_odds, range);
    }
    for (std::size_t i = begin; i < end; ++i)
      if (takers == nullptr || takers[i] != 0.0F)
        log_odds[i] = static_cast<float>(model_.after_observation(static_cast<double>(before[i - begin])));
  });
}

void ParticleExistence::note_support(int landmark, Belief& belief) const {
  const Support held =
      support(belief.store.existence(landmark), model_.confirmed(), belief.particles, belief.blocks);
  belief.records[as_index(landmark)].existence = held.present < kMinSupport ? 0.0 : held.probability;
  if (held.confirmed > 0.5) belief.landmarks.existence(landmark).confirm();
}

}  // namespace waymark::fastslam
