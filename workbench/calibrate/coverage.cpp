#include "workbench/calibrate/coverage.hpp"

#include <algorithm>
#include <array>

namespace waymark::calibrate {
namespace {

/// Which cells have corners in them, row by row.
std::vector<bool> filled_cells(const std::vector<BoardView>& views, ImageSize size, int columns, int rows) {
  std::vector<bool> filled(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), false);
  for (const BoardView& view : views) {
    if (view.fate != Fate::kUsed) continue;
    for (const auto& [index, pixel] : view.corners) {
      const int column = std::clamp(static_cast<int>(pixel.x() * columns / size.width_px), 0, columns - 1);
      const int row = std::clamp(static_cast<int>(pixel.y() * rows / size.height_px), 0, rows - 1);
      const int cell = row * columns + column;
      filled[static_cast<std::size_t>(cell)] = true;
    }
  }
  return filled;
}

}  // namespace

double covered_part(const std::vector<BoardView>& views, ImageSize size) {
  constexpr int kColumns = 8, kRows = 6;
  const auto filled = filled_cells(views, size, kColumns, kRows);
  return static_cast<double>(std::ranges::count(filled, true)) / (kColumns * kRows);
}

std::vector<std::string> empty_ninths(const std::vector<BoardView>& views, ImageSize size) {
  static constexpr std::array kNames{"upper left", "top",        "upper right", "left",       "middle",
                                     "right",      "lower left", "bottom",      "lower right"};
  const auto filled = filled_cells(views, size, 3, 3);
  std::vector<std::string> names;
  for (std::size_t i = 0; i < kNames.size(); ++i)
    if (!filled[i]) names.emplace_back(kNames[i]);
  return names;
}

}  // namespace waymark::calibrate
