#include "waymark/vision/new_corners.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "waymark/vision/patch.hpp"

namespace waymark::vision {
namespace {

// Of cells over the image.
constexpr int kColumns = 4;
constexpr int kRows = 3;
constexpr int kCells = kColumns * kRows;
// From any other feature.
constexpr double kMinDistance_px = 20.0;

}  // namespace

double shi_tomasi_score(const ImageView& image, int u, int v, int patch_px) {
  std::int64_t uu = 0, uv = 0, vv = 0;  // of differences over two pixels: twice the gradient
  for (int y = v - before_place(patch_px); y < v + from_place(patch_px); ++y) {
    for (int x = u - before_place(patch_px); x < u + from_place(patch_px); ++x) {
      const int gu = image(x + 1, y) - image(x - 1, y), gv = image(x, y + 1) - image(x, y - 1);
      uu += gu * gu;
      uv += gu * gv;
      vv += gv * gv;
    }
  }
  const auto a = static_cast<double>(uu), b = static_cast<double>(uv), d = static_cast<double>(vv);
  return 0.25 * 0.5 * (a + d - std::hypot(a - d, 2.0 * b));
}

NewCorners::NewCorners(const NewCornerOptions& options, const CornerOptions& corners, int patch_px,
                       int width_px, int height_px)
    : options_(options),
      detector_(corners),
      pixel_ns_(work_costs(corners.instructions).pixel_ns),
      patch_px_(patch_px),
      width_px_(width_px),
      height_px_(height_px),
      features_in_(static_cast<std::size_t>(kCells)) {
  detector_.reserve(width_px / kColumns + 1, height_px / kRows + 1);
  strongest_.reserve(kRanked + 1);
  found_.reserve(static_cast<std::size_t>(options.max_new));
}

std::span<const Corner> NewCorners::find(const ImageView& image, std::span<const Eigen::Vector2d> features,
                                         int candidates, FrameBudget& budget) {
  found_.clear();
  const int in_view = static_cast<int>(features.size());
  const int most =
      std::min({options_.max_new, options_.max_candidates - candidates, options_.wanted - in_view});
  const int share = (options_.wanted + kCells - 1) / kCells;
  count_features(features);
  for (int tried = 0; tried < kCells && static_cast<int>(found_.size()) < most; ++tried) {
    const int cell = next_cell_;
    const PixelRect part = searched_part(cell);
    const double cost_ns = pixel_ns_ * std::max(part.width_px, 0) * std::max(part.height_px, 0);
    if (features_in_[static_cast<std::size_t>(cell)] < share) {
      if (!budget.allows(cost_ns)) break;
      add_best(image, part, features);
      budget.spend(cost_ns);
    }
    next_cell_ = (cell + 1) % kCells;
  }
  return found_;
}

void NewCorners::count_features(std::span<const Eigen::Vector2d> features) {
  std::ranges::fill(features_in_, 0);
  for (const Eigen::Vector2d& place : features) ++features_in_[static_cast<std::size_t>(cell_of(place))];
}

int NewCorners::cell_of(const Eigen::Vector2d& place) const {
  const auto step = [](double x, int cells, int size_px) {
    const double cell = x * cells / size_px;
    return cell > 0.0 ? static_cast<int>(std::min(cell, cells - 1.0)) : 0;
  };
  return step(place.y(), kRows, height_px_) * kColumns + step(place.x(), kColumns, width_px_);
}

/// The pixels of a cell that have room for a reference patch around them.
PixelRect NewCorners::searched_part(int cell) const {
  constexpr int kBorder = ReferencePatch::kRadius;
  const int column = cell % kColumns, row = cell / kColumns;
  const int u = std::max(column * width_px_ / kColumns, kBorder);
  const int v = std::max(row * height_px_ / kRows, kBorder);
  return {u, v, std::min((column + 1) * width_px_ / kColumns, width_px_ - kBorder) - u,
          std::min((row + 1) * height_px_ / kRows, height_px_ - kBorder) - v};
}

bool NewCorners::is_far(const Corner& corner, std::span<const Eigen::Vector2d> features) const {
  const Eigen::Vector2d place(corner.u, corner.v);
  const auto is_away = [&](const Eigen::Vector2d& other) {
    return (other - place).squaredNorm() >= kMinDistance_px * kMinDistance_px;
  };
  return std::ranges::all_of(features, is_away) && std::ranges::all_of(found_, [&](const Corner& c) {
           return is_away({c.u, c.v});
         });
}

/// Keeps the strongest few, in order.
void NewCorners::rank(const Corner& corner) {
  const auto key = [](const Corner& c) { return std::tuple(-c.score, c.v, c.u); };
  strongest_.insert(std::ranges::upper_bound(strongest_, key(corner), {}, key), corner);
  if (strongest_.size() > kRanked) strongest_.pop_back();
}

void NewCorners::add_best(const ImageView& image, const PixelRect& part,
                          std::span<const Eigen::Vector2d> features) {
  strongest_.clear();
  for (const Corner& corner : detector_.detect(image, part))
    if (strongest_.size() < kRanked || corner.score > strongest_.back().score)
      if (is_far(corner, features)) rank(corner);
  double most = 0.0;
  const Corner* best = nullptr;
  for (const Corner& corner : strongest_) {
    const double texture = shi_tomasi_score(image, corner.u, corner.v, patch_px_);
    if (texture <= most) continue;
    most = texture;
    best = &corner;
  }
  if (best != nullptr) found_.push_back(*best);
}

}  // namespace waymark::vision
