#pragma once

#include <span>

#include <Eigen/Core>

#include "waymark/core/aligned_array.hpp"
#include "waymark/ekf/linearized_observation.hpp"
#include "waymark/ekf/state_layout.hpp"
#include "waymark/ekf/update.hpp"

namespace waymark::ekf {

/// What a state of n values did since some moment to everything that it is correlated with (Guivant and Nebot
/// 2001). Let B be its covariance at that moment with other values b that nothing has touched since. Then by
/// now
///
///   P_ab = phi B,   P_bb = P_bb0 - B^T psi B,   x_b = x_b0 + B^T tau.
///
/// For the invariant filter this leaves out how far b itself was moved: P_ab lacks P_a,theta d_b^T.
///
/// All are n x n or n. A landmark that is new or comes in later gets a row and a column like the others; a
/// new one has zeros in B. An update of D rows costs 3 n^2 D flop, three times what the state itself needs.
class CompressedTerms {
 public:
  /// Memory for states of up to `capacity` values.
  explicit CompressedTerms(std::size_t capacity);

  /// From now on: phi = I, psi = 0, tau = 0.
  void restart(std::size_t n);

  /// The robot moved: what State::propagate_cross_covariance() returned.
  void carry(const Eigen::Vector2d& displacement);

  /// A pair of biases drifted: State::propagate_bias().
  void propagate_bias(int pair, double rho);

  /// Before the state's update: G <- H phi.
  void project(std::span<const LinearizedObservation> linearizations, const StateLayout& layout);
  /// After it.
  void absorb(const Gain& gain);

  /// The state is about to add a landmark at g(pose, z, errors) with these Jacobians: State::add().
  void append_new(int dimension, const Eigen::Matrix3d& G_pose, const BiasTerms& errors);
  /// The state is about to take in a landmark b: `B` is its column of B, n x dimension, and `d` by how much
  /// its heading column was sheared.
  void append_known(const Eigen::Ref<const Eigen::MatrixXd>& B, const Eigen::Vector3d& d);

  [[nodiscard]] std::size_t size() const { return n_; }
  [[nodiscard]] std::size_t stride() const { return ld_; }
  [[nodiscard]] const double* phi() const { return phi_.data(); }
  /// -psi, upper triangle.
  [[nodiscard]] const double* minus_psi() const { return minus_psi_.data(); }
  [[nodiscard]] const double* tau() const { return tau_.data(); }
  /// How far the corrections turned the robot, rad.
  [[nodiscard]] double turn() const { return turn_; }

  using Column = Eigen::Ref<Eigen::VectorXd>;
  using ConstColumn = Eigen::Ref<const Eigen::VectorXd>;
  /// out = phi b
  void multiply_phi(const ConstColumn& b, Column out) const;
  /// out = -psi b
  void multiply_minus_psi(const ConstColumn& b, Column out) const;

 private:
  using Buffer = AlignedArray<double>;

  void add_rows(double* out, const SparseJacobian& jacobian, int row) const;
  void shear_phi(const Gain& gain);
  /// Room for `dimension` more rows and columns of zeros.
  void grow(std::size_t dimension);

  std::size_t n_ = 0;
  std::size_t ld_;
  Buffer phi_;
  Buffer minus_psi_;
  Buffer tau_;
  Buffer G_;  // D x n: H phi, then L^-1 H phi
  double turn_ = 0.0;
};

}  // namespace waymark::ekf
