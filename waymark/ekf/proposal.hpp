#pragma once

#include <Eigen/Core>

#include "waymark/core/pose2.hpp"
#include "waymark/ekf/belief.hpp"
#include "waymark/ekf/consistency.hpp"
#include "waymark/ekf/linearized_observation.hpp"
#include "waymark/ekf/slots.hpp"

namespace waymark::ekf {

/// Where an update would lead, for those who want to see that and perhaps linearise there. A view, good until
/// the state is next changed or proposed anything.
class Proposal {
 public:
  /// dx: increments of `before`, n, as Update finds them.
  Proposal(const Belief& before, const double* dx)
      : before_(before), dx_(dx), retraction_(before.consistency(), dx[2]) {}
  /// The same for a compressed map: landmarks go by their index in it. Those asked for must be in the
  /// submap.
  [[nodiscard]] Proposal with_indices_of(const Slots& map) const;

  [[nodiscard]] Pose2 pose() const;
  [[nodiscard]] Eigen::Vector3d landmark(int index) const;
  [[nodiscard]] Eigen::Vector2d expected(const BiasTerms& terms) const;
  /// H dx: what the proposal explains of an observation's innovation, if all were linear.
  [[nodiscard]] Eigen::Vector2d explained(const LinearizedObservation& linearization) const;
  /// An observation that was linearised at what is proposed (nu = z - h there, ordinary Jacobians), as one of
  /// the state as it still is: the step of Gauss and Newton, nu + H dx, with H to the increments dx that the
  /// state is moved by.
  [[nodiscard]] LinearizedObservation relinearized_to_prior(const LinearizedObservation& linearization) const;

 private:
  /// Its index in the state.
  [[nodiscard]] int local(int landmark) const {
    return map_ == nullptr ? landmark : map_->local_of(landmark);
  }
  [[nodiscard]] Eigen::Vector3d increment(int landmark) const {
    return before_.layout().landmark(dx_, local(landmark));
  }
  [[nodiscard]] Eigen::Vector2d turned(const Eigen::Matrix<double, 2, 3>& H, const Eigen::Vector2d& dq) const;

  const Belief& before_;
  const double* dx_;
  Retraction retraction_;
  const Slots* map_ = nullptr;  // null: landmarks go by their index in the state
};

}  // namespace waymark::ekf
