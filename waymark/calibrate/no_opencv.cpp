// What stands in for the parts that need OpenCV in a build without it.

#include "waymark/calibrate/board_finder.hpp"
#include "waymark/calibrate/video.hpp"

namespace waymark::calibrate {
namespace {

Error no_opencv(const char* what) {
  return {std::string(what) +
          " needs OpenCV, which this build of Waymark lacks: install libopencv-contrib-dev, "
          "libopencv-calib3d-dev and libopencv-videoio-dev, configure with WAYMARK_WITH_OPENCV=ON and build "
          "again"};
}

}  // namespace

Result<std::unique_ptr<BoardFinder>> make_board_finder(const Board& /*board*/) {
  return no_opencv("calibrate camera: finding a board in pictures");
}

std::optional<GridSize> guess_chessboard(const ImageView& /*image*/) { return std::nullopt; }

Result<std::unique_ptr<PictureSource>> open_video(const std::filesystem::path& path) {
  return no_opencv((path.string() + ": reading a video").c_str());
}

}  // namespace waymark::calibrate
