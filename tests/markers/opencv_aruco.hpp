#pragma once

#include <algorithm>
#include <vector>

#include <opencv2/aruco.hpp>
#include <opencv2/imgproc.hpp>

#include "waymark/markers/marker_detector.hpp"

namespace waymark::test {

/// OpenCV numbers its dictionaries in our order.
inline cv::Ptr<cv::aruco::Dictionary> opencv_dictionary(const markers::MarkerDictionary& dictionary) {
  const auto all = markers::marker_dictionaries();
  const auto place = std::ranges::find(all, dictionary.name, &markers::MarkerDictionary::name) - all.begin();
  return cv::aruco::getPredefinedDictionary(static_cast<int>(place));
}

/// The markers that OpenCV finds: by its own thresholds, and in small images once more at twice their size
/// with one narrow window, since markers of a few pixels are smaller than its windows.
class OpenCvAruco {
 public:
  explicit OpenCvAruco(const markers::MarkerDictionary& dictionary)
      : dictionary_(opencv_dictionary(dictionary)) {
    cv::setNumThreads(1);
    narrow_->adaptiveThreshWinSizeMin = narrow_->adaptiveThreshWinSizeMax = 11;
  }

  [[nodiscard]] std::vector<markers::Marker> detect(const ImageView& image) {
    const cv::Mat pixels(image.height_px, image.width_px, CV_8UC1, const_cast<std::uint8_t*>(image.data),
                         static_cast<std::size_t>(image.stride));
    std::vector<markers::Marker> found = find(pixels, *usual_, 1.0);
    if (pixels.total() > 800 * 600) return found;
    cv::resize(pixels, enlarged_, {}, 2.0, 2.0, cv::INTER_LINEAR);
    for (const auto& more : find(enlarged_, *narrow_, 2.0))
      if (std::ranges::none_of(found, [&](const auto& each) { return are_one(each, more); }))
        found.push_back(more);
    return found;
  }

  /// The same identity at the same place.
  [[nodiscard]] static bool are_one(const markers::Marker& a, const markers::Marker& b) {
    const double diagonal_px = (a.corners_px[2] - a.corners_px[0]).norm();
    return a.id == b.id && (a.corners_px[0] - b.corners_px[0]).norm() < 0.5 * diagonal_px;
  }

 private:
  /// Pixels of an enlarged image count from their centres, too.
  [[nodiscard]] std::vector<markers::Marker> find(const cv::Mat& pixels,
                                                  const cv::aruco::DetectorParameters& parameters,
                                                  double enlarged) const {
    std::vector<std::vector<cv::Point2f>> corners;
    std::vector<int> ids;
    cv::aruco::detectMarkers(pixels, dictionary_, corners, ids,
                             cv::makePtr<cv::aruco::DetectorParameters>(parameters));
    std::vector<markers::Marker> found;
    for (std::size_t i = 0; i < ids.size(); ++i) {
      markers::Corners corners_px;
      for (std::size_t k = 0; k < 4; ++k)
        corners_px[k] = (Eigen::Vector2d(corners[i][k].x, corners[i][k].y).array() + 0.5) / enlarged - 0.5;
      found.push_back({ids[i], corners_px});
    }
    return found;
  }

  cv::Ptr<cv::aruco::Dictionary> dictionary_;
  cv::Ptr<cv::aruco::DetectorParameters> usual_ = cv::aruco::DetectorParameters::create();
  cv::Ptr<cv::aruco::DetectorParameters> narrow_ = cv::aruco::DetectorParameters::create();
  cv::Mat enlarged_;
};

}  // namespace waymark::test
