#include "workbench/sim/canvas.hpp"

#include <algorithm>
#include <cmath>

namespace waymark::sim {

Canvas::Canvas(int log2_width, int log2_height, float grey)
    : log2_width_(log2_width),
      log2_height_(log2_height),
      grey_(std::size_t{1} << (log2_width + log2_height), grey) {}

void Canvas::fill(const Area& area, float grey) {
  for (int row = area.top; row < area.top + area.height; ++row)
    for (int column = area.left; column < area.left + area.width; ++column) at(column, row) = grey;
}

void Canvas::brighten(const Area& area, float by) {
  for (int row = area.top; row < area.top + area.height; ++row)
    for (int column = area.left; column < area.left + area.width; ++column) at(column, row) += by;
}

void Canvas::disc(float column, float row, float radius, float grey) {
  const auto first = [radius](float centre) { return static_cast<int>(std::floor(centre - radius)); };
  const auto last = [radius](float centre) { return static_cast<int>(std::ceil(centre + radius)); };
  for (int v = first(row); v <= last(row); ++v)
    for (int u = first(column); u <= last(column); ++u) {
      const float distance =
          std::hypot(static_cast<float>(u) + 0.5F - column, static_cast<float>(v) + 0.5F - row);
      const float part = std::clamp(radius + 0.5F - distance, 0.0F, 1.0F);
      at(u, v) += part * (grey - at(u, v));
    }
}

void Canvas::add_grain(int grain_width, int grain_height, float amplitude, RandomStream& random) {
  const int columns = width() / grain_width;
  const int rows = height() / grain_height;
  std::vector<float> knots;
  knots.reserve(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  for (int i = 0; i < columns * rows; ++i)
    knots.push_back(amplitude * static_cast<float>(random.uniform(-1.0, 1.0)));
  std::vector<float> line(static_cast<std::size_t>(columns) + 1);
  for (int v = 0; v < height(); ++v) {
    const float down = static_cast<float>(v % grain_height) / static_cast<float>(grain_height);
    const float* above = knots.data() + v / grain_height * columns;
    const float* below = knots.data() + (v / grain_height + 1) % rows * columns;
    for (int i = 0; i < columns; ++i)
      line[static_cast<std::size_t>(i)] = above[i] + down * (below[i] - above[i]);
    line.back() = line.front();
    float* out = &at(0, v);
    for (int i = 0; i < columns; ++i) {
      const float begin = line[static_cast<std::size_t>(i)];
      const float slope = (line[static_cast<std::size_t>(i) + 1] - begin) / static_cast<float>(grain_width);
      for (int k = 0; k < grain_width; ++k) *out++ += begin + static_cast<float>(k) * slope;
    }
  }
}

}  // namespace waymark::sim
