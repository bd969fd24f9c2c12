#pragma once

#include <vector>

#include <Eigen/Core>

#include "waymark/core/observation.hpp"
#include "waymark/fastslam/landmark_store.hpp"
#include "waymark/fastslam/landmark_update.hpp"
#include "waymark/fastslam/particles.hpp"

namespace waymark::fastslam {

/// Where each particle goes in FastSLAM 2.0 (Montemerlo et al. 2003): a Gaussian N(mu, P) that starts as the
/// motion model and takes in one sighting after the other before anything is drawn from it, so that particles
/// land where the sensor says they may.
///
/// With nu = z - h(mu, m), Z = Hm Sigma Hm^T + R and L = Hx P Hx^T + Z, each sighting multiplies the weight
/// by N(nu; 0, L) and moves mu += K nu, P -= K L K^T, K = P Hx^T L^-1: the weights multiply to the exact
/// joint marginal, and P equals (Hx^T Z^-1 Hx + P^-1)^-1 without inverting a P that may be singular.
class Proposal {
 public:
  explicit Proposal(int particles);

  /// The motion from every particle's pose; a robot that stands still has P = 0 everywhere.
  void start(const Particles& particles, const Motion& motion, ParticleBlocks& blocks);

  /// Prepares the proposal as the sighting leaves it, with moments of the innovation over the set: those of
  /// update_landmark(), with L in the place of Z. `R` is the noise of (range, bearing).
  InnovationMoments condition(const RangeBearing& z, const Eigen::Matrix2d& R, const Pose2& T_robot_sensor,
                              const Particles& particles, const LandmarkColumns& landmark,
                              ParticleBlocks& blocks);

  /// Takes the last sighting in: into mu and P, and with the power `evidence` of its likelihood into the
  /// weights.
  void accept(Particles& particles, double evidence);

  /// Draws each particle from its proposal.
  void sample(Particles& particles, const StreamKey& key, ParticleBlocks& blocks) const;

 private:
  struct Gaussian3 {
    Eigen::Vector3d mean;  ///< x, y, theta, world frame
    Eigen::Matrix3d covariance;
  };

  std::vector<Gaussian3> now_;
  std::vector<Gaussian3> draft_;
  std::vector<double> log_likelihood_;
};

}  // namespace waymark::fastslam
