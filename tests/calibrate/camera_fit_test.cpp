#include "workbench/calibrate/camera_fit.hpp"

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "support/numeric_jacobian.hpp"
#include "waymark/core/chi2.hpp"

#include "photographed_board.hpp"

namespace waymark::calibrate {
namespace {

constexpr ImageSize kSize{640, 480};

CameraOptions five_term_camera() {
  CameraOptions camera = test::true_camera();
  camera.distortion.k3 = -0.02;
  return camera;
}

TEST(CameraFit, JacobianToTheIntrinsicsIsThatOfTheProjection) {
  const CameraOptions camera = five_term_camera();
  RandomStream random(5, StreamPurpose::kSimulation);
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector3d p(random.uniform(-0.5, 0.5), random.uniform(-0.4, 0.4), random.uniform(0.8, 2.0));
    const auto pixel = [&](const Intrinsics& values) -> Eigen::Vector2d {
      return Camera(with_intrinsics(camera, values)).project(p)->pixel;
    };
    const auto numeric = waymark::test::numeric_jacobian(pixel, intrinsics_of(camera));
    EXPECT_TRUE(intrinsics_jacobian(Camera(camera), p).isApprox(numeric, 1e-6));
  }
}

TEST(CameraFit, FindsTheCameraOfExactCorners) {
  const CameraOptions camera = five_term_camera();
  const Board board = test::chessboard();
  const auto fit = fit_camera(board, test::photograph(board, camera, 8, 0.0, 1), kSize, Lens::kFiveTerms);
  ASSERT_TRUE(fit) << fit.error().message;
  EXPECT_LT((intrinsics_of(fit->camera) - intrinsics_of(camera)).cwiseAbs().maxCoeff(), 1e-4);
  EXPECT_LT(fit->rms_px, 1e-6);
}

TEST(CameraFit, ErrorsAreAsLargeAsItSays) {
  constexpr int kRuns = 40, kTerms = 8;
  const CameraOptions camera = test::true_camera();
  const Board board = test::chessboard();
  double nees = 0.0;
  Intrinsics squares = Intrinsics::Zero();
  for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
    const auto fit =
        fit_camera(board, test::photograph(board, camera, 12, 0.25, seed), kSize, Lens::kFourTerms);
    ASSERT_TRUE(fit) << fit.error().message;
    const Intrinsics error = intrinsics_of(fit->camera) - intrinsics_of(camera);
    const auto P = fit->covariance.topLeftCorner<kTerms, kTerms>();
    nees += error.head<kTerms>().dot(P.llt().solve(error.head<kTerms>()));
    squares.head<kTerms>() += error.cwiseAbs2().cwiseQuotient(fit->covariance.diagonal()).head<kTerms>();
    EXPECT_EQ(fit->camera.distortion.k3, 0.0);
    EXPECT_EQ(fit->covariance(8, 8), 0.0);
  }
  // Nothing is tuned: the sums are chi-square, and each bound is crossed by chance once in 2000 seeds.
  EXPECT_GT(nees, chi2_quantile(0.0005, kRuns * kTerms));
  EXPECT_LT(nees, chi2_quantile(0.9995, kRuns * kTerms));
  for (int i = 0; i < kTerms; ++i) {
    EXPECT_GT(squares[i], chi2_quantile(0.0005, kRuns)) << i;
    EXPECT_LT(squares[i], chi2_quantile(0.9995, kRuns)) << i;
  }
}

TEST(CameraFit, ResidualsAreAsLargeAsTheNoise) {
  const Board board = test::chessboard();
  const auto views = test::photograph(board, test::true_camera(), 15, 0.3, 7);
  const auto fit = fit_camera(board, views, kSize, Lens::kFourTerms);
  ASSERT_TRUE(fit);
  // 1620 numbers: 3 of their standard deviations are 5 %.
  EXPECT_NEAR(fit->rms_px, 0.3 * std::sqrt(2.0), 0.05 * 0.3 * std::sqrt(2.0));
  EXPECT_NEAR(rms_px(fit->views), fit->rms_px, 1e-12);
}

TEST(CameraFit, PoseOfAKnownCameraIsThatOfTheBoard) {
  const Board board = test::chessboard();
  const CameraOptions camera = test::true_camera();
  RandomStream random(9, StreamPurpose::kSimulation);
  for (int found = 0; found < 10;) {
    const Eigen::Isometry3d T = simulated::random_pose(board, {}, random);
    const BoardCorners corners = simulated::project(board, camera, T);
    if (corners.empty()) continue;
    const auto view = fit_pose(board, corners, camera);
    ASSERT_TRUE(view);
    EXPECT_TRUE(view->T_camera_board.isApprox(T, 1e-6));
    ++found;
  }
}

TEST(CameraFit, PartsOfABoardWillDo) {
  const Board board = test::chessboard();
  auto views = test::photograph(board, test::true_camera(), 10, 0.0, 4);
  for (std::size_t i = 0; i < views.size(); ++i)
    views[i].erase(views[i].begin() + static_cast<std::ptrdiff_t>(20 + i), views[i].end());
  const auto fit = fit_camera(board, views, kSize, Lens::kFourTerms);
  ASSERT_TRUE(fit) << fit.error().message;
  EXPECT_NEAR(fit->camera.fu_px, test::true_camera().fu_px, 1e-3);
}

TEST(CameraFit, TwoViewsJustSolve) {
  const Board board = test::chessboard();
  const auto fit =
      fit_camera(board, test::photograph(board, test::true_camera(), 2, 0.0, 2), kSize, Lens::kFourTerms);
  ASSERT_TRUE(fit) << fit.error().message;
  EXPECT_NEAR(fit->camera.fu_px, test::true_camera().fu_px, 1e-3);
}

TEST(CameraFit, TooFewViewsAndCornersOnALineAreErrors) {
  const Board board = test::chessboard();
  auto views = test::photograph(board, test::true_camera(), 3, 0.1, 4);
  views[1].resize(9);  // one row
  EXPECT_FALSE(fit_camera(board, views, kSize, Lens::kFourTerms));
  views.resize(1);
  const auto fit = fit_camera(board, views, kSize, Lens::kFourTerms);
  ASSERT_FALSE(fit);
  EXPECT_NE(fit.error().message.find("too few"), std::string::npos);
}

}  // namespace
}  // namespace waymark::calibrate
