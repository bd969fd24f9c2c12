#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "waymark/core/result.hpp"
#include "waymark/markers/marker_dictionary.hpp"

namespace waymark::calibrate {

struct GridSize {
  int columns = 0;
  int rows = 0;

  friend bool operator==(const GridSize&, const GridSize&) = default;
};

/// "9x6"; nothing for anything else.
[[nodiscard]] std::optional<GridSize> parse_grid_size(std::string_view text);

enum class BoardKind { kChessboard, kCharuco };

/// A flat pattern whose inner corners are at known places.
struct Board {
  BoardKind kind = BoardKind::kChessboard;
  GridSize corners;       ///< where four squares meet
  double square_m = 1.0;  ///< side
  bool has_scale = true;  ///< else nobody said how large they are, and lengths are in squares
  double marker_m = 0.0;  ///< side of the markers of a ChArUco board
  markers::MarkerDictionary dictionary{};  ///< of these

  [[nodiscard]] int size() const { return corners.columns * corners.rows; }
  /// Of an inner corner, row by row, on the board's plane: x along the rows.
  [[nodiscard]] Eigen::Vector2d corner_m(int index) const;
};

/// What a user says about a board; the keys of errors are those of the command line.
struct BoardRequest {
  std::string kind = "chessboard";
  std::string corners;  ///< "9x6", of a chessboard
  std::string squares;  ///< "5x7", of a ChArUco board
  double square_m = 0.0;
  double marker_m = 0.0;
  std::string dictionary;
};

/// A chessboard may come without its corners, which an image of it tells.
[[nodiscard]] Result<Board> make_board(const BoardRequest& request);

/// "chessboard with 9x6 inner corners".
[[nodiscard]] std::string describe(const Board& board);

/// A corner that was found in an image.
struct BoardCorner {
  int index = 0;
  Eigen::Vector2d pixel;  ///< the centre of the first pixel is at (0, 0)
};
using BoardCorners = std::vector<BoardCorner>;

}  // namespace waymark::calibrate
