#include "waymark/markers/aruco_detector.hpp"

#include <algorithm>
#include <tuple>

#include <opencv2/aruco.hpp>
#include <opencv2/imgproc.hpp>

namespace waymark::markers {
namespace {

/// OpenCV numbers its dictionaries in our order.
int opencv_number(const MarkerDictionary& dictionary) {
  const auto all = marker_dictionaries();
  return static_cast<int>(std::ranges::find(all, dictionary.name, &MarkerDictionary::name) - all.begin());
}

/// In small pictures small and slanted markers are a few pixels wide, less than OpenCV's windows.
constexpr int kSmallPicture_px = 800 * 600;
constexpr double kEnlarged = 2.0;
constexpr int kEnlargedWindow_px = 11;

cv::Ptr<cv::aruco::DetectorParameters> make_parameters() {
  auto parameters = cv::aruco::DetectorParameters::create();
  parameters->cornerRefinementMethod = cv::aruco::CORNER_REFINE_NONE;
  return parameters;
}

cv::Ptr<cv::aruco::DetectorParameters> make_enlarged_parameters() {
  auto parameters = make_parameters();
  parameters->adaptiveThreshWinSizeMin = parameters->adaptiveThreshWinSizeMax = kEnlargedWindow_px;
  return parameters;
}

/// From corners in a picture that was enlarged: pixels count from their centres.
Marker marker(std::int32_t id, const std::vector<cv::Point2f>& corners, double enlarged) {
  Marker found{id, {}};
  const double shift = 0.5 * (1.0 / enlarged - 1.0);
  for (std::size_t i = 0; i < 4; ++i)
    found.corners_px[i] =
        Eigen::Vector2d(corners[i].x, corners[i].y) / enlarged + Eigen::Vector2d(shift, shift);
  return found;
}

/// The same identity at the same place.
bool are_one(const Marker& a, const Marker& b) {
  const double side_px = (a.corners_px[2] - a.corners_px[0]).norm();
  return a.id == b.id && (a.corners_px[0] - b.corners_px[0]).norm() < side_px;
}

class ArucoDetector final : public MarkerDetector {
 public:
  explicit ArucoDetector(const MarkerDictionary& dictionary)
      : dictionary_(cv::aruco::getPredefinedDictionary(opencv_number(dictionary))) {
    cv::setNumThreads(1);
  }

  std::vector<Marker> detect(const ImageView& image) override {
    // OpenCV has no view of what must not be written to, but detection does not write.
    const cv::Mat pixels(image.height_px, image.width_px, CV_8UC1, const_cast<std::uint8_t*>(image.data),
                         static_cast<std::size_t>(image.stride));
    std::vector<Marker> found;
    try {
      found = find(pixels, parameters_, 1.0);
      if (pixels.total() <= kSmallPicture_px) add_from_enlarged(pixels, found);
    } catch (const cv::Exception&) {
      return {};  // a picture that it cannot digest shows no markers
    }
    std::ranges::sort(found, {}, [](const Marker& each) {
      return std::tuple(each.id, each.corners_px[0].x(), each.corners_px[0].y());
    });
    return found;
  }

 private:
  std::vector<Marker> find(const cv::Mat& pixels, const cv::Ptr<cv::aruco::DetectorParameters>& parameters,
                           double enlarged) const {
    std::vector<std::vector<cv::Point2f>> corners;
    std::vector<int> ids;
    cv::aruco::detectMarkers(pixels, dictionary_, corners, ids, parameters);
    std::vector<Marker> found;
    for (std::size_t i = 0; i < ids.size(); ++i) found.push_back(marker(ids[i], corners[i], enlarged));
    return found;
  }

  void add_from_enlarged(const cv::Mat& pixels, std::vector<Marker>& found) {
    cv::resize(pixels, enlarged_, {}, kEnlarged, kEnlarged, cv::INTER_LINEAR);
    for (const Marker& more : find(enlarged_, enlarged_parameters_, kEnlarged))
      if (std::ranges::none_of(found, [&](const Marker& each) { return are_one(each, more); }))
        found.push_back(more);
  }

  cv::Ptr<cv::aruco::Dictionary> dictionary_;
  cv::Ptr<cv::aruco::DetectorParameters> parameters_ = make_parameters();
  cv::Ptr<cv::aruco::DetectorParameters> enlarged_parameters_ = make_enlarged_parameters();
  cv::Mat enlarged_;
};

}  // namespace

Result<std::unique_ptr<MarkerDetector>> make_aruco_detector(const MarkerDictionary& dictionary) {
  return std::unique_ptr<MarkerDetector>(std::make_unique<ArucoDetector>(dictionary));
}

}  // namespace waymark::markers
