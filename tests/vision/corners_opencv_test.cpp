// Holds the detector against OpenCV's, point by point and response by response.
#include <gtest/gtest.h>
#include <opencv2/features2d.hpp>

#include "waymark/vision/corners.hpp"

#include "photographs.hpp"

namespace waymark::vision {
namespace {

std::vector<Corner> opencv_corners(const ImageView& image, int threshold) {
  const cv::Mat pixels(image.height_px, image.width_px, CV_8U, const_cast<std::uint8_t*>(image.data),
                       static_cast<std::size_t>(image.stride));
  std::vector<cv::KeyPoint> points;
  cv::FAST(pixels, points, threshold, true, cv::FastFeatureDetector::TYPE_9_16);
  std::vector<Corner> corners;
  for (const cv::KeyPoint& p : points)
    corners.push_back(
        {static_cast<int>(p.pt.x), static_cast<int>(p.pt.y), static_cast<std::uint8_t>(p.response)});
  return corners;
}

TEST(CornersAgainstOpenCv, AreTheSamePointsWithTheSameResponses) {
  WAYMARK_REQUIRE_DATA("gray-images");
  for (const std::string& name : test::photograph_names()) {
    const GreyImage image = test::photograph(name);
    for (const int threshold : {5, 20, 50}) {
      CornerDetector detector({.threshold = threshold, .arc = 9});
      EXPECT_EQ(detector.detect(image), opencv_corners(image, threshold)) << name << " at " << threshold;
    }
  }
}

TEST(CornersAgainstOpenCv, AreTheSameInAPartOfAnImageAndInASmallOne) {
  WAYMARK_REQUIRE_DATA("gray-images");
  const GreyImage image = test::photograph("graf1.png");
  for (const auto& [width_px, height_px] : {std::pair{320, 240}, {65, 31}, {23, 9}, {7, 7}, {6, 6}}) {
    const ImageView part = image.view().part(211, 133, width_px, height_px);
    CornerDetector detector({.threshold = 10, .arc = 9});
    EXPECT_EQ(detector.detect(part), opencv_corners(part, 10)) << width_px << " x " << height_px;
  }
}

}  // namespace
}  // namespace waymark::vision
