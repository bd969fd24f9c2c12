#include "workbench/calibrate/board.hpp"

#include <charconv>
#include <cmath>

#include <fmt/format.h>

namespace waymark::calibrate {
namespace {

constexpr int kSideMax = 100;

std::optional<int> parse_side(std::string_view text) {
  int value = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, value);
  return error == std::errc{} && rest == end && value >= 2 && value <= kSideMax ? std::optional(value)
                                                                                : std::nullopt;
}

Result<Board> make_chessboard(const BoardRequest& request) {
  if (!request.squares.empty() || !request.dictionary.empty() || request.marker_m != 0.0)
    return Error{
        "--squares, --marker_m and --dictionary describe a ChArUco board: add --board charuco, or give only "
        "--corners"};
  const bool has_scale = request.square_m > 0.0;
  Board board{.square_m = has_scale ? request.square_m : 1.0, .has_scale = has_scale};
  if (request.corners.empty()) return board;
  const auto corners = parse_grid_size(request.corners);
  if (!corners || corners->columns < 3 || corners->rows < 3)
    return Error{
        fmt::format("--corners {}: expected the inner corners of the chessboard (where four squares "
                    "meet) as COLUMNSxROWS from 3x3 to {}x{}, for example 9x6",
                    request.corners, kSideMax, kSideMax)};
  board.corners = *corners;
  return board;
}

Result<Board> make_charuco(const BoardRequest& request) {
  if (!request.corners.empty())
    return Error{"--corners describes a chessboard; for a ChArUco board give --squares, for example 5x7"};
  const auto squares = parse_grid_size(request.squares);
  if (!squares || squares->columns < 3 || squares->rows < 3)
    return Error{
        fmt::format("--squares {}: a ChArUco board needs its number of squares as COLUMNSxROWS from "
                    "3x3 to {}x{}, for example 5x7",
                    request.squares, kSideMax, kSideMax)};
  const bool markers_fit = request.marker_m > 0.0 && request.square_m > request.marker_m;
  if (!markers_fit)
    return Error{
        "--square_m and --marker_m: a ChArUco board needs the sides of its squares and, smaller, of its "
        "markers in metres, for example --square_m 0.04 --marker_m 0.02"};
  if (request.dictionary.empty())
    return Error{"--dictionary: a ChArUco board needs the dictionary of its markers, for example 5x5_50"};
  const auto dictionary = markers::find_marker_dictionary(request.dictionary);
  if (!dictionary) return dictionary.error();
  if (dictionary->kind != markers::MarkerKind::kAruco)
    return Error{fmt::format("--dictionary {}: a ChArUco board has ArUco markers, for example 5x5_50",
                             request.dictionary)};
  if (dictionary->size < squares->columns * squares->rows / 2)
    return Error{fmt::format("--dictionary {}: has {} markers, a board of {} squares {}", request.dictionary,
                             dictionary->size, request.squares, squares->columns * squares->rows / 2)};
  return Board{BoardKind::kCharuco, {squares->columns - 1, squares->rows - 1},
               request.square_m,    true,
               request.marker_m,    *dictionary};
}

}  // namespace

std::optional<GridSize> parse_grid_size(std::string_view text) {
  const std::size_t x = text.find_first_of("xX");
  if (x == std::string_view::npos) return std::nullopt;
  const auto columns = parse_side(text.substr(0, x)), rows = parse_side(text.substr(x + 1));
  return columns && rows ? std::optional(GridSize{*columns, *rows}) : std::nullopt;
}

Eigen::Vector2d Board::corner_m(int index) const {
  const int column = index % corners.columns, row = index / corners.columns;
  return {square_m * column, square_m * row};
}

Result<Board> make_board(const BoardRequest& request) {
  if (!std::isfinite(request.square_m) || request.square_m < 0.0)
    return Error{"--square_m: the side of a square must be above 0 m"};
  if (request.kind == "chessboard") return make_chessboard(request);
  if (request.kind == "charuco") return make_charuco(request);
  return Error{fmt::format("--board {}: expected chessboard or charuco", request.kind)};
}

std::string describe(const Board& board) {
  const auto& [columns, rows] = board.corners;
  if (board.kind == BoardKind::kChessboard)
    return fmt::format("chessboard with {}x{} inner corners", columns, rows);
  return fmt::format("ChArUco board of {}x{} squares with {} markers", columns + 1, rows + 1,
                     board.dictionary.name);
}

}  // namespace waymark::calibrate
