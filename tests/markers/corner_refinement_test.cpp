#include "waymark/markers/corner_refinement.hpp"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "drawn_marker.hpp"

namespace waymark::markers {
namespace {

constexpr double kSize_m = 0.2;
constexpr int kCells = 6;

double largest_error_px(const Corners& a, const Corners& b) {
  double largest_px = 0.0;
  for (std::size_t i = 0; i < 4; ++i) largest_px = std::max(largest_px, (a[i] - b[i]).norm());
  return largest_px;
}

TEST(CornerRefinement, FindsTheTrueCornersFromAPixelAway) {
  const Camera camera(test::marker_camera());
  RandomStream random(1, StreamPurpose::kWorld);
  for (int i = 0; i < 20; ++i) {
    const MarkerPose pose = test::random_marker_pose(random, 0.9);
    GreyImage image(640, 480, 120);
    test::draw_marker(image, camera, pose, kSize_m, i);
    const Corners truth = test::corners_of(camera, pose, kSize_m);
    Corners start = truth;
    for (auto& corner : start)
      corner += Eigen::Vector2d(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0));
    const auto refined = refine_corners(image, camera, start, kCells);
    ASSERT_TRUE(refined.has_value()) << i;
    EXPECT_LT(largest_error_px(refined->corners_px, truth), 0.25) << i;
  }
}

/// From noisy images of one marker: in units of the noise of a point, whose size one factor for all corners
/// must explain.
TEST(CornerRefinement, CovarianceTellsWhichCornersScatter) {
  const Camera camera(test::marker_camera());
  MarkerPose pose;
  pose.p_camera_marker = {0.3, 0.1, 2.5};
  pose.R_camera_marker =
      Eigen::AngleAxisd(0.9, Eigen::Vector3d(0.2, 1.0, 0.0).normalized()).toRotationMatrix();
  GreyImage clean(640, 480, 120);
  test::draw_marker(clean, camera, pose, kSize_m, 7);
  const Corners start = test::corners_of(camera, pose, kSize_m);
  RandomStream random(2, StreamPurpose::kWorld);
  constexpr int kImages = 200;
  Eigen::Matrix<double, 8, 1> sum = Eigen::Matrix<double, 8, 1>::Zero(), squares = sum, expected = sum;
  for (int i = 0; i < kImages; ++i) {
    GreyImage image = clean;
    for (int v = 150; v < 350; ++v)
      for (int u = 280; u < 480; ++u)
        image(u, v) =
            static_cast<std::uint8_t>(std::clamp(std::lround(clean(u, v) + 6.0 * random.normal()), 0L, 255L));
    const auto refined = refine_corners(image, camera, start, kCells);
    ASSERT_TRUE(refined.has_value());
    for (std::size_t k = 0; k < 4; ++k)
      for (Eigen::Index axis = 0; axis < 2; ++axis) {
        const auto row = static_cast<Eigen::Index>(2 * k) + axis;
        sum[row] += refined->corners_px[k][axis] / kImages;
        squares[row] += refined->corners_px[k][axis] * refined->corners_px[k][axis] / kImages;
        expected[row] += refined->covariance(row, row) / kImages;
      }
  }
  const Eigen::Array<double, 8, 1> variance = squares.array() - sum.array().square();
  const Eigen::Array<double, 8, 1> ratio = variance / expected.array();
  EXPECT_LT(ratio.maxCoeff() / ratio.minCoeff(), 4.0) << ratio.transpose();
}

TEST(CornerRefinement, CovarianceIsPositiveDefiniteAndSmallerForLargerMarkers) {
  const Camera camera(test::marker_camera());
  double last = 0.0;
  for (const double depth_m : {1.0, 2.0, 3.0}) {
    MarkerPose pose;
    pose.p_camera_marker = {0.1, 0.1, depth_m};
    GreyImage image(640, 480, 120);
    test::draw_marker(image, camera, pose, kSize_m, 7);
    const auto refined = refine_corners(image, camera, test::corners_of(camera, pose, kSize_m), kCells);
    ASSERT_TRUE(refined.has_value());
    const Eigen::SelfAdjointEigenSolver<CornerCovariance> eigen(refined->covariance);
    EXPECT_GT(eigen.eigenvalues().minCoeff(), 0.0);
    EXPECT_GT(refined->covariance.trace(), last);
    last = refined->covariance.trace();
  }
}

TEST(CornerRefinement, RefusesWhatIsCutOffOrNotThere) {
  const Camera camera(test::marker_camera());
  const GreyImage wall(640, 480, 120);
  MarkerPose pose;
  pose.p_camera_marker = {0.0, 0.0, 2.0};
  EXPECT_FALSE(refine_corners(wall, camera, test::corners_of(camera, pose, kSize_m), kCells).has_value());
  GreyImage image(640, 480, 120);
  pose.p_camera_marker = {-1.12, 0.0, 2.0};  // its left side at the border of the image
  test::draw_marker(image, camera, pose, kSize_m, 7);
  EXPECT_FALSE(refine_corners(image, camera, test::corners_of(camera, pose, kSize_m), kCells).has_value());
}

}  // namespace
}  // namespace waymark::markers
