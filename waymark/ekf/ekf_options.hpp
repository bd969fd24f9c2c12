#pragma once

#include <optional>

#include "waymark/association/association_options.hpp"
#include "waymark/association/gate.hpp"
#include "waymark/ekf/consistency.hpp"
#include "waymark/ekf/odometry_state_options.hpp"

namespace waymark {

namespace ekf {

/// How wild an observation may be that was not gated.
enum class Likelihood {
  kGaussian,
  kStudent  ///< heavy tails: the larger what is left of an innovation, the less the observation counts
};

}  // namespace ekf

/// What is done with observations that do not say which landmark they are of.
struct UnknownAssociation {
  bool jointly =
      true;  ///< matched by what they say together (JointCompatibility), or pair by pair (GreedyMatch)
  AssociationOptions options;
};

/// Whether the map outside of the robot's submap is left alone for the time being.
enum class Compress { kAuto, kAlways, kNever };

struct EkfOptions {
  ekf::Consistency consistency = ekf::Consistency::kInvariant;
  int capacity = 1000;
  Compress compressed = Compress::kAuto;
  int iterations = 0;  ///< how often an update may be linearised anew where it leaves the linear
  ekf::Likelihood likelihood = ekf::Likelihood::kGaussian;
  OdometryStateOptions odometry;  ///< with which a map is not compressed
  int submap = 64;                ///< landmarks of a compressed map that are kept up to date at every step
  int loaded = 0;  ///< landmarks that load() will bring: they are the first submap of a compressed map
  GateOptions gate;
  std::optional<UnknownAssociation> unknown;  ///< empty: observations without identity are refused
};

}  // namespace waymark
