#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "waymark/core/aligned_array.hpp"
#include "waymark/core/background.hpp"
#include "waymark/ekf/belief.hpp"
#include "waymark/ekf/compressed_terms.hpp"
#include "waymark/ekf/consistency.hpp"

namespace waymark::ekf {

/// Mean and covariance of the whole map as they were when the last submap was closed, and the work of
/// bringing them there from where the submap before it had left them (the switch of Guivant and Nebot 2001),
/// which is done bit by bit:
///
///   for each block of columns b:  B = P(submap, b);  P(submap, b) <- phi B;  x_b += B^T tau;  B and psi B
///   are kept for each block of rows:       P_bb -= B^T psi B
///
/// What is asked for is computed on the spot where the work has not come there yet, so that nobody sees a
/// difference. Everything is addressed by slot: a place for the robot and the
/// biases, then one per landmark.
///
/// The work may be done by a second thread. All members wait for it first, so that it makes no other
/// difference.
class PassiveSubmap {
 public:
  /// For `slots` landmarks, of which up to `members` are in a submap; `head` rows of the state are none of
  /// landmarks.
  PassiveSubmap(int dimension, std::size_t head, int slots, int members, bool own_thread);

  /// Row of a slot's first coordinate.
  [[nodiscard]] std::size_t offset(int slot) const {
    return robot_rows_ + static_cast<std::size_t>(slot * dimension_);
  }
  [[nodiscard]] int slots() const { return slots_; }

  /// The slot shall belong to a landmark that was not there when the last submap was closed: nothing
  /// correlates with it. Slots come into use in order.
  void clear(int slot);

  /// Closes a submap, whose landmarks are in the slots `members`, in the state's order. `since` is what it
  /// did to the others since the last submap was closed; null if there are no others. The work for the last
  /// submap must be done.
  void close(std::span<const int> members, const Belief& submap, const CompressedTerms* since);

  [[nodiscard]] bool done();
  /// Flop that are left to do.
  [[nodiscard]] double remaining();
  /// Does about as much, or has it done; what is missing for the next piece of work is carried over.
  void work(double flop);
  void finish();

  /// Mean, first estimate and covariance when the last submap was closed. Makes sure first that the work has
  /// come to the slot's columns.
  [[nodiscard]] Eigen::Vector3d position(int slot);
  [[nodiscard]] Eigen::Vector3d first_estimate(int slot) const { return point(first_, slot); }
  [[nodiscard]] Eigen::Matrix3d covariance(int slot);
  /// The slot's columns of the covariance with the robot and `members`: a column for each coordinate.
  void columns(int slot, std::span<const int> members, Eigen::Ref<Eigen::MatrixXd> out);
  /// Entry of the covariance; everything must be done.
  [[nodiscard]] double covariance(std::size_t i, std::size_t j) const {
    return i <= j ? P_[i * ld_ + j] : P_[j * ld_ + i];
  }

 private:
  using Buffer = AlignedArray<double>;

  [[nodiscard]] std::size_t size() const { return offset(slots_); }
  [[nodiscard]] double& P(std::size_t i, std::size_t j) { return i <= j ? P_[i * ld_ + j] : P_[j * ld_ + i]; }
  [[nodiscard]] Eigen::Vector3d point(const Buffer& buffer, int slot) const;
  [[nodiscard]] double present(std::size_t i, std::size_t j);

  void list_rows(std::span<const int> members, std::vector<std::size_t>& rows) const;
  void store(std::span<const int> members, const Belief& submap);
  void take_over(const CompressedTerms& since, const Belief& submap);
  void spend_credit();
  [[nodiscard]] double next_cost() const;
  void do_next();
  void update_columns_of(int slot);
  void update_columns(std::size_t block);
  void move_points(std::size_t begin, std::size_t end);
  void write_back(std::size_t begin, std::size_t end);

  int dimension_;
  std::size_t head_;
  std::size_t robot_rows_;
  int slots_ = 0;
  std::size_t ld_;

  Buffer P_;  // upper triangle
  Buffer x_;
  Buffer first_;  // first estimates of the landmarks

  // The submap that was closed last, as long as there is work to do for it.
  bool working_ = false;
  double credit_ = 0.0;  // flop
  std::size_t n_ = 0;    // size() when it was closed
  std::size_t submap_ld_;
  std::vector<std::size_t> rows_;  // its rows in P
  std::vector<char> inside_;       // by row of P: is one of them
  Buffer minus_phi_transposed_;
  Buffer minus_psi_;
  Buffer tau_;
  Buffer heading_;  // P_a,theta
  Retraction retraction_{Consistency::kStandard, 0.0};

  std::vector<char> updated_;  // by block of columns
  std::size_t next_block_ = 0;
  std::size_t next_row_ = 0;
  Buffer B_;  // submap x n; zero in the submap's own columns
  Buffer psi_b_;
  Buffer phi_b_;                    // of one block
  Buffer d_, e_;                    // shear of the landmarks outside: P += d e^T + e d^T
  std::vector<std::size_t> asked_;  // scratch of columns()

  Background background_;  // last: it ends before what it works on
};

}  // namespace waymark::ekf
