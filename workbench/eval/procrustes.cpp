#include "workbench/eval/procrustes.hpp"

#include <cmath>

#include "workbench/eval/align.hpp"
#include "workbench/eval/truth_track.hpp"

namespace waymark::eval {
namespace {

/// Root mean square of the distances between moved estimates and truths; `at(i)` is the i-th of them.
template <class At>
double rmse_m(std::size_t count, const Similarity& similarity, const At& at) {
  double sum = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const auto [estimated, truth] = at(i);
    sum += (similarity * estimated - truth).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(count));
}

}  // namespace

std::optional<ProcrustesScore> procrustes_score(std::span<const PosePair> pairs,
                                                const MatchedPlaces& landmarks) {
  constexpr std::size_t kLandmarksMin = 3;
  if (landmarks.estimated.size() < kLandmarksMin) return std::nullopt;
  const auto similarity = align_similarity(landmarks.estimated, landmarks.surveyed);
  if (!similarity) return std::nullopt;
  ProcrustesScore score{.scale = similarity->scale};
  score.landmark_rmse_m = rmse_m(landmarks.estimated.size(), *similarity, [&](std::size_t i) {
    return std::pair(landmarks.estimated[i], landmarks.surveyed[i]);
  });
  if (!pairs.empty())
    score.position_rmse_m = rmse_m(pairs.size(), *similarity, [&](std::size_t i) {
      return std::pair<Eigen::Vector2d, Eigen::Vector2d>(pairs[i].estimate.position(),
                                                         position_of(pairs[i].truth));
    });
  return score;
}

}  // namespace waymark::eval
