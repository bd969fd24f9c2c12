#include "waymark/markers/aruco_detector.hpp"

#include <algorithm>
#include <tuple>

#include <opencv2/aruco.hpp>

namespace waymark::markers {
namespace {

/// OpenCV numbers its dictionaries in our order.
int opencv_number(const MarkerDictionary& dictionary) {
  const auto all = marker_dictionaries();
  return static_cast<int>(std::ranges::find(all, dictionary.name, &MarkerDictionary::name) - all.begin());
}

Marker marker(std::int32_t id, const std::vector<cv::Point2f>& corners) {
  Marker found{id, {}};
  for (std::size_t i = 0; i < 4; ++i) found.corners_px[i] = {corners[i].x, corners[i].y};
  return found;
}

class ArucoDetector final : public MarkerDetector {
 public:
  explicit ArucoDetector(const MarkerDictionary& dictionary)
      : dictionary_(cv::aruco::getPredefinedDictionary(opencv_number(dictionary))),
        parameters_(cv::aruco::DetectorParameters::create()) {
    cv::setNumThreads(1);
    parameters_->cornerRefinementMethod = cv::aruco::CORNER_REFINE_NONE;
  }

  std::vector<Marker> detect(const ImageView& image) override {
    // OpenCV has no view of what must not be written to, but detection does not write.
    const cv::Mat pixels(image.height_px, image.width_px, CV_8UC1, const_cast<std::uint8_t*>(image.data),
                         static_cast<std::size_t>(image.stride));
    std::vector<std::vector<cv::Point2f>> corners;
    std::vector<int> ids;
    try {
      cv::aruco::detectMarkers(pixels, dictionary_, corners, ids, parameters_);
    } catch (const cv::Exception&) {
      return {};  // a picture that it cannot digest shows no markers
    }
    std::vector<Marker> found;
    for (std::size_t i = 0; i < ids.size(); ++i) found.push_back(marker(ids[i], corners[i]));
    std::ranges::sort(found, {}, [](const Marker& each) {
      return std::tuple(each.id, each.corners_px[0].x(), each.corners_px[0].y());
    });
    return found;
  }

 private:
  cv::Ptr<cv::aruco::Dictionary> dictionary_;
  cv::Ptr<cv::aruco::DetectorParameters> parameters_;
};

}  // namespace

Result<std::unique_ptr<MarkerDetector>> make_aruco_detector(const MarkerDictionary& dictionary) {
  return std::unique_ptr<MarkerDetector>(std::make_unique<ArucoDetector>(dictionary));
}

}  // namespace waymark::markers
