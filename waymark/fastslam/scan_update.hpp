#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "waymark/fastslam/belief.hpp"
#include "waymark/fastslam/enkf_update.hpp"
#include "waymark/fastslam/fast_slam_options.hpp"
#include "waymark/fastslam/information_weight.hpp"
#include "waymark/fastslam/particle_step.hpp"

namespace waymark::fastslam {

/// Collects what the particles take in at their next step, and decides what each observation does to them: it
/// moves them or weighs them. One of a landmark that comes back, where particles disagree on what they see,
/// moves them (EnkfUpdate), and then does not weigh them; from a robot that has stood since the last one
/// none does. All shape the motion in FastSLAM 2.0 and update their landmarks.
class ScanUpdate {
 public:
  /// `blocks` must outlive it.
  ScanUpdate(const FastSlamOptions& options, ParticleBlocks& blocks);

  void begin() { accepted_.clear(); }

  /// The power of the likelihood of an observation of this landmark: see InformationWeight.
  [[nodiscard]] double power(int landmark, const Belief& belief) const {
    return weight_.power(belief.landmarks.travelled_since_m(landmark));
  }

  /// Takes in an observation with these moments of its innovation, the power of its likelihood given. May
  /// move the particles at once, O(N landmarks): then what was compared before is to be compared again.
  void accept(const kernels::LandmarkObservation& observation, int landmark, double power,
              const InnovationMoments& moments, Belief& belief);
  /// The same for some of the particles only, which it never moves: see AcceptedObservation::takers.
  void accept_by(const float* takers, const kernels::LandmarkObservation& observation, double power);

  /// Valid until the next begin().
  [[nodiscard]] std::span<const AcceptedObservation> accepted() const { return accepted_; }

  /// How often an observation moved the particles instead of weighing them.
  [[nodiscard]] std::int64_t enkf_updates() const { return enkf_updates_; }

 private:
  [[nodiscard]] bool update_by_enkf(const kernels::LandmarkObservation& observation, double power,
                                    InnovationMoments moments, Belief& belief);

  InformationWeight weight_;
  EnkfUpdate enkf_;
  double enkf_above_;
  bool shapes_motion_;
  std::vector<AcceptedObservation> accepted_;
  std::int64_t enkf_updates_ = 0;
};

}  // namespace waymark::fastslam
