#include "waymark/fastslam/scan_update.hpp"

#include "waymark/fastslam/sensor_model.hpp"

namespace waymark::fastslam {
namespace {

using kernels::ObservationKind;

// An observation that brings less information than this is not asked whether it should move particles.
constexpr double kMinPower = 0.1;
// So many particles FastSlamOptions::enkf_above is for; more can afford to lose more.
constexpr double kParticlesOfEnkfAbove = 100.0;

}  // namespace

ScanUpdate::ScanUpdate(const FastSlamOptions& options, ParticleBlocks& blocks)
    : weight_(options.information_distance_m),
      enkf_(blocks),
      enkf_above_(options.enkf_above),
      shapes_motion_(options.proposal == ProposalKind::kObservations) {}

void ScanUpdate::accept(const kernels::LandmarkObservation& observation, int landmark, double power,
                        const InnovationMoments& moments, Belief& belief) {
  const bool may_use_enkf =
      belief.store.modes(landmark) == 1 && belief.landmarks.travelled_since_m(landmark) > kMinTravelled_m;
  const bool is_taken = may_use_enkf && update_by_enkf(observation, power, moments, belief);
  accepted_.push_back({observation, is_taken ? 0.0 : power, shapes_motion_});
}

void ScanUpdate::accept_by(const float* takers, const kernels::LandmarkObservation& observation,
                           double power) {
  accepted_.push_back({observation, power, shapes_motion_, takers});
}

bool ScanUpdate::update_by_enkf(const kernels::LandmarkObservation& observation, double power,
                                InnovationMoments moments, Belief& belief) {
  if (power < kMinPower) return false;
  const double spread_above = enkf_above_ * belief.particles.count() / kParticlesOfEnkfAbove;
  const ObservationKind kind = observation.seen.kind;
  const std::int64_t enkf_updates = enkf_updates_;
  for (int k = 0; k < dimension(kind); ++k) {
    if (!(power * moments.spread(k, k) > spread_above * moments.noise(k, k))) continue;
    const bool is_bearing =
        kind != ObservationKind::kRange && (k == 1 || kind != ObservationKind::kRangeBearing);
    enkf_.assimilate({observation, is_bearing, moments.covariance()(k, k), power}, belief);
    ++enkf_updates_;
    belief.load_sample();
    moments = belief.compare(observation);
  }
  return enkf_updates_ != enkf_updates;
}

}  // namespace waymark::fastslam
