#include "waymark/association/exclusive_match.hpp"

#include <algorithm>
#include <tuple>

namespace waymark {
namespace {

constexpr auto index(int i) { return static_cast<std::size_t>(i); }

}  // namespace

void ExclusiveMatch::solve(int sightings, int landmarks, double margin) {
  std::ranges::sort(pairs_, {}, [](const ScoredPair& pair) {
    return std::tuple(-pair.score, pair.sighting, pair.landmark);
  });
  pair_of_sighting_.assign(index(sightings), kNothing);
  sighting_of_landmark_.assign(index(landmarks), kNothing);
  contested_.assign(index(sightings), 0);
  for (std::size_t i = 0; i < pairs_.size() && pairs_[i].score > 0.0; ++i) {
    const auto& [sighting, landmark, score] = pairs_[i];
    if (pair_of_sighting_[index(sighting)] != kNothing || sighting_of_landmark_[index(landmark)] != kNothing)
      continue;
    pair_of_sighting_[index(sighting)] = static_cast<int>(i);
    sighting_of_landmark_[index(landmark)] = sighting;
  }
  for (int i = 0; i < static_cast<int>(pairs_.size()); ++i) contest(i, margin);
}

int ExclusiveMatch::landmark_of(int sighting) const {
  const int pair = pair_of_sighting_[index(sighting)];
  return pair == kNothing ? kNothing : pairs_[index(pair)].landmark;
}

double ExclusiveMatch::score_of(int sighting) const {
  const int pair = pair_of_sighting_[index(sighting)];
  return pair == kNothing ? 0.0 : pairs_[index(pair)].score;
}

/// The best that a sighting can have when it must leave one landmark and another becomes free.
double ExclusiveMatch::best_without(int sighting, int landmark, int freed) const {
  double best = 0.0;
  for (const ScoredPair& pair : pairs_) {
    if (pair.sighting != sighting || pair.landmark == landmark) continue;
    if (pair.landmark == freed || sighting_of_landmark_[index(pair.landmark)] == kNothing)
      best = std::max(best, pair.score);
  }
  return best;
}

/// Whether a pair that was not chosen might as well have been.
void ExclusiveMatch::contest(int pair, double margin) {
  const auto& [sighting, landmark, score] = pairs_[index(pair)];
  const int own = landmark_of(sighting);
  const int holder = sighting_of_landmark_[index(landmark)];
  if (own == landmark || (own == kNothing && holder == kNothing)) return;
  double change = score - score_of(sighting);
  if (change + margin <= 0.0) return;
  if (holder != kNothing) change += best_without(holder, landmark, own) - score_of(holder);
  if (change + margin <= 0.0) return;
  contested_[index(sighting)] = 1;
  if (holder != kNothing) contested_[index(holder)] = 1;
}

}  // namespace waymark
