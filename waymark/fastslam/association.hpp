#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "waymark/association/association_options.hpp"
#include "waymark/association/greedy_match.hpp"
#include "waymark/association/grid_index.hpp"
#include "waymark/core/aligned_array.hpp"
#include "waymark/fastslam/gate_sample.hpp"
#include "waymark/fastslam/landmark_store.hpp"

namespace waymark::fastslam {

/// Finds out which landmarks observations of unknown identity are of.
///
/// The particles decide together where they agree, each for itself where they do not. Together: the
/// innovation of an observation against a landmark has a mean and a covariance over the whole set, spread of
/// the particles included. Its score is
///     log N(nu; 0, S) + log(q / (1 - q)) - log(density of others),
/// q the chance that the landmark exists and is seen, against the density of clutter and unknown landmarks
/// (Montemerlo and Thrun 2003, with the odds of tracks from Reid 1979); the best pairs are taken one to one.
/// A set that the odometry led astray is thus compared as one that is unsure, not particle by particle, of
/// which those that fit badly would rather invent landmarks than die. Where another choice would score within
/// kAmbiguityMargin the particles split: each takes the pairs that are best for its own pose and map.
class Association {
 public:
  /// Scores nearer to each other than this are not told apart by the set.
  static constexpr double kAmbiguityMargin = 3.0;

  /// `blocks` must outlive it.
  Association(const AssociationModel& model, ParticleBlocks& blocks);

  /// Where the landmarks are for one particle, to be found by visit_near(). O(landmarks).
  void index(const LandmarkStore& store, int particle);
  template <class Visit>
  void visit_near(const Eigen::Vector2d& p_world, double radius_m, const Visit& visit) const {
    grid_.visit_near(p_world, radius_m, visit);
  }

  void begin() { match_.clear(); }
  /// An observation at a range, compared with a landmark that exists with some probability.
  void consider(int observation, int landmark, const InnovationMoments& moments, double range_m,
                double existence);
  /// Decides for the set. Observations and landmarks count from 0.
  void solve(int observations, int landmarks) { match_.solve(observations, landmarks, kAmbiguityMargin); }
  [[nodiscard]] const GreedyMatch& match() const { return match_; }

  /// One of the choices between which the particles split.
  struct Choice {
    int observation = 0;
    int landmark = GreedyMatch::kNothing;  ///< or none that is known
    double log_odds = 0.0;                 ///< of an observation of the landmark
    double log_others = 0.0;               ///< density of others
    float* column =
        nullptr;  ///< per particle: log N(nu; 0, L) until split(), then 1 if it takes this, else 0
  };

  void begin_split() { choices_.clear(); }
  /// Room for an ambiguous pair; null if there is none left.
  Choice* offer(int observation, int landmark, double range_m, double existence);
  /// The same for the choice that an observation is of nothing known.
  Choice* offer_none(int observation, double range_m);
  [[nodiscard]] std::span<const Choice> choices() const { return choices_; }
  /// Every particle chooses among the offers, whose columns are filled: greedily by score, one to one, and
  /// none for an observation that is left over. Gathered landmarks that it does not have are not for it.
  void split(const LandmarkStore& store);
  /// What the choice adds to the log weight of those that take it, besides log N(nu; 0, L) without its
  /// constant.
  [[nodiscard]] static double log_weight(const Choice& choice);

 private:
  Choice* add_choice(const Choice& choice);
  void choose(const LandmarkStore& store, std::size_t particle);

  AssociationModel model_;
  ParticleBlocks& blocks_;
  GridIndex grid_;
  std::vector<Eigen::Vector2d> places_;
  GreedyMatch match_;
  std::vector<Choice> choices_;
  std::size_t stride_;
  AlignedArray<float> columns_;  // of choices
};

}  // namespace waymark::fastslam
