#include <cmath>

#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>

#include "photographed_board.hpp"
#include "workbench/calibrate/camera_fit.hpp"

namespace waymark::calibrate {
namespace {

TEST(CameraFit, IsThatOfOpenCv) {
  const Board board = test::chessboard();
  const auto views = test::photograph(board, test::true_camera(), 12, 0.3, 2);
  const auto fit = fit_camera(board, views, {640, 480}, Lens::kFourTerms);
  ASSERT_TRUE(fit) << fit.error().message;

  std::vector<std::vector<cv::Point3f>> places(views.size());
  std::vector<std::vector<cv::Point2f>> pixels(views.size());
  for (std::size_t i = 0; i < views.size(); ++i)
    for (const auto& [index, pixel] : views[i]) {
      const Eigen::Vector2f m = board.corner_m(index).cast<float>();
      places[i].emplace_back(m.x(), m.y(), 0.0F);
      pixels[i].emplace_back(static_cast<float>(pixel.x()), static_cast<float>(pixel.y()));
    }
  cv::Mat K, D, sigma, sigma_poses, errors;
  std::vector<cv::Mat> R, t;
  const double rms = cv::calibrateCamera(places, pixels, {640, 480}, K, D, R, t, sigma, sigma_poses, errors,
                                         cv::CALIB_FIX_K3);
  EXPECT_NEAR(fit->rms_px, rms, 1e-5);
  EXPECT_NEAR(fit->camera.fu_px, K.at<double>(0, 0), 0.01);
  EXPECT_NEAR(fit->camera.cv_px, K.at<double>(1, 2), 0.01);
  EXPECT_NEAR(fit->camera.distortion.k2, D.at<double>(1), 1e-4);
  // It divides by the number of corners less that of unknowns; each corner is two numbers.
  const double corners = 12.0 * 54.0, unknowns = 8.0 + 6.0 * 12.0;
  const double ours_to_its = std::sqrt((corners - unknowns) / (2.0 * corners - unknowns));
  for (int i = 0; i < 8; ++i)
    EXPECT_NEAR(fit->sigma()[i], ours_to_its * sigma.at<double>(i), 0.01 * sigma.at<double>(i)) << i;
}

}  // namespace
}  // namespace waymark::calibrate
