#include "waymark/markers/homography.hpp"

#include <Eigen/LU>

namespace waymark::markers {

Corners corners_of_square(double side) {
  const double h = 0.5 * side;
  return {Eigen::Vector2d(-h, -h), Eigen::Vector2d(h, -h), Eigen::Vector2d(h, h), Eigen::Vector2d(-h, h)};
}

std::optional<Eigen::Matrix3d> homography_of_square(const Corners& points, double side) {
  Eigen::Matrix<double, 8, 8> A;
  Eigen::Matrix<double, 8, 1> b;
  const Corners corners = corners_of_square(side);
  for (std::size_t i = 0; i < 4; ++i) {
    const double x = corners[i].x(), y = corners[i].y(), u = points[i].x(), v = points[i].y();
    const auto row = static_cast<Eigen::Index>(2 * i);
    A.row(row) << x, y, 1.0, 0.0, 0.0, 0.0, -u * x, -u * y;
    A.row(row + 1) << 0.0, 0.0, 0.0, x, y, 1.0, -v * x, -v * y;
    b.segment<2>(row) = points[i];
  }
  const Eigen::FullPivLU<Eigen::Matrix<double, 8, 8>> lu(A);
  if (!lu.isInvertible()) return std::nullopt;
  const Eigen::Matrix<double, 8, 1> h = lu.solve(b);
  return Eigen::Matrix3d{{h[0], h[1], h[2]}, {h[3], h[4], h[5]}, {h[6], h[7], 1.0}};
}

}  // namespace waymark::markers
