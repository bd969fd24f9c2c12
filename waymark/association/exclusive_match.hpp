#pragma once

#include <span>
#include <vector>

namespace waymark {

/// A sighting that may be of a landmark. The score is the log-likelihood of that over the one of being of
/// nothing known.
struct ScoredPair {
  int sighting = 0;
  int landmark = 0;
  double score = 0.0;
};

/// Decides which sighting of one scan is of which landmark, one to one: the pair of the highest score first,
/// until none is above 0. Memory is taken as scans grow and kept.
class ExclusiveMatch {
 public:
  static constexpr int kNothing = -1;

  void clear() { pairs_.clear(); }
  /// Scores that are not numbers are left out.
  void add(const ScoredPair& pair) {
    if (pair.score == pair.score) pairs_.push_back(pair);
  }
  [[nodiscard]] std::span<const ScoredPair> pairs() const { return pairs_; }

  /// O(n log n) in the pairs. Sightings and landmarks count from 0. Contested is a sighting that is matched,
  /// or competes with one that is, if giving it another landmark, or its landmark to another sighting, would
  /// lower the sum of the scores by less than `margin`.
  void solve(int sightings, int landmarks, double margin);

  /// The landmark of a sighting, or kNothing.
  [[nodiscard]] int landmark_of(int sighting) const;
  [[nodiscard]] bool is_contested(int sighting) const {
    return contested_[static_cast<std::size_t>(sighting)] != 0;
  }

 private:
  [[nodiscard]] double score_of(int sighting) const;
  [[nodiscard]] double best_without(int sighting, int landmark, int freed) const;
  void contest(int pair, double margin);

  std::vector<ScoredPair> pairs_;
  std::vector<int> pair_of_sighting_;
  std::vector<int> sighting_of_landmark_;
  std::vector<char> contested_;
};

}  // namespace waymark
