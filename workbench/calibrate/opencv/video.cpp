#include "workbench/calibrate/opencv/video.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

namespace waymark::calibrate::opencv {
namespace {

GreyImage grey(const cv::Mat& frame) {
  cv::Mat pixels = frame;
  if (frame.channels() == 3) cv::cvtColor(frame, pixels, cv::COLOR_BGR2GRAY);
  GreyImage image(pixels.cols, pixels.rows);
  for (int v = 0; v < pixels.rows; ++v)
    std::memcpy(image.data() + v * image.stride(), pixels.ptr(v), static_cast<std::size_t>(pixels.cols));
  return image;
}

class Video final : public ImageSource {
 public:
  explicit Video(const cv::VideoCapture& capture)
      : capture_(capture), frames_(capture_.get(cv::CAP_PROP_FRAME_COUNT)) {
    const double rate_hz = capture_.get(cv::CAP_PROP_FPS);
    if (std::isfinite(rate_hz)) every_ = std::max(1, static_cast<int>(rate_hz / kFramesPerSecond));
  }

  Result<std::optional<NamedImage>> next() override {
    try {
      while (capture_.grab()) {
        if (frame_++ % every_ != 0) continue;
        cv::Mat pixels;
        if (!capture_.retrieve(pixels) || pixels.empty()) continue;
        return std::optional(NamedImage{fmt::format("frame {}", frame_ - 1), grey(pixels)});
      }
    } catch (const cv::Exception& problem) {
      return Error{fmt::format("frame {}: {}", frame_, problem.err)};
    }
    return std::optional<NamedImage>{};
  }

  [[nodiscard]] double progress() const override {
    return frames_ > 0.0 ? std::min(1.0, static_cast<double>(frame_) / frames_) : 0.0;
  }
  [[nodiscard]] bool is_stream() const override { return true; }

 private:
  cv::VideoCapture capture_;
  double frames_;
  int every_ = 1;
  int frame_ = 0;
};

}  // namespace

std::unique_ptr<ImageSource> open_video(const std::filesystem::path& path) {
  cv::VideoCapture capture;
  try {
    if (capture.open(path.string(), cv::CAP_FFMPEG)) return std::make_unique<Video>(capture);
  } catch (const cv::Exception&) {
    // The same as a file that no decoder knows.
  }
  return nullptr;
}

}  // namespace waymark::calibrate::opencv
