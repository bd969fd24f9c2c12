#include "waymark/markers/black_border.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/LU>

#include "waymark/markers/homography.hpp"

namespace waymark::markers {
namespace {

constexpr int kContrastMin_grey = 12;
// Part of the cells that may be on the wrong side: hidden, in glare, or cut off.
constexpr double kWrongMax = 0.15;

/// The greys in the middles of the cells of a square ring, `side` cells long, about the middle.
std::vector<int> ring_greys(const ImageView& image, const Eigen::Matrix3d& H, int side) {
  std::vector<int> greys;
  const double first = -0.5 * (side - 1);
  const auto look = [&](int column, int row) {
    const Eigen::Vector3d p = H * Eigen::Vector3d(first + column, first + row, 1.0);
    const auto u = std::lround(p.x() / p.z()), v = std::lround(p.y() / p.z());
    if (p.z() > 0.0 && u >= 0 && v >= 0 && u < image.width_px && v < image.height_px)
      greys.push_back(image(static_cast<int>(u), static_cast<int>(v)));
  };
  for (int i = 0; i + 1 < side; ++i) {
    look(i, 0);
    look(side - 1, i);
    look(side - 1 - i, side - 1);
    look(0, side - 1 - i);
  }
  return greys;
}

int median(std::vector<int> values) {
  const auto middle = values.begin() + std::ssize(values) / 2;
  std::ranges::nth_element(values, middle);
  return *middle;
}

}  // namespace

bool has_black_border(const ImageView& image, const Corners& corners_px, int cells) {
  const auto H = homography_of_square(corners_px, cells);
  if (!H) return false;
  const std::vector<int> border = ring_greys(image, *H, cells), paper = ring_greys(image, *H, cells + 2);
  if (border.empty() || paper.empty()) return false;
  const int black = median(border), white = median(paper);
  if (white - black < kContrastMin_grey) return false;
  const int between = (black + white) / 2;
  const auto too_bright = std::ranges::count_if(border, [&](int grey) { return grey >= between; });
  const auto too_dark = std::ranges::count_if(paper, [&](int grey) { return grey <= between; });
  return static_cast<double>(too_bright) <= kWrongMax * static_cast<double>(border.size()) &&
         static_cast<double>(too_dark) <= kWrongMax * static_cast<double>(paper.size());
}

}  // namespace waymark::markers
