#include "waymark/association/greedy_match.hpp"

#include <algorithm>
#include <tuple>

#include "waymark/core/as_index.hpp"

namespace waymark {
namespace {}  // namespace

void GreedyMatch::solve(int observations, int landmarks, double margin) {
  std::ranges::sort(pairs_, {}, [](const ScoredPair& pair) {
    return std::tuple(-pair.score, pair.observation, pair.landmark);
  });
  pair_of_observation_.assign(as_index(observations), kNothing);
  observation_of_landmark_.assign(as_index(landmarks), kNothing);
  ambiguous_.assign(as_index(observations), 0);
  for (std::size_t i = 0; i < pairs_.size() && pairs_[i].score > 0.0; ++i) {
    const auto& [observation, landmark, score] = pairs_[i];
    if (pair_of_observation_[as_index(observation)] != kNothing ||
        observation_of_landmark_[as_index(landmark)] != kNothing)
      continue;
    pair_of_observation_[as_index(observation)] = static_cast<int>(i);
    observation_of_landmark_[as_index(landmark)] = observation;
  }
  for (int i = 0; i < static_cast<int>(pairs_.size()); ++i) mark_ambiguous(i, margin);
}

int GreedyMatch::landmark_of(int observation) const {
  const int pair = pair_of_observation_[as_index(observation)];
  return pair == kNothing ? kNothing : pairs_[as_index(pair)].landmark;
}

double GreedyMatch::score_of(int observation) const {
  const int pair = pair_of_observation_[as_index(observation)];
  return pair == kNothing ? 0.0 : pairs_[as_index(pair)].score;
}

/// The best that an observation can have when it must leave one landmark and another becomes free.
double GreedyMatch::best_without(int observation, int landmark, int freed) const {
  double best = 0.0;
  for (const ScoredPair& pair : pairs_) {
    if (pair.observation != observation || pair.landmark == landmark) continue;
    if (pair.landmark == freed || observation_of_landmark_[as_index(pair.landmark)] == kNothing)
      best = std::max(best, pair.score);
  }
  return best;
}

/// Whether a pair that was not chosen might as well have been.
void GreedyMatch::mark_ambiguous(int pair, double margin) {
  const auto& [observation, landmark, score] = pairs_[as_index(pair)];
  const int own = landmark_of(observation);
  const int holder = observation_of_landmark_[as_index(landmark)];
  if (own == landmark || (own == kNothing && holder == kNothing)) return;
  double change = score - score_of(observation);
  if (change + margin <= 0.0) return;
  if (holder != kNothing) change += best_without(holder, landmark, own) - score_of(holder);
  if (change + margin <= 0.0) return;
  ambiguous_[as_index(observation)] = 1;
  if (holder != kNothing) ambiguous_[as_index(holder)] = 1;
}

}  // namespace waymark
