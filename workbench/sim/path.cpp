#include "workbench/sim/path.hpp"

#include <algorithm>
#include <cmath>

#include "waymark/core/random.hpp"

namespace waymark::sim {
namespace {

using Corners = std::vector<Eigen::Vector2d>;

Corners square_corners(double side_m) {
  const double h = side_m / 2.0;
  return {{h, -h}, {h, h}, {-h, h}, {-h, -h}};
}

Corners loop_corners(double side_m) {
  const double h = side_m / 2.0;
  return {{h, -h / 3.0}, {h, h / 3.0}, {-h, h / 3.0}, {-h, -h / 3.0}};
}

Corners l_shape_corners(double side_m) {
  const double h = side_m / 2.0;
  return {{h, -h}, {h, 0.0}, {0.0, 0.0}, {0.0, h}, {-h, h}, {-h, -h}};
}

// Sides are at least a quarter of the square's, so that no segment is too short to see anything new.
Corners random_corners(double side_m, int count, RandomStream random) {
  const auto draw = [&] {
    const double x_m = random.uniform(-0.5, 0.5) * side_m;
    return Eigen::Vector2d(x_m, random.uniform(-0.5, 0.5) * side_m);
  };
  Corners corners{draw()};
  while (static_cast<int>(corners.size()) < count) {
    const Eigen::Vector2d p = draw();
    const bool is_last = static_cast<int>(corners.size()) == count - 1;
    const bool is_far = (p - corners.back()).norm() > side_m / 4.0;
    if (is_far && (!is_last || (p - corners.front()).norm() > side_m / 4.0)) corners.push_back(p);
  }
  return corners;
}

// Two circles that touch in the origin; the lap starts at the far side of the left one.
Path figure_eight_path(double side_m) {
  const double r = side_m / 4.0;
  return {{{-2.0 * r, 0.0, -kPi / 2.0}, {kPi * r, kPi}},
          {{0.0, 0.0, kPi / 2.0}, {2.0 * kPi * r, -2.0 * kPi}},
          {{0.0, 0.0, kPi / 2.0}, {kPi * r, kPi}}};
}

// From a point (x forward, y towards the centre) to an arc that starts in the origin along x.
double distance_to_left_arc_m(const Eigen::Vector2d& p, double radius_m, double turn_rad) {
  const Eigen::Vector2d from_centre(p.x(), p.y() - radius_m);
  double along_rad = std::atan2(from_centre.x(), -from_centre.y());
  if (along_rad < 0.0) along_rad += 2.0 * kPi;
  if (along_rad <= turn_rad) return std::abs(from_centre.norm() - radius_m);
  const Pose2 end = arc_increment({radius_m * turn_rad, turn_rad}, ArcModel::kExact);
  return std::min(p.norm(), (p - end.position()).norm());
}

/// A corner of a polygon: the turn, and how much of both sides its arc takes away.
struct Corner {
  double turn_rad = 0.0;
  double trim_m = 0.0;
  double arc_length_m = 0.0;
};

Corner make_corner(const Eigen::Vector2d& side_before, const Eigen::Vector2d& side_after, double radius_m) {
  const double turn_rad =
      wrap_angle(std::atan2(side_after.y(), side_after.x()) - std::atan2(side_before.y(), side_before.x()));
  const double half_tangent = std::tan(std::abs(turn_rad) / 2.0);
  const double trim_m =
      std::min(radius_m * half_tangent, std::min(side_before.norm(), side_after.norm()) / 2.0);
  return {turn_rad, trim_m, trim_m > 0.0 ? trim_m / half_tangent * std::abs(turn_rad) : 0.0};
}

}  // namespace

Pose2 PathSegment::at(double fraction) const {
  return T_world_start *
         arc_increment({fraction * arc.distance_m, fraction * arc.turn_rad}, ArcModel::kExact);
}

double PathSegment::distance_m(const Eigen::Vector2d& p_world) const {
  Eigen::Vector2d p = T_world_start.inverse() * p_world;
  if (arc.distance_m == 0.0 || arc.turn_rad == 0.0) {
    return std::hypot(p.x() - std::clamp(p.x(), 0.0, arc.distance_m), p.y());
  }
  if (arc.turn_rad < 0.0) p.y() = -p.y();
  const double turn_rad = std::abs(arc.turn_rad);
  return distance_to_left_arc_m(p, arc.distance_m / turn_rad, turn_rad);
}

Path polygon_path(const std::vector<Eigen::Vector2d>& corners, double corner_radius_m) {
  const std::size_t n = corners.size();
  const auto side = [&](std::size_t i) -> Eigen::Vector2d { return corners[(i + 1) % n] - corners[i % n]; };
  Path path;
  for (std::size_t i = 0; i < n; ++i) {
    const Corner before = make_corner(side(i + n - 1), side(i), corner_radius_m);
    const Corner after = make_corner(side(i), side(i + 1), corner_radius_m);
    const double heading_rad = std::atan2(side(i).y(), side(i).x());
    const Eigen::Vector2d start = corners[i] + side(i).normalized() * before.trim_m;
    const double straight_m = std::max(0.0, side(i).norm() - before.trim_m - after.trim_m);
    const PathSegment straight{{start.x(), start.y(), heading_rad}, {straight_m, 0.0}};
    if (straight_m > 0.0) path.push_back(straight);
    path.push_back({straight.at(1.0), {after.arc_length_m, after.turn_rad}});
  }
  return path;
}

Path make_path(const PathOptions& options, std::uint64_t seed) {
  switch (options.shape) {
    case Shape::kSquare:
      return polygon_path(square_corners(options.side_m), options.corner_radius_m);
    case Shape::kLShape:
      return polygon_path(l_shape_corners(options.side_m), options.corner_radius_m);
    case Shape::kLoop:
      return polygon_path(loop_corners(options.side_m), options.corner_radius_m);
    case Shape::kFigureEight:
      return figure_eight_path(options.side_m);
    case Shape::kRandom:
      break;
  }
  const RandomStream random(seed, StreamPurpose::kWorld, 0);
  return polygon_path(random_corners(options.side_m, options.waypoints, random), options.corner_radius_m);
}

double length_m(const Path& path) {
  double sum_m = 0.0;
  for (const PathSegment& segment : path) sum_m += segment.arc.distance_m;
  return sum_m;
}

double distance_m(const Path& path, const Eigen::Vector2d& p_world) {
  double nearest_m = path.front().distance_m(p_world);
  for (const PathSegment& segment : path) nearest_m = std::min(nearest_m, segment.distance_m(p_world));
  return nearest_m;
}

}  // namespace waymark::sim
