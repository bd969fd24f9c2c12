#include "waymark/vision/search.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include <Eigen/LU>

#include "waymark/core/angle.hpp"
#include "waymark/core/chi2.hpp"

namespace waymark::vision {
namespace {

using kernels::WindowRow;

/// Whole numbers from low to high that are also in [least, most]; none where the order is wrong.
WindowRow whole_numbers(double low, double high, int least, int most) {
  const double first = std::max(std::ceil(low), static_cast<double>(least));
  const double last = std::min(std::floor(high), static_cast<double>(most));
  if (!(first <= last)) return {};
  return {static_cast<int>(first), static_cast<int>(last - first) + 1};
}

bool is_positive_definite(const Eigen::Matrix2d& S) {
  return S.allFinite() && S(0, 0) > 0.0 && S.determinant() > 0.0;
}

}  // namespace

void find_ellipse_rows(const ImageView& image, const Eigen::Vector2d& centre, const Eigen::Matrix2d& S,
                       double gate, int patch_size, EllipseRows& ellipse) {
  const int before = before_place(patch_size), from = from_place(patch_size);
  const Eigen::Matrix2d W = S.inverse();
  const double half_height = std::sqrt(gate * S(1, 1));
  const WindowRow height =
      whole_numbers(centre.y() - half_height, centre.y() + half_height, before, image.height_px - from);
  ellipse.first_row = height.first;
  ellipse.rows.clear();
  ellipse.windows = 0;
  for (int v = height.first; v < height.first + height.count; ++v) {
    // W_xx dx^2 + 2 W_xy dx dy + W_yy dy^2 = gate
    const double dy = v - centre.y();
    const double root = std::sqrt(std::max((gate - dy * dy / S(1, 1)) / W(0, 0), 0.0));
    const double middle = centre.x() - W(0, 1) * dy / W(0, 0);
    ellipse.rows.push_back(whole_numbers(middle - root, middle + root, before, image.width_px - from));
    ellipse.windows += ellipse.rows.back().count;
  }
}

double expected_zmssd(const Patch& patch, double grey_sigma) {
  std::int64_t gradients = 0;  // squares of central differences, twice the gradient
  for (int row = 1; row + 1 < patch.size; ++row) {
    for (int column = 1; column + 1 < patch.size; ++column) {
      const int gu = patch(column + 1, row) - patch(column - 1, row);
      const int gv = patch(column, row + 1) - patch(column, row - 1);
      gradients += gu * gu + gv * gv;
    }
  }
  const double inner = (patch.size - 2) * (patch.size - 2), all = patch.size * patch.size;
  return 2.0 * grey_sigma * grey_sigma * (all - 1.0) +
         static_cast<double>(gradients) / 4.0 / 12.0 * all / inner;
}

struct Search::Task {
  ImageView image;
  const Patch& patch;
  kernels::ZmssdPatch zmssd_patch;
  Eigen::Vector2d predicted;
  Eigen::Matrix2d S;
  Eigen::Matrix2d W;  ///< S^-1

  [[nodiscard]] double distance2(int u, int v) const {
    const Eigen::Vector2d d(u - predicted.x(), v - predicted.y());
    return d.dot(W * d);
  }
};

Search::Search(const SearchOptions& options)
    : options_(options),
      gate_(chi2_quantile(options.probability, 2.0)),
      zmssd_search_(kernels::zmssd_search_by(options.instructions)),
      detector_(options.corners) {}

void Search::reserve(int width_px, int height_px) {
  const auto pixels = static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px);
  detector_.reserve(width_px, height_px);
  ellipse_.rows.reserve(static_cast<std::size_t>(height_px));
  scores_.resize(std::max(scores_.size(), std::min(pixels, static_cast<std::size_t>(options_.max_windows))));
  strongest_.reserve(pixels / 4);
}

double Search::expected_windows(const Eigen::Matrix2d& S) const {
  const double area = kPi * gate_ * std::sqrt(std::max(0.0, S.determinant()));
  return std::min(area, static_cast<double>(options_.max_windows));
}

