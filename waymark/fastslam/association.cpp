#include "waymark/fastslam/association.hpp"

#include <array>
#include <cmath>

#include <Eigen/LU>

#include "waymark/core/gaussian.hpp"

namespace waymark::fastslam {
namespace {

// A few landmarks per cell where they are as dense as trunks.
constexpr double kCell_m = 2.0;
// So many choices a particle can tell apart in bits.
constexpr std::size_t kMaxChoices = 32;

double log_density(const InnovationMoments& moments) {
  const Eigen::Matrix2d S = moments.covariance();
  return -0.5 * (moments.mean.dot(S.inverse() * moments.mean) + std::log(S.determinant())) - kLogTwoPi;
}

}  // namespace

Association::Association(const AssociationModel& model, ParticleBlocks& blocks)
    : model_(model),
      blocks_(blocks),
      grid_(kCell_m),
      stride_(blocks.capacity()),
      columns_(kMaxChoices * blocks.capacity()) {
  choices_.reserve(kMaxChoices);
}

void Association::index(const LandmarkStore& store, int particle) {
  places_.clear();
  for (int k = 0; k < store.size(); ++k) places_.push_back(store.at(k, particle).mean);
  grid_.build(places_);
}

void Association::consider(int observation, int landmark, const InnovationMoments& moments, double range_m,
                           double existence) {
  const double score = log_density(moments) + model_.log_odds_of_observation(existence) -
                       model_.log_density_of_others(range_m);
  match_.add({observation, landmark, score});
}

Association::Choice* Association::add_choice(const Choice& choice) {
  if (choices_.size() == kMaxChoices) return nullptr;
  choices_.push_back(choice);
  choices_.back().column = columns_.data() + (choices_.size() - 1) * stride_;
  return &choices_.back();
}

Association::Choice* Association::offer(int observation, int landmark, double range_m, double existence) {
  return add_choice({observation, landmark, model_.log_odds_of_observation(existence),
                     model_.log_density_of_others(range_m), nullptr});
}

Association::Choice* Association::offer_none(int observation, double range_m) {
  return add_choice(
      {observation, GreedyMatch::kNothing, 0.0, model_.log_density_of_others(range_m), nullptr});
}

void Association::split(const LandmarkStore& store) {
  blocks_.run([&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) choose(store, i);
  });
}

/// Bit c of `open` is set while choice c can still be taken.
void Association::choose(const LandmarkStore& store, std::size_t particle) {
  std::array<double, kMaxChoices> scores{};
  std::uint32_t open = 0;
  for (std::size_t c = 0; c < choices_.size(); ++c) {
    Choice& choice = choices_[c];
    const bool known = choice.landmark != GreedyMatch::kNothing;
    const float* existence = known ? store.existence(choice.landmark) : nullptr;
    // Being of nothing known scores 0: that it is left when nothing scores more.
    if (known) scores[c] = static_cast<double>(choice.column[particle]) + choice.log_odds - choice.log_others;
    const bool has = existence == nullptr || existence[particle] >= 0.0F;
    if (has && (!known || scores[c] > 0.0)) open |= 1U << c;
    choice.column[particle] = 0.0F;
  }
  while (open != 0) {
    std::size_t best = kMaxChoices;
    for (std::size_t c = 0; c < choices_.size(); ++c)
      if ((open >> c & 1U) != 0 && (best == kMaxChoices || scores[c] > scores[best])) best = c;
    choices_[best].column[particle] = 1.0F;
    for (std::size_t c = 0; c < choices_.size(); ++c) {
      const bool same_landmark =
          choices_[c].landmark == choices_[best].landmark && choices_[c].landmark != GreedyMatch::kNothing;
      if (choices_[c].observation == choices_[best].observation || same_landmark) open &= ~(1U << c);
    }
  }
}

double Association::log_weight(const Choice& choice) {
  return choice.landmark != GreedyMatch::kNothing ? choice.log_odds : choice.log_others + kLogTwoPi;
}

}  // namespace waymark::fastslam
