#pragma once

#include <algorithm>
#include <cassert>
#include <cmath>
#include <span>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "waymark/ekf/ekf_options.hpp"
#include "waymark/ekf/state.hpp"

namespace waymark::ekf {

/// The iterated update of Bell and Cathey (1993): a step of Gauss and Newton, and more of them, linearised
/// where the last one led, as long as what is left of the innovations differs from what was linearly expected
/// by more than kNegligibleChange. With the Student-t likelihood each step weighs the noise anew (Lange,
/// Little, Taylor 1989). docs/ekf.md, "Large innovations", derives it.
class IteratedUpdate {
 public:
  /// Squared and in units of the noise: a fifth of its standard deviation.
  static constexpr double kNegligibleChange = 0.04;

  /// At most `iterations` steps after the first one, with heavy tails no less than three; none with kFej,
  /// where first estimates stay what they are.
  IteratedUpdate(int iterations, Likelihood likelihood, Consistency consistency);

  /// Updates the state with all of `block` at once, at most kMaxObservations of it (Vincke 10 to 12).
  /// `linearize(k, before)` gives the k-th one, `before` as of the last step, at what the state now proposes
  /// (nu = z - h there, ordinary Jacobians; its R is set here), or nothing where that cannot be seen: then
  /// the last step counts. False, and nothing changed, if S is not positive definite. The block must not be
  /// empty. `state` is a State or a CompressedState. Allocates nothing. Cost: that of State::propose() per
  /// step.
  template <class FilterState, class Linearize>
  [[nodiscard]] bool apply(FilterState& state, std::span<const LinearizedObservation> block,
                           const Linearize& linearize) {
    assert(!block.empty());
    if (!state.propose(block)) return false;
    std::span<const LinearizedObservation> last = block;
    for (int i = 0; i < most_ && relinearize(state, block, last, linearize); ++i) {
      if (!state.propose(refined_)) return false;
      last = refined_;
    }
    state.accept();
    return true;
  }

 private:
  /// False, and refined_ as it was, if the proposal is as good as linear, or leads to where nothing can be
  /// seen.
  template <class FilterState, class Linearize>
  [[nodiscard]] bool relinearize(const FilterState& state, std::span<const LinearizedObservation> block,
                                 std::span<const LinearizedObservation> last, const Linearize& linearize) {
    const Proposal proposal = state.proposal();
    there_.clear();
    double change = 0.0;
    for (std::size_t k = 0; k < block.size(); ++k) {
      const LinearizedObservation& before = last[k];
      const Eigen::Matrix2d& R = block[k].R;
      auto there = linearize(k, before);
      if (!there) return false;
      const Eigen::Vector2d bent = there->nu - (before.nu - proposal.explained(before));
      there->R = student_t_weight(*there, R) * R;
      change = std::max(
          {change, bent.dot(R.llt().solve(bent)), std::abs(std::log(there->R(0, 0) / before.R(0, 0)))});
      there_.push_back(*there);
    }
    if (change < kNegligibleChange) return false;
    refined_.clear();
    for (const LinearizedObservation& there : there_)
      refined_.push_back(proposal.relinearized_to_prior(there));
    return true;
  }

  [[nodiscard]] double student_t_weight(const LinearizedObservation& left, const Eigen::Matrix2d& R) const;

  int most_;
  Likelihood likelihood_;
  std::vector<LinearizedObservation> there_;    // linearised at the proposal
  std::vector<LinearizedObservation> refined_;  // the same, as of the state before the update
};

}  // namespace waymark::ekf
