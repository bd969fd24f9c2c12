#include "waymark/markers/homography.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace waymark::markers {
namespace {

TEST(Homography, TakesTheSquareToThePoints) {
  const Corners points{Eigen::Vector2d(10.0, 12.0), Eigen::Vector2d(50.0, 9.0), Eigen::Vector2d(47.0, 60.0),
                       Eigen::Vector2d(14.0, 44.0)};
  const auto H = homography_of_square(points, 0.2);
  ASSERT_TRUE(H.has_value());
  const Corners square = corners_of_square(0.2);
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector3d p = *H * square[i].homogeneous();
    EXPECT_LT((p.hnormalized() - points[i]).norm(), 1e-9);
  }
}

TEST(Homography, NeedsAQuadrangle) {
  Corners points;
  points.fill(Eigen::Vector2d(1.0, 2.0));
  EXPECT_FALSE(homography_of_square(points, 0.2).has_value());
}

}  // namespace
}  // namespace waymark::markers
