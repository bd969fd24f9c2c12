#include "workbench/calibrate/projection_sigma.hpp"

#include <algorithm>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "photographed_board.hpp"

namespace waymark::calibrate {
namespace {

TEST(ProjectionSigma, IsTheShiftThatNoTurnMakesGood) {
  const CameraOptions camera = test::true_camera();
  Intrinsics off;
  off << 1.0, 0.7, -1.5, 0.8, 1e-3, -2e-3, 1e-4, -1e-4, 0.0;
  const double small = 1e-4;
  const auto places = projection_sigmas(camera, off * off.transpose(), 8, 6);
  ASSERT_EQ(places.size(), 48U);

  // The same by brute force: images of the rays by a camera that is off a little, and of turned rays.
  const Camera truth(camera), other(with_intrinsics(camera, intrinsics_of(camera) + small * off));
  Eigen::MatrixX<double> W(96, 3);
  Eigen::VectorX<double> shift(96);
  for (Eigen::Index i = 0; i < 48; ++i) {
    const Eigen::Vector3d ray = truth.ray(places[static_cast<std::size_t>(i)].pixel)->xy.homogeneous();
    shift.segment<2>(2 * i) = (other.project(ray)->pixel - truth.project(ray)->pixel) / small;
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::AngleAxisd turn(1e-6, Eigen::Vector3d::Unit(axis));
      W.block<2, 1>(2 * i, axis) = (truth.project(turn * ray)->pixel - truth.project(ray)->pixel) / 1e-6;
    }
  }
  const Eigen::VectorX<double> rest = shift - W * (W.transpose() * W).ldlt().solve(W.transpose() * shift);
  for (Eigen::Index i = 0; i < 48; ++i)
    EXPECT_NEAR(places[static_cast<std::size_t>(i)].sigma_px, rest.segment<2>(2 * i).norm(), 2e-3);
}

TEST(ProjectionSigma, IsLargestWhereNoCornersWere) {
  const Board board = test::chessboard();
  std::vector<BoardCorners> left;
  for (const auto& view : test::photograph(board, test::true_camera(), 200, 0.2, 3))
    if (std::ranges::all_of(view, [](const BoardCorner& corner) { return corner.pixel.x() < 400.0; }))
      left.push_back(view);
  ASSERT_GE(left.size(), 10U);
  const auto fit = fit_camera(board, left, {640, 480}, Lens::kFourTerms);
  ASSERT_TRUE(fit);
  const auto places = projection_sigmas(fit->camera, fit->covariance);
  const auto worst = std::ranges::max_element(places, {}, &ProjectionSigma::sigma_px);
  EXPECT_GT(worst->pixel.x(), 500.0);
}

}  // namespace
}  // namespace waymark::calibrate
