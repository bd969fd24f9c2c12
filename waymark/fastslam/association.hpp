#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "waymark/association/association_options.hpp"
#include "waymark/association/exclusive_match.hpp"
#include "waymark/association/grid_index.hpp"
#include "waymark/core/aligned_array.hpp"
#include "waymark/fastslam/gate_sample.hpp"
#include "waymark/fastslam/landmark_store.hpp"

namespace waymark::fastslam {

/// Finds out which landmarks unnamed sightings are of.
///
/// The particles decide together where they agree, each for itself where they do not. Together: the
/// innovation of a sighting against a landmark has a mean and a covariance over the whole set, spread of the
/// particles included. Its score is
///     log N(nu; 0, S) + log(q / (1 - q)) - log(density of others),
/// q the chance that the landmark exists and is seen, against the density of clutter and unknown landmarks
/// (Montemerlo and Thrun 2003, with the odds of tracks from Reid 1979); the best pairs are taken one to one.
/// A set that the odometry led astray is thus compared as one that is unsure, not particle by particle, of
/// which those that fit badly would rather invent landmarks than die. Where another choice would score within
/// kContestMargin the particles split: each takes the pairs that are best for its own pose and map.
class Association {
 public:
  /// Scores nearer to each other than this are not told apart by the set.
  static constexpr double kContestMargin = 3.0;

  /// `blocks` must outlive it.
  Association(const AssociationModel& model, ParticleBlocks& blocks);

  /// Where the landmarks are for one particle, to be found by visit_near(). O(landmarks).
  void index(const LandmarkStore& store, int particle);
  template <class Visit>
  void visit_near(const Eigen::Vector2d& p_world, double radius_m, const Visit& visit) const {
    grid_.visit_near(p_world, radius_m, visit);
  }

  void begin() { match_.clear(); }
  /// A sighting at a range, compared with a landmark that exists with some probability.
  void consider(int sighting, int landmark, const InnovationMoments& moments, double range_m,
                double existence);
  /// Decides for the set. Sightings and landmarks count from 0.
  void solve(int sightings, int landmarks) { match_.solve(sightings, landmarks, kContestMargin); }
  [[nodiscard]] const ExclusiveMatch& match() const { return match_; }

  /// One of the choices between which the particles split.
  struct Choice {
    int sighting = 0;
    int landmark = ExclusiveMatch::kNothing;  ///< or none that is known
    double log_odds = 0.0;                    ///< of a sighting of the landmark
    double log_others = 0.0;                  ///< density of others
    float* column =
        nullptr;  ///< per particle: log N(nu; 0, L) until split(), then 1 if it takes this, else 0
  };

  void begin_split() { choices_.clear(); }
  /// Room for a contested pair; nothing if there is none left.
  Choice* offer(int sighting, int landmark, double range_m, double existence);
  /// The same for the choice that a sighting is of nothing known.
  Choice* offer_none(int sighting, double range_m);
  [[nodiscard]] std::span<const Choice> choices() const { return choices_; }
  /// Every particle chooses among the offers, whose columns are filled: greedily by score, one to one, and
  /// none for a sighting that is left over. Touched landmarks that it does not have are not for it.
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
  ExclusiveMatch match_;
  std::vector<Choice> choices_;
  std::size_t stride_;
  AlignedArray<float> columns_;  // of choices
};

}  // namespace waymark::fastslam
