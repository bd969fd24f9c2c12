#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "workbench/calibrate/board_finder.hpp"
#include "workbench/calibrate/image_source.hpp"

namespace waymark::calibrate {

/// What only OpenCV can do, the functions of the module waymark-opencv.so.
struct OpenCv {
  std::unique_ptr<BoardFinder> (*make_chessboard_finder)(GridSize corners);
  /// `dictionary` is OpenCV's number of the board's.
  std::unique_ptr<BoardFinder> (*make_charuco_finder)(const Board& board, int dictionary);
  std::optional<GridSize> (*guess_chessboard)(const ImageView& image);
  /// Null where it knows no such video.
  std::unique_ptr<ImageSource> (*open_video)(const std::filesystem::path& path);
};

/// Loads the module; an error, that `what` needs it and how to get it, where it is not there.
[[nodiscard]] Result<const OpenCv*> load_opencv(const std::string& what);

}  // namespace waymark::calibrate
