#pragma once

#include <memory>
#include <optional>

#include "workbench/calibrate/board_finder.hpp"

namespace waymark::calibrate::opencv {

/// By findChessboardCorners.
[[nodiscard]] std::unique_ptr<BoardFinder> make_chessboard_finder(GridSize corners);

/// By markers and interpolateCornersCharuco; `dictionary` is OpenCV's number of it.
[[nodiscard]] std::unique_ptr<BoardFinder> make_charuco_finder(const Board& board, int dictionary);

/// By findChessboardCornersSB.
[[nodiscard]] std::optional<GridSize> guess_chessboard(const ImageView& image);

}  // namespace waymark::calibrate::opencv
