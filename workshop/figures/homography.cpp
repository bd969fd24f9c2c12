#include "workshop/figures/homography.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include <Eigen/Geometry>

#include "waymark/core/random.hpp"

namespace waymark {
namespace {

constexpr int kDraws = 200;

Consensus judge(std::span<const PlacePair> pairs, const Eigen::Matrix3d& H, double threshold_px) {
  Consensus consensus{H, {}};
  for (const auto& [before, now] : pairs)
    consensus.agrees.push_back((consensus.map(before) - now).norm() <= threshold_px);
  return consensus;
}

std::array<PlacePair, 4> draw(std::span<const PlacePair> pairs, RandomStream& random) {
  std::array<PlacePair, 4> drawn;
  for (PlacePair& each : drawn)
    each = pairs[static_cast<std::size_t>(random.uniform(0.0, static_cast<double>(pairs.size())))];
  return drawn;
}

}  // namespace

Eigen::Vector2d Consensus::map(const Eigen::Vector2d& before) const {
  return (H * before.homogeneous()).hnormalized();
}

Eigen::Matrix2d Consensus::derivative(const Eigen::Vector2d& before) const {
  const double w = H.row(2).dot(before.homogeneous());
  return (H.topLeftCorner<2, 2>() - map(before) * H.block<1, 2>(2, 0)) / w;
}

std::size_t Consensus::size() const { return static_cast<std::size_t>(std::ranges::count(agrees, true)); }

Consensus find_homography(std::span<const PlacePair> pairs, double threshold_px) {
  Consensus best{.H = Eigen::Matrix3d::Identity(), .agrees = std::vector<bool>(pairs.size(), false)};
  if (pairs.size() < 5) return best;
  const auto keep_better = [&](const std::optional<Eigen::Matrix3d>& H) {
    if (!H) return;
    if (auto other = judge(pairs, *H, threshold_px); other.size() >= best.size()) best = std::move(other);
  };
  RandomStream random(1, StreamPurpose::kSimulation);
  for (int i = 0; i < kDraws; ++i) keep_better(homography(draw(pairs, random)));
  std::vector<PlacePair> agreeing;
  for (std::size_t i = 0; i < pairs.size(); ++i)
    if (best.agrees[i]) agreeing.push_back(pairs[i]);
  if (agreeing.size() > 4) keep_better(homography(agreeing));
  return best;
}

}  // namespace waymark
