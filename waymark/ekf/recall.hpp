#pragma once

#include <vector>

#include <Eigen/Core>

#include "waymark/ekf/compressed_terms.hpp"
#include "waymark/ekf/consistency.hpp"
#include "waymark/ekf/linearized_observation.hpp"
#include "waymark/ekf/passive_submap.hpp"
#include "waymark/ekf/state.hpp"

namespace waymark::ekf {

/// The landmarks outside of the submap as they are now: as they were when it was opened, and what the submap
/// has done to them since. With B the landmark's columns then, over the n_a rows of the active state,
///
///     p = p_0 + V(a) B^T tau,   P_ap = phi B,   P_pp = P_pp0 - B^T psi B
///
/// and in the invariant filter the shear along d = J (p - p_0). One landmark costs 4 n_a^2 flop.
class Recall {
 public:
  /// One landmark. The columns, n_a x dimension, are views, good until the next question.
  struct Landmark {
    Eigen::Vector3d position;
    Eigen::Vector3d shear;  ///< d of its coordinates
    Eigen::Matrix3d covariance;
    Eigen::Ref<const Eigen::MatrixXd> base;            ///< B
    Eigen::Ref<const Eigen::MatrixXd> minus_psi_base;  ///< -psi B
    Eigen::Ref<const Eigen::MatrixXd> cross;           ///< what it has in common with the active state
  };

  /// All of these must outlive it. `members`: the slots in the submap, in the order of the active state;
  /// `capacity`: most values of that.
  Recall(const State& active, const CompressedTerms& since, PassiveSubmap& passive,
         const std::vector<int>& members, std::size_t capacity);

  [[nodiscard]] Landmark landmark(int slot);
  /// Its position alone, at a part of the cost.
  [[nodiscard]] Eigen::Vector3d position(int slot);

  /// As those of Belief, of an observation of the landmark in `slot`.
  [[nodiscard]] Eigen::Matrix2d innovation_covariance(int slot, const LinearizedObservation& linearization);
  [[nodiscard]] Eigen::Matrix<double, 3, 2> pose_correlation(int slot,
                                                             const LinearizedObservation& linearization);

 private:
  [[nodiscard]] Retraction retraction() const { return {active_.consistency(), since_.turn()}; }
  [[nodiscard]] Eigen::Vector3d displacement(int slot, const Retraction& retraction);
  [[nodiscard]] Eigen::Vector2d correlation(std::size_t row, const SparseJacobian& jacobian) const;

  const State& active_;
  const CompressedTerms& since_;
  PassiveSubmap& passive_;
  const std::vector<int>& members_;
  // Of the landmark asked for last.
  Eigen::MatrixXd base_;
  Eigen::MatrixXd minus_psi_base_;
  Eigen::MatrixXd cross_;
};

}  // namespace waymark::ekf