std::optional<Match> Search::find(const ImageView& image, const Patch& patch,
                                  const Eigen::Vector2d& predicted, const Eigen::Matrix2d& S) {
  windows_ = 0;
  std::optional<Match> best;
  if (!is_positive_definite(S) || !predicted.allFinite()) return best;
  find_ellipse_rows(image, predicted, S, gate_, patch.size, ellipse_);
  const Task task{image, patch, patch.for_search(), predicted, S, S.inverse()};
  if (ellipse_.windows <= options_.max_windows)
    score_rows(task, ellipse_.first_row, ellipse_.rows.data(), ellipse_.rows.size(), best);
  else
    score_corners(task, best);
  if (!best) return best;
  best->accepted = best->zmssd <= options_.accept_ratio * expected_zmssd(patch, options_.grey_sigma);
  return best;
}

/// Around the strongest corners in the ellipse, since another view moves a corner by a pixel.
void Search::score_corners(const Task& task, std::optional<Match>& best) {
  constexpr int kSide = 3;
  int first = task.image.width_px, last = 0;
  for (const WindowRow& row : ellipse_.rows) {
    if (row.count == 0) continue;
    first = std::min(first, row.first);
    last = std::max(last, row.first + row.count);
  }
  const PixelRect box{first, ellipse_.first_row, last - first, static_cast<int>(ellipse_.rows.size())};
  strongest_.clear();
  for (const Corner& c : detector_.detect(task.image, box)) {
    const WindowRow& row = ellipse_.rows[static_cast<std::size_t>(c.v - ellipse_.first_row)];
    if (c.u >= row.first && c.u < row.first + row.count &&
        patch_fits(task.image, c.u, c.v, task.patch.size, 1))
      strongest_.push_back(c);
  }
  const auto most = static_cast<std::size_t>(options_.max_windows / (kSide * kSide));
  if (strongest_.size() > most) {
    std::ranges::sort(strongest_, [](const Corner& a, const Corner& b) {
      return std::tuple(b.score, a.v, a.u) < std::tuple(a.score, b.v, b.u);
    });
    strongest_.resize(most);
  }
  for (const Corner& c : strongest_) {
    const std::array<WindowRow, kSide> around{WindowRow{c.u - 1, kSide}, {c.u - 1, kSide}, {c.u - 1, kSide}};
    score_rows(task, c.v - 1, around.data(), around.size(), best);
  }
}

/// Scores the patch around every pixel of the rows and keeps the best.
void Search::score_rows(const Task& task, int first_row, const WindowRow* rows, std::size_t row_count,
                        std::optional<Match>& best) {
  std::size_t count = 0;
  for (std::size_t k = 0; k < row_count; ++k) count += static_cast<std::size_t>(rows[k].count);
  if (count == 0) return;
  windows_ += static_cast<std::int64_t>(count);
  if (scores_.size() < count) scores_.resize(count);
  const int before = before_place(task.patch.size);
  zmssd_search_(task.zmssd_patch, task.image.row(first_row - before) - before, task.image.stride, rows,
                row_count, scores_.data());
  const double zmssd_per_score = 1.0 / (task.patch.size * task.patch.size);
  const bool is_map = options_.match == MatchScore::kMap;
  const double weight = is_map ? 1.0 / (4.0 * options_.grey_sigma * options_.grey_sigma) : 1.0;
  const std::uint32_t* score = scores_.data();
  for (std::size_t k = 0; k < row_count; ++k) {
    const int v = first_row + static_cast<int>(k);
    for (int u = rows[k].first; u < rows[k].first + rows[k].count; ++u, ++score) {
      const double zmssd = *score * zmssd_per_score;
      if (best && weight * zmssd >= best->score) continue;  // no place makes it better than this
      const double distance2 = task.distance2(u, v);
      // Vincke (13)
      const double value = is_map ? weight * zmssd + 0.5 * distance2 : zmssd * std::exp(0.5 * distance2);
      if (!best || value < best->score) best = Match{u, v, zmssd, distance2, value};
    }
  }
}

}  // namespace waymark::vision
