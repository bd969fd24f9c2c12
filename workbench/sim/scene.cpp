#include "workbench/sim/scene.hpp"

#include <cmath>

#include <Eigen/Geometry>

#include "waymark/core/angle.hpp"
#include "waymark/core/pose2.hpp"

namespace waymark::sim {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

Vector3d at_height(const Vector2d& p, double z_m) { return {p.x(), p.y(), z_m}; }

Rectangle lit(Rectangle rectangle) {
  rectangle.brightness = brightness_of(rectangle.normal());
  return rectangle;
}

/// An upright rectangle with its lower edge from left to right as seen from its front.
Rectangle upright(const Vector2d& left, const Vector2d& right, double bottom_m, double height_m) {
  Rectangle r{.corner_m = at_height(left, bottom_m + height_m),
              .along_s = at_height((right - left).normalized(), 0.0),
              .width_m = (right - left).norm(),
              .height_m = height_m};
  return lit(r);
}

/// Corners of an area, counter-clockwise from above.
std::array<Vector2d, 4> corners_of(const Walls& walls) {
  const Vector2d &low = walls.low_m, &high = walls.high_m;
  return {low, {high.x(), low.y()}, high, {low.x(), high.y()}};
}

/// A level rectangle over an area, facing up or down.
Rectangle level(const Walls& walls, double z_m, bool faces_up, std::size_t texture) {
  const Vector2d size = walls.high_m - walls.low_m;
  const double across = faces_up ? -1.0 : 1.0;
  const Vector2d corner(walls.low_m.x(), faces_up ? walls.high_m.y() : walls.low_m.y());
  return lit({.corner_m = at_height(corner, z_m),
              .along_t = across * Vector3d::UnitY(),
              .width_m = size.x(),
              .height_m = size.y(),
              .texture = texture,
              .endless = true});
}

Block part_of(const Walker& walker, const Pose2& T_world_walker, const Vector2d& place_m, double bottom_m,
              const Vector3d& size_m) {
  return {.centre_m = T_world_walker * place_m,
          .yaw_rad = T_world_walker.theta_rad,
          .bottom_m = bottom_m,
          .size_m = size_m,
          .texture = walker.texture,
          .texture_offset_m = {bottom_m, place_m.y()}};
}

void add_walker(const Walker& walker, Stamp when, std::vector<Rectangle>& rectangles) {
  const Vector2d line = walker.to_m - walker.from_m;
  const double travelled_m = walker.speed_mps * to_seconds(when);
  const double along_m = std::fmod(travelled_m, 2.0 * line.norm());
  const bool returns = along_m > line.norm();
  const Vector2d p = walker.from_m + (returns ? 2.0 * line.norm() - along_m : along_m) * line.normalized();
  const Vector2d ahead = returns ? Vector2d(-line) : line;
  const Pose2 T{p.x(), p.y(), std::atan2(ahead.y(), ahead.x())};
  const double step_m = 0.25 * std::sin(travelled_m * 2.0 * kPi / 1.4);
  add_block(part_of(walker, T, {step_m, 0.11}, 0.0, {0.17, 0.16, 0.85}), rectangles);
  add_block(part_of(walker, T, {-step_m, -0.11}, 0.0, {0.17, 0.16, 0.85}), rectangles);
  add_block(part_of(walker, T, {0.0, 0.0}, 0.8, {0.26, 0.46, 0.6}), rectangles);
  add_block(part_of(walker, T, {0.03, 0.0}, 1.45, {0.2, 0.17, 0.25}), rectangles);
}

}  // namespace

double brightness_of(const Vector3d& normal) { return 0.85 + normal.dot(Vector3d(0.08, 0.05, 0.1)); }

Vector3d Rectangle::normal() const { return along_t.cross(along_s); }

std::vector<Rectangle> Scene::at(Stamp when) const {
  std::vector<Rectangle> all = rectangles;
  for (const Walker& walker : walkers) add_walker(walker, when, all);
  return all;
}

void add_hull(const Walls& walls, std::size_t floor_texture, std::size_t ceiling_texture,
              std::vector<Rectangle>& rectangles) {
  const auto corners = corners_of(walls);
  for (std::size_t i = 0; i < 4; ++i) {
    // Inside, the right end of a wall is its first corner.
    Rectangle wall = upright(corners[(i + 1) % 4], corners[i], 0.0, walls.height_m);
    wall.texture = walls.textures[i];
    wall.endless = true;
    rectangles.push_back(wall);
  }
  rectangles.push_back(level(walls, 0.0, true, floor_texture));
  rectangles.push_back(level(walls, walls.height_m, false, ceiling_texture));
}

void add_core(const Walls& walls, std::vector<Rectangle>& rectangles) {
  const auto corners = corners_of(walls);
  for (std::size_t i = 0; i < 4; ++i) {
    rectangles.push_back(upright(corners[i], corners[(i + 1) % 4], 0.0, walls.height_m));
    rectangles.back().texture = walls.textures[i];
  }
}

void add_block(const Block& block, std::vector<Rectangle>& rectangles) {
  const Pose2 T_world_block{block.centre_m.x(), block.centre_m.y(), block.yaw_rad};
  const double x = 0.5 * block.size_m.x(), y = 0.5 * block.size_m.y(), height_m = block.size_m.z();
  const std::array<Vector2d, 4> corners{T_world_block * Vector2d(-x, -y), T_world_block * Vector2d(x, -y),
                                        T_world_block * Vector2d(x, y), T_world_block * Vector2d(-x, y)};
  const Vector3d ahead = at_height(T_world_block.rotation().col(0), 0.0);
  const Vector3d left = at_height(T_world_block.rotation().col(1), 0.0);
  std::array<Rectangle, 6> faces;
  for (std::size_t i = 0; i < 4; ++i)
    faces[i] = upright(corners[i], corners[(i + 1) % 4], block.bottom_m, height_m);
  faces[4] = lit({.corner_m = at_height(corners[3], block.bottom_m + height_m),
                  .along_s = ahead,
                  .along_t = -left,
                  .width_m = 2.0 * x,
                  .height_m = 2.0 * y});
  faces[5] = lit({.corner_m = at_height(corners[0], block.bottom_m),
                  .along_s = ahead,
                  .along_t = left,
                  .width_m = 2.0 * x,
                  .height_m = 2.0 * y});
  for (std::size_t i = 0; i < 6; ++i) {
    faces[i].texture = block.texture;
    faces[i].texture_offset_m = block.texture_offset_m + static_cast<double>(i) * Vector2d(0.37, 0.23);
    rectangles.push_back(faces[i]);
  }
}

}  // namespace waymark::sim
