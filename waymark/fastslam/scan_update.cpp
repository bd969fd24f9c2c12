#include "waymark/fastslam/scan_update.hpp"

#include "waymark/fastslam/sensor_model.hpp"

namespace waymark::fastslam {
namespace {

using kernels::SightingKind;

// An observation that brings less news than this is not asked whether it should move particles.
constexpr double kLeastPower = 0.1;
// So many particles FastSlamOptions::move_above is for; more can afford to lose more.
constexpr double kParticlesOfMoveAbove = 100.0;

}  // namespace

ScanUpdate::ScanUpdate(const FastSlamOptions& options, ParticleBlocks& blocks)
    : weight_(options.evidence_way_m),
      move_(blocks),
      move_above_(options.move_above),
      shapes_motion_(options.proposal == ProposalKind::kSightings) {}

void ScanUpdate::accept(const kernels::Sighting& sighting, int landmark, double power,
                        const InnovationMoments& moments, Belief& belief) {
  const bool may_move =
      belief.store.modes(landmark) == 1 && belief.landmarks.travelled_since_m(landmark) > kLeastWay_m;
  const bool is_taken = may_move && move_by(sighting, power, moments, belief);
  accepted_.push_back({sighting, is_taken ? 0.0 : power, shapes_motion_});
}

void ScanUpdate::accept_by(const float* takers, const kernels::Sighting& sighting, double power) {
  accepted_.push_back({sighting, power, shapes_motion_, takers});
}

bool ScanUpdate::move_by(const kernels::Sighting& sighting, double power, InnovationMoments moments,
                         Belief& belief) {
  if (power < kLeastPower) return false;
  const double spread_above = move_above_ * belief.particles.count() / kParticlesOfMoveAbove;
  const kernels::Increment increment = increment_of(belief.pending);
  const SightingKind kind = sighting.seen.kind;
  const std::int64_t moves = moves_;
  for (int k = 0; k < dimension(kind); ++k) {
    if (!(power * moments.spread(k, k) > spread_above * moments.noise(k, k))) continue;
    const bool bearing = kind != SightingKind::kRange && (k == 1 || kind != SightingKind::kRangeBearing);
    move_.take_in(sighting, bearing, moments.covariance()(k, k), power, increment, belief.origin_m(),
                  belief.particles, belief.calibration, belief.store);
    ++moves_;
    belief.load_sample();
    moments = belief.compare(sighting);
  }
  return moves_ != moves;
}

}  // namespace waymark::fastslam
