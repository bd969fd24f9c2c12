#include "workbench/calibrate/edge_width.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <vector>

#include "workbench/eval/median.hpp"

namespace waymark::calibrate {
namespace {

using Eigen::Vector2d;

constexpr double kStep_px = 0.25;
constexpr double kReach = 0.35;  // of a square: how far across its edge one looks
constexpr int kMinContrast = 16;

std::optional<double> grey(const ImageView& image, const Vector2d& p) {
  const int u = static_cast<int>(std::floor(p.x())), v = static_cast<int>(std::floor(p.y()));
  if (u < 0 || v < 0 || u + 1 >= image.width_px || v + 1 >= image.height_px) return std::nullopt;
  const double a = p.x() - u, b = p.y() - v;
  return (1 - b) * ((1 - a) * image(u, v) + a * image(u + 1, v)) +
         b * ((1 - a) * image(u, v + 1) + a * image(u + 1, v + 1));
}

/// Where a rising profile passes `level` for the last time from below, in steps.
double crossing(const std::vector<double>& profile, double level) {
  for (std::size_t i = profile.size() - 1; i > 0; --i)
    if (profile[i - 1] < level && profile[i] >= level)
      return static_cast<double>(i - 1) + (level - profile[i - 1]) / (profile[i] - profile[i - 1]);
  return 0.0;
}

/// Across the middle of the edge from `a` to `b`.
std::optional<double> width_of_edge(const ImageView& image, const Vector2d& a, const Vector2d& b) {
  const Vector2d along = b - a;
  const Vector2d across = Vector2d(-along.y(), along.x()).normalized();
  const int steps = static_cast<int>(kReach * along.norm() / kStep_px);
  std::vector<double> profile;
  for (int i = -steps; i <= steps; ++i) {
    const auto value = grey(image, a + 0.5 * along + i * kStep_px * across);
    if (!value) return std::nullopt;
    profile.push_back(*value);
  }
  if (profile.size() < 5) return std::nullopt;
  if (profile.front() > profile.back()) std::ranges::reverse(profile);
  const double dark = profile.front(), rise = profile.back() - dark;
  if (rise < kMinContrast) return std::nullopt;
  return kStep_px * (crossing(profile, dark + 0.9 * rise) - crossing(profile, dark + 0.1 * rise));
}

}  // namespace

double edge_width_px(const ImageView& image, const Board& board, const BoardCorners& corners) {
  std::map<int, Vector2d> places;
  for (const auto& [index, pixel] : corners) places.emplace(index, pixel);
  std::vector<double> along_rows, along_columns;
  const auto judge = [&](const Vector2d& from, int to, std::vector<double>& widths) {
    const auto end = places.find(to);
    if (end == places.end()) return;
    if (const auto width = width_of_edge(image, from, end->second)) widths.push_back(*width);
  };
  for (const auto& [index, pixel] : places) {
    if ((index + 1) % board.corners.columns != 0) judge(pixel, index + 1, along_rows);
    judge(pixel, index + board.corners.columns, along_columns);
  }
  return std::max(eval::median(std::move(along_rows)).value_or(0.0),
                  eval::median(std::move(along_columns)).value_or(0.0));
}

}  // namespace waymark::calibrate
