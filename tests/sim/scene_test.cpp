#include "workbench/sim/scene.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "waymark/core/angle.hpp"

namespace waymark::sim {
namespace {

using Eigen::Vector3d;

Vector3d middle(const Rectangle& r) {
  return r.corner_m + 0.5 * (r.width_m * r.along_s + r.height_m * r.along_t);
}

TEST(Scene, AHullIsSeenFromInside) {
  std::vector<Rectangle> rectangles;
  add_hull({.low_m = {-1.0, -2.0}, .high_m = {3.0, 4.0}, .height_m = 2.5, .textures = {5, 6, 7, 8}}, 9, 10,
           rectangles);
  ASSERT_EQ(rectangles.size(), 6u);
  const Vector3d centre(1.0, 1.0, 1.25);
  for (const Rectangle& r : rectangles) {
    EXPECT_NEAR(r.normal().norm(), 1.0, 1e-12);
    EXPECT_NEAR((centre - middle(r)).normalized().dot(r.normal()), 1.0, 1e-12);
  }
  EXPECT_EQ(rectangles[0].texture, 5u);
  EXPECT_NEAR(rectangles[0].width_m, 4.0, 1e-12);
  EXPECT_EQ(rectangles[4].texture, 9u);
  EXPECT_EQ(middle(rectangles[4]).z(), 0.0);
}

TEST(Scene, ABlockAndACoreAreSeenFromOutsideTheirWritingUpright) {
  std::vector<Rectangle> rectangles;
  const Vector3d centre(1.0, 2.0, 0.5 + 0.8);
  add_block({.centre_m = centre.head<2>(), .yaw_rad = 0.7, .bottom_m = 0.5, .size_m = {0.4, 0.6, 1.6}},
            rectangles);
  add_core({.low_m = {0.8, 1.0}, .high_m = {1.2, 3.0}}, rectangles);
  ASSERT_EQ(rectangles.size(), 10u);
  for (const Rectangle& r : rectangles) {
    EXPECT_GT((middle(r) - centre).dot(r.normal()), 0.0);
    EXPECT_NEAR(r.along_s.dot(r.along_t), 0.0, 1e-12);
    EXPECT_LE(r.along_t.z(), 1e-12);
  }
}

/// Where the walker's body is: the middle of all that moves.
Vector3d walker_at(const Scene& scene, double time_s) {
  const auto all = scene.at(stamp_from_seconds(time_s));
  Vector3d sum = Vector3d::Zero();
  for (std::size_t i = scene.rectangles.size(); i < all.size(); ++i) sum += middle(all[i]);
  return sum / static_cast<double>(all.size() - scene.rectangles.size());
}

TEST(Scene, AWalkerGoesToAndFro) {
  Scene scene;
  scene.walkers.push_back({.from_m = {1.0, 1.0}, .to_m = {5.0, 1.0}, .speed_mps = 0.8});
  const Vector3d start = walker_at(scene, 0.0);
  EXPECT_NEAR(start.x(), 1.0, 0.1);
  EXPECT_NEAR(start.y(), 1.0, 0.1);
  EXPECT_NEAR(walker_at(scene, 2.5).x(), 3.0, 0.1);
  EXPECT_NEAR(walker_at(scene, 5.0).x(), 5.0, 0.1);
  EXPECT_NEAR(walker_at(scene, 7.5).x(), 3.0, 0.1);
  EXPECT_NEAR((walker_at(scene, 10.0) - start).norm(), 0.0, 0.1);
}

}  // namespace
}  // namespace waymark::sim
