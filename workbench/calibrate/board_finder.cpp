#include "workbench/calibrate/board_finder.hpp"

#include <algorithm>

#include "workbench/calibrate/opencv.hpp"

namespace waymark::calibrate {
namespace {

/// OpenCV numbers its dictionaries in our order.
int opencv_number(const markers::MarkerDictionary& dictionary) {
  const auto all = markers::marker_dictionaries();
  return static_cast<int>(std::ranges::find(all, dictionary.name, &markers::MarkerDictionary::name) -
                          all.begin());
}

}  // namespace

Result<std::unique_ptr<BoardFinder>> make_board_finder(const Board& board) {
  const auto opencv = load_opencv("finding a board in images");
  if (!opencv) return opencv.error();
  return board.kind == BoardKind::kCharuco
             ? (*opencv)->make_charuco_finder(board, opencv_number(board.dictionary))
             : (*opencv)->make_chessboard_finder(board.corners);
}

std::optional<GridSize> guess_chessboard(const ImageView& image) {
  const auto opencv = load_opencv("guessing a board");
  return opencv ? (*opencv)->guess_chessboard(image) : std::nullopt;
}

}  // namespace waymark::calibrate
