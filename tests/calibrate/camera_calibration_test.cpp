#include "workbench/calibrate/camera_calibration.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "photographed_board.hpp"

namespace waymark::calibrate {
namespace {

using test::chessboard;
using test::named;
using test::photograph;
using test::true_camera;

std::vector<BoardView> good_views(std::uint64_t seed = 1) {
  return named(photograph(chessboard(), true_camera(), 20, 0.2, seed));
}

/// 0.2 px in both directions, less what camera and poses take up. Its standard deviation is 1.7 %.
double expected_rms_px(int views) {
  const double numbers = 2.0 * 54.0 * views, unknowns = 8.0 + 6.0 * views;
  return 0.2 * std::sqrt(2.0 * (numbers - unknowns) / numbers);
}

TEST(CameraCalibration, OfGoodViewsUsesAllAndIsNotWeak) {
  const auto result = calibrate_camera(chessboard(), good_views());
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_EQ(result->used(), 20U);
  EXPECT_FALSE(result->is_weak()) << result->weaknesses[0].what;
  EXPECT_EQ(result->lens, Lens::kFourTerms);
  EXPECT_EQ(result->held_out.folds, 10);
  EXPECT_NEAR(result->fit.rms_px, expected_rms_px(20), 0.05 * expected_rms_px(20));
  EXPECT_GT(result->held_out.rms_px, result->fit.rms_px);
  EXPECT_LT(result->held_out.rms_px, 1.1 * result->fit.rms_px);
}

TEST(CameraCalibration, JackknifeAgreesWithTheCovarianceWhereErrorsAreIndependent) {
  double ratio = 0.0;
  constexpr int kRuns = 10;
  for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
    const auto result = calibrate_camera(chessboard(), good_views(seed));
    ASSERT_TRUE(result);
    ratio += result->held_out.sigma[0] / result->fit.sigma()[0] / kRuns;
  }
  // Of 10 folds, a variance of about 9 degrees of freedom: 24 % for one run, 8 % for the mean of ten.
  EXPECT_NEAR(ratio, 1.0, 0.3);
}

TEST(CameraCalibration, EstimatesK3WhereThereIsOne) {
  CameraOptions camera = true_camera();
  camera.distortion.k3 = 0.3;
  const auto result = calibrate_camera(chessboard(), named(photograph(chessboard(), camera, 25, 0.1, 6)));
  ASSERT_TRUE(result);
  EXPECT_EQ(result->lens, Lens::kFiveTerms);
  EXPECT_NEAR(result->fit.camera.distortion.k3, 0.3, 5.0 * result->fit.sigma()[8]);
}

TEST(CameraCalibration, DropsAndNamesWhatDoesNotBelong) {
  auto views = good_views();
  views[3].corners[20].pixel.x() += 15.0;
  views[5].edge_px = 6.0;
  views[7].size = {1280, 960};
  const auto result = calibrate_camera(chessboard(), std::move(views));
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_EQ(result->used(), 17U);
  EXPECT_EQ(result->views[3].fate, Fate::kOutlier);
  EXPECT_EQ(result->views[5].fate, Fate::kBlurred);
  EXPECT_EQ(result->views[7].fate, Fate::kOtherSize);
  EXPECT_NE(result->views[7].why.find("1280 x 960"), std::string::npos);
  EXPECT_FALSE(result->views[3].fit.residuals_px.empty());
  EXPECT_NEAR(result->fit.rms_px, expected_rms_px(17), 0.05 * expected_rms_px(17));
}

TEST(CameraCalibration, TooFewViewsAreAnErrorThatCounts) {
  auto views = good_views();
  for (std::size_t i = 2; i < views.size(); ++i) views[i].fate = Fate::kNoBoard;
  const auto result = calibrate_camera(chessboard(), std::move(views));
  ASSERT_FALSE(result);
  EXPECT_NE(result.error().message.find("2 of 20 images"), std::string::npos) << result.error().message;
  EXPECT_NE(result.error().message.find("18 no board"), std::string::npos) << result.error().message;
}

TEST(CameraCalibration, TiltAndDistanceAreThoseOfTheBoard) {
  FittedView view;
  view.T_camera_board.translation() = Eigen::Vector3d(-0.1, -0.0625, 0.5);
  EXPECT_NEAR(tilt_deg(view), 0.0, 1e-6);
  EXPECT_NEAR(distance_m(view, chessboard()), 0.5, 1e-9);
  view.T_camera_board.linear() =
      Eigen::AngleAxisd(to_radians(30.0), Eigen::Vector3d::UnitX()).toRotationMatrix();
  EXPECT_NEAR(tilt_deg(view), 30.0, 1e-6);
}

}  // namespace
}  // namespace waymark::calibrate
