#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "workbench/calibrate/board_finder.hpp"
#include "workbench/calibrate/camera_fit.hpp"
#include "workbench/calibrate/image_source.hpp"
#include "workbench/logs/image_file.hpp"

namespace waymark::calibrate {

/// What became of an image.
enum class Fate { kUsed, kUnreadable, kOtherSize, kNoBoard, kFewCorners, kAlike, kBlurred, kOutlier };

/// "used", "no board", ...
[[nodiscard]] const char* name_of(Fate fate);

/// An image, and what it says of the board.
struct BoardView {
  std::string name;
  ImageSize size;
  GreyImage small;    ///< the image reduced for showing; empty where it is not shown
  int reduction = 1;  ///< how many pixels of the image are one of the small one
  BoardCorners corners;
  double edge_px = 0.0;  ///< see edge_width_px()
  Fate fate = Fate::kUsed;
  std::string why;               ///< it is not used
  FittedView fit;                ///< of those used, and of those left out by what the others say
  double held_out_rms_px = 0.0;  ///< by a camera that was fitted without this view

  [[nodiscard]] bool is_shown() const { return small.width_px() > 0; }
};

/// The view of an image, its fate open unless there is no board in it.
[[nodiscard]] BoardView measure_view(const NamedImage& frame, const Board& board, BoardFinder& finder);

/// Looks for the board in every image. Of a stream, a view in which the board lies as in one before (its
/// corners within 4 % of the image's width, on average) is kept by name only, and so is one without a
/// board. `keep_going` is asked with the part done; false ends it with an error.
[[nodiscard]] Result<std::vector<BoardView>> collect_views(
    ImageSource& images, const Board& board, BoardFinder& finder,
    const std::function<bool(double)>& keep_going = {});

/// The inner corners of the chessboard that most of the first images show, two of them at least.
[[nodiscard]] std::optional<GridSize> guess_chessboard(ImageSource& images);

}  // namespace waymark::calibrate
