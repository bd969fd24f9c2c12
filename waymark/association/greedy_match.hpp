#pragma once

#include <span>
#include <vector>

namespace waymark {

/// An observation that may be of a landmark. The score is the log-likelihood of that over the one of being of
/// nothing known.
struct ScoredPair {
  int observation = 0;
  int landmark = 0;
  double score = 0.0;
};

/// Decides which observation of one scan is of which landmark, one to one: the pair of the highest score
/// first, until none is above 0. Memory is taken as scans grow and kept.
class GreedyMatch {
 public:
  static constexpr int kNothing = -1;

  void clear() { pairs_.clear(); }
  /// Scores that are not numbers are left out.
  void add(const ScoredPair& pair) {
    if (pair.score == pair.score) pairs_.push_back(pair);
  }
  [[nodiscard]] std::span<const ScoredPair> pairs() const { return pairs_; }

  /// O(n log n) in the pairs. Observations and landmarks count from 0. Ambiguous is an observation that is
  /// matched, or competes with one that is, if giving it another landmark, or its landmark to another
  /// observation, would lower the sum of the scores by less than `margin`.
  void solve(int observations, int landmarks, double margin);

  /// The landmark of an observation, or kNothing.
  [[nodiscard]] int landmark_of(int observation) const;
  [[nodiscard]] bool is_ambiguous(int observation) const {
    return ambiguous_[static_cast<std::size_t>(observation)] != 0;
  }

 private:
  [[nodiscard]] double score_of(int observation) const;
  [[nodiscard]] double best_without(int observation, int landmark, int freed) const;
  void mark_ambiguous(int pair, double margin);

  std::vector<ScoredPair> pairs_;
  std::vector<int> pair_of_observation_;
  std::vector<int> observation_of_landmark_;
  std::vector<char> ambiguous_;
};

}  // namespace waymark
