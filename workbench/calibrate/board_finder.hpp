#pragma once

#include <memory>
#include <optional>

#include "waymark/core/grey_image.hpp"
#include "waymark/core/result.hpp"

#include "workbench/calibrate/board.hpp"

namespace waymark::calibrate {

/// Finds the inner corners of one board, to parts of a pixel. Not to be called from two threads at once.
class BoardFinder {
 public:
  BoardFinder() = default;
  BoardFinder(const BoardFinder&) = delete;
  BoardFinder& operator=(const BoardFinder&) = delete;
  virtual ~BoardFinder() = default;

  /// In the order of their indices; a chessboard's corners are found all or not at all, those of a ChArUco
  /// board as far as they are seen. Nothing where there is no board. 5 to 100 ms for 640 x 480 pixels.
  [[nodiscard]] virtual std::optional<BoardCorners> find(const ImageView& image) = 0;
};

/// A finder, or that OpenCV's module is missing.
[[nodiscard]] Result<std::unique_ptr<BoardFinder>> make_board_finder(const Board& board);

/// The inner corners of the largest chessboard in an image, the longer side first; nothing where there is
/// none, or without OpenCV's module. Some 20 ms.
[[nodiscard]] std::optional<GridSize> guess_chessboard(const ImageView& image);

}  // namespace waymark::calibrate
