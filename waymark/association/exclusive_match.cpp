#include "waymark/association/exclusive_match.hpp"

#include <algorithm>
#include <tuple>

#include "waymark/core/as_index.hpp"

namespace waymark {
namespace {}  // namespace

void ExclusiveMatch::solve(int sightings, int landmarks, double margin) {
  std::ranges::sort(pairs_, {}, [](const ScoredPair& pair) {
    return std::tuple(-pair.score, pair.sighting, pair.landmark);
  });
  pair_of_sighting_.assign(as_index(sightings), kNothing);
  sighting_of_landmark_.assign(as_index(landmarks), kNothing);
  contested_.assign(as_index(sightings), 0);
  for (std::size_t i = 0; i < pairs_.size() && pairs_[i].score > 0.0; ++i) {
    const auto& [sighting, landmark, score] = pairs_[i];
    if (pair_of_sighting_[as_index(sighting)] != kNothing ||
        sighting_of_landmark_[as_index(landmark)] != kNothing)
      continue;
    pair_of_sighting_[as_index(sighting)] = static_cast<int>(i);
    sighting_of_landmark_[as_index(landmark)] = sighting;
  }
  for (int i = 0; i < static_cast<int>(pairs_.size()); ++i) contest(i, margin);
}

int ExclusiveMatch::landmark_of(int sighting) const {
  const int pair = pair_of_sighting_[as_index(sighting)];
  return pair == kNothing ? kNothing : pairs_[as_index(pair)].landmark;
}

double ExclusiveMatch::score_of(int sighting) const {
  const int pair = pair_of_sighting_[as_index(sighting)];
  return pair == kNothing ? 0.0 : pairs_[as_index(pair)].score;
}

/// The best that a sighting can have when it must leave one landmark and another becomes free.
double ExclusiveMatch::best_without(int sighting, int landmark, int freed) const {
  double best = 0.0;
  for (const ScoredPair& pair : pairs_) {
    if (pair.sighting != sighting || pair.landmark == landmark) continue;
    if (pair.landmark == freed || sighting_of_landmark_[as_index(pair.landmark)] == kNothing)
      best = std::max(best, pair.score);
  }
  return best;
}

/// Whether a pair that was not chosen might as well have been.
void ExclusiveMatch::contest(int pair, double margin) {
  const auto& [sighting, landmark, score] = pairs_[as_index(pair)];
  const int own = landmark_of(sighting);
  const int holder = sighting_of_landmark_[as_index(landmark)];
  if (own == landmark || (own == kNothing && holder == kNothing)) return;
  double change = score - score_of(sighting);
  if (change + margin <= 0.0) return;
  if (holder != kNothing) change += best_without(holder, landmark, own) - score_of(holder);
  if (change + margin <= 0.0) return;
  contested_[as_index(sighting)] = 1;
  if (holder != kNothing) contested_[as_index(holder)] = 1;
}

}  // namespace waymark
