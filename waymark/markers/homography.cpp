#include "waymark/markers/homography.hpp"

#include <cmath>

namespace waymark::markers {
namespace {

double area_of(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

/// No three of the points are on a line.
bool is_quadrangle(const Corners& points) {
  constexpr double kFlat = 1e-12;
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector2d to_next = points[(i + 1) % 4] - points[i],
                          to_last = points[(i + 3) % 4] - points[i];
    const double scale = to_next.squaredNorm() + to_last.squaredNorm();
    if (!(std::abs(area_of(to_next, to_last)) > kFlat * scale)) return false;
  }
  return true;
}

}  // namespace

Corners corners_of_square(double side) {
  const double h = 0.5 * side;
  return {Eigen::Vector2d(-h, -h), Eigen::Vector2d(h, -h), Eigen::Vector2d(h, h), Eigen::Vector2d(-h, h)};
}

// Heckbert, "Fundamentals of texture mapping and image warping", 1989, section 2.2.3: from the square (0, 0)
// to (1, 1).
std::optional<Eigen::Matrix3d> homography_of_square(const Corners& points, double side) {
  if (!is_quadrangle(points)) return std::nullopt;
  const Eigen::Vector2d d1 = points[1] - points[2], d2 = points[3] - points[2];
  const Eigen::Vector2d s = points[0] - points[1] + points[2] - points[3];
  const double g = area_of(s, d2) / area_of(d1, d2), h = area_of(d1, s) / area_of(d1, d2);
  const Eigen::Vector2d a = points[1] - points[0] + g * points[1], b = points[3] - points[0] + h * points[3];
  const Eigen::Matrix3d of_unit{{a.x(), b.x(), points[0].x()}, {a.y(), b.y(), points[0].y()}, {g, h, 1.0}};
  const Eigen::Matrix3d to_unit{{1.0 / side, 0.0, 0.5}, {0.0, 1.0 / side, 0.5}, {0.0, 0.0, 1.0}};
  const Eigen::Matrix3d H = of_unit * to_unit;
  return H / H(2, 2);
}

}  // namespace waymark::markers
