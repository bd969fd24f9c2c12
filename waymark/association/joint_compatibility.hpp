#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace waymark {

/// An observation that may be of a landmark, as a Gaussian filter compares them.
struct JointPair {
  int observation = 0;
  int landmark = 0;
  Eigen::Vector2d nu = Eigen::Vector2d::Zero();  ///< innovation, z - h
  Eigen::Matrix2d R = Eigen::Matrix2d::Zero();   ///< noise of the observation alone
  double bonus = 0.0;  ///< log of the odds that the landmark is sighted over the density of others there
};

/// Decides which observation of one scan is of which landmark by what they say together: joint compatibility
/// branch and bound (Neira and Tardos 2001). Errors of the pose are common to all observations of a scan, so
/// that pairs which are likely one by one may contradict each other.
///
/// A hypothesis is a set of pairs, one to one. It is compatible if nu^T S^-1 nu of all its pairs, with their
/// joint covariance S, is within the gate for their number. Of the compatible ones the one of the largest
///
///     log N(nu; 0, S) + sum of the bonuses
///
/// is taken, which is the likeliest: Neira and Tardos take the one of most pairs, and so would pair clutter
/// with whatever is near. Pairs are tried depth first, the surest observation first; S is factorised pair by
/// pair; what is left of a branch can bring no more than the remaining observations would if nothing but
/// their noise were unknown. Memory is taken as scans grow and kept.
class JointCompatibility {
 public:
  static constexpr int kNothing = -1;

  /// Gates are for this part of true hypotheses of up to `max_observations` pairs. No more than `max_nodes`
  /// pairs are tried per scan; then the best hypothesis so far counts.
  JointCompatibility(double gate_probability, int max_observations, int max_nodes);

  void clear() { pairs_.clear(); }
  void add(const JointPair& pair) { pairs_.push_back(pair); }
  [[nodiscard]] std::span<const JointPair> pairs() const { return pairs_; }

  /// `covariance(a, b)`, both indices of pairs, is H_a P H_b^T, 2x2. Observations count from 0. It is called
  /// once for two pairs that are tried together, so at most O(pairs^2) times. O(nodes * observations^2).
  template <class Covariance>
  void solve(int observations, const Covariance& covariance) {
    covariance_ = [](const void* context, int a, int b) -> Eigen::Matrix2d {
      return (*static_cast<const Covariance*>(context))(a, b);
    };
    context_ = &covariance;
    begin(observations);
    search();
  }

  /// Index of the pair of an observation, or kNothing.
  [[nodiscard]] int pair_of(int observation) const { return best_[static_cast<std::size_t>(observation)]; }
  /// The landmark of an observation, or kNothing.
  [[nodiscard]] int landmark_of(int observation) const {
    const int pair = pair_of(observation);
    return pair == kNothing ? kNothing : pairs_[static_cast<std::size_t>(pair)].landmark;
  }
  [[nodiscard]] double score() const { return best_score_; }
  /// Whether all of the last scan's hypotheses were considered.
  [[nodiscard]] bool is_exhaustive() const { return nodes_ <= max_nodes_; }

 private:
  /// The pairs of one observation, from `first` on in order_.
  struct Level {
    std::size_t first = 0;
    std::size_t count = 0;
    double surest = 0.0;  ///< by how much its best pair beats what comes next
    double bound = 0.0;   ///< what this level and those after it can bring at most
  };
  /// What is known of a pair when those chosen before it are.
  struct Step {
    Eigen::Matrix2d L;  ///< Cholesky factor of what is left of its S
    Eigen::Vector2d y;  ///< L^-1 times what is left of its nu
    double d2 = 0.0;    ///< of the hypothesis with it
    double score = 0.0;
  };

  [[nodiscard]] const Eigen::Matrix2d& common(std::size_t a, std::size_t b);
  void begin(int observations);
  void search();
  void rank_pairs();
  void make_level(std::size_t first, std::size_t count);
  [[nodiscard]] double score_alone(int pair);
  [[nodiscard]] double most_of(int pair) const;
  void descend(std::size_t level, double score);
  bool choose(int pair);
  [[nodiscard]] bool is_taken(int landmark) const;
  void keep(double score);

  std::vector<double> gates_;  // by number of pairs
  int max_nodes_;
  std::vector<JointPair> pairs_;
  Eigen::Matrix2d (*covariance_)(const void* context, int a, int b) = nullptr;  // during solve()
  const void* context_ = nullptr;
  std::vector<Eigen::Matrix2d> common_;  // H P H^T by pair and pair, lower triangle
  std::vector<char> is_known_;           // which of them are
  std::vector<double> alone_;            // score of a pair by itself
  std::vector<int> order_;               // pairs by level, the best first
  std::vector<Level> levels_;
  std::vector<int> chosen_;
  std::vector<Step> steps_;         // of the chosen
  std::vector<Eigen::Matrix2d> L_;  // by chosen pair and earlier one
  std::vector<int> best_;           // by observation
  double best_score_ = 0.0;
  int nodes_ = 0;
};

}  // namespace waymark
