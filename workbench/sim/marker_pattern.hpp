#pragma once

#include "workbench/sim/canvas.hpp"

namespace waymark::sim {

/// Numbers of the markers that the simulator can print: those of ArUco's dictionary 4x4_50.
inline constexpr int kMarkerPatterns = 50;
/// Cells along a side: four bits between black borders, and white paper around them.
inline constexpr int kMarkerCells = 8;
/// Cells along the side of the black square, which is the size of a marker.
inline constexpr int kMarkerBlackCells = 6;
/// Texels along a cell.
inline constexpr int kTexelsPerMarkerCell = 32;

/// Is a cell of marker `number` white? Cells from the upper left.
[[nodiscard]] bool is_white(int number, int column, int row);

/// The marker on its paper: kMarkerCells * kTexelsPerMarkerCell texels along a side.
[[nodiscard]] Canvas paint_marker(int number);

}  // namespace waymark::sim
