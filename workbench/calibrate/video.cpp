#include "workbench/calibrate/video.hpp"

#include "workbench/calibrate/opencv.hpp"

namespace waymark::calibrate {

Result<std::unique_ptr<ImageSource>> open_video(const std::filesystem::path& path) {
  const auto opencv = load_opencv(path.string() + ": reading a video");
  if (!opencv) return opencv.error();
  if (auto video = (*opencv)->open_video(path)) return video;
  return Error{path.string() +
               " is neither an image (PNG, JPEG, PGM) nor a bag nor a video that can be decoded"};
}

}  // namespace waymark::calibrate
