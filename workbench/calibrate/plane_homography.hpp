#pragma once

#include <optional>

#include "workbench/calibrate/board.hpp"

namespace waymark::calibrate {

/// The homography that takes places on the board, m, to pixels. Nothing for fewer than four corners, or
/// corners on a line.
[[nodiscard]] std::optional<Eigen::Matrix3d> plane_homography(const Board& board,
                                                              const BoardCorners& corners);

}  // namespace waymark::calibrate
