#pragma once

#include <cstdint>
#include <optional>

#include "waymark/association/association_options.hpp"
#include "waymark/association/gate.hpp"
#include "waymark/core/motion.hpp"

namespace waymark {

/// What a particle knows when it draws its next pose.
enum class ProposalKind {
  kMotion,       ///< the odometry alone (FastSLAM 1.0, Montemerlo et al. 2002)
  kObservations  ///< the odometry and what is seen now (FastSLAM 2.0, Montemerlo et al. 2003)
};

struct FastSlamOptions {
  ProposalKind proposal = ProposalKind::kObservations;
  int particles = 150;
  double resample_below = 0.5;  ///< resample when N_eff falls below this part of the particles
  double temper_below = 0.1;    ///< flatten weights when N_eff would fall below this part of the particles
  double enkf_above = 0.01;     ///< move 100 particles where expectations vary by more of their noise
  double information_distance_m =
      1.0;  ///< distance between two observations of a landmark that makes the second informative
  double noise_inflation = 1.0;  ///< on the standard deviations of observations
  int capacity = 1000;           ///< most landmarks in the map
  GateOptions gate;
  std::uint64_t seed = 1;  ///< same seed, same bits, whatever the number of threads
  PoseEstimate initial;    ///< where the robot is believed to start
  /// With it observations need no identities, but must be by range and bearing where they have none.
  std::optional<AssociationOptions> unknown;
};

}  // namespace waymark
