#include "waymark/fastslam/fast_slam_options.hpp"

namespace waymark {

void describe(Schema& schema, FastSlamOptions& o) {
  schema.choice("fastslam.proposal", o.proposal, {"1.0", "2.0"},
                "FastSLAM 1.0 draws from the odometry alone, 2.0 from odometry and sightings");
  schema.choice("fastslam.init", o.init, {"anchored", "guess"},
                "a landmark seen by range or bearing alone begins as all that this allows, or each particle "
                "guesses where it is");
  schema.integer("fastslam.particles", o.particles, {1, 10'000'000}, "number of particles");
  schema.real("fastslam.resample_below", o.resample_below, {0.0, 1.0},
              "resample when the effective number of particles falls below this part of them");
  schema.real(
      "fastslam.temper_below", o.temper_below, {0.0, 1.0},
      "flatten the weights when the effective number of particles would fall below this part of them");
  schema.real(
      "fastslam.move_above", o.move_above, {0.0, 1e9},
      "move 100 particles and their maps, instead of weighing them, where what they expect to see varies "
      "by more than this part of its noise; n times as many by n times as much");
  schema.real("fastslam.noise_inflation", o.noise_inflation, {0.1, 100.0},
              "factor on the standard deviations of observations; few particles need a blunter sensor");
  schema.real(
      "fastslam.evidence_way_m", o.evidence_way_m, {0.0, 1000.0},
      "a landmark seen again after this way counts 63 % in the weights; 0: every sighting counts in full");
  schema.real(
      "fastslam.kld_error", o.kld_error, {0.0, 1.0},
      "keep as many particles, up to fastslam.particles, as hold this Kullback-Leibler distance to the "
      "belief, usually 0.05; 0: always the same number");
  schema.integer("fastslam.kld_least", o.kld_least, {1, 10'000'000}, "fewest particles to keep then");
  schema.integer("fastslam.capacity", o.capacity, {1, 1'000'000}, "most landmarks in the map");
}

}  // namespace waymark
