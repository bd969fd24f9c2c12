#pragma once

#include <optional>

#include "waymark/calibrate/board.hpp"

namespace waymark::calibrate {

/// The homography that takes places on the board, m, to pixels: least squares over scaled points (Hartley and
/// Zisserman, "Multiple View Geometry", algorithm 4.2). Nothing for fewer than four corners, or corners on a
/// line.
[[nodiscard]] std::optional<Eigen::Matrix3d> plane_homography(const Board& board,
                                                              const BoardCorners& corners);

}  // namespace waymark::calibrate
