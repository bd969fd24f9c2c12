#include "workbench/eval/space_path.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "eval/eval_support.hpp"
#include "eval/space_support.hpp"

namespace waymark::eval {
namespace {

using test::in_plane;
using test::lifted;
using test::wavy_path;

TEST(OutOfPlane, IsTheHeightAndTheTiltOfAPath) {
  const OutOfPlane flat = out_of_plane(in_space(wavy_path(200)));
  EXPECT_NEAR(flat.length_m, 19.9, 1e-6);
  EXPECT_EQ(flat.height_m, 0.0);
  EXPECT_NEAR(flat.tilt_rad, 0.0, 1e-7);
  const OutOfPlane hill = out_of_plane(lifted(in_space(wavy_path(200)), 0.5));
  EXPECT_NEAR(hill.height_m, 0.5, 1e-3);
  EXPECT_TRUE(is_planar(flat));
  EXPECT_FALSE(is_planar(hill));
  EXPECT_TRUE(is_planar(out_of_plane(lifted(in_space(wavy_path(200)), 0.1)))) << "half a percent";
}

TEST(OutOfPlane, AMountThatIsTiltedAllTheTimeIsNoTilt) {
  SpacePath path = in_space(wavy_path(100));
  const Eigen::Quaterniond mount(Eigen::AngleAxisd(-2.0, Eigen::Vector3d(1.0, 0.3, 0.2).normalized()));
  for (SpacePose& pose : path) pose.q = pose.q * mount;
  EXPECT_NEAR(out_of_plane(path).tilt_rad, 0.0, 1e-7);
  path[50].q = path[50].q * Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitX());
  EXPECT_GT(out_of_plane(path).tilt_rad, 0.05);
  EXPECT_FALSE(is_planar({.length_m = 10.0, .height_m = 0.0, .tilt_rad = 0.2}));
}

TEST(OutOfPlane, AStandingRobotMayJitter) {
  EXPECT_TRUE(is_planar({.length_m = 0.0, .height_m = 0.015, .tilt_rad = 0.0}));
}

TEST(OnPlane, UndoesEveryPlaneUpToARigidMotion) {
  const Trajectory path = wavy_path(300);
  for (const auto& [plane, name] : {std::pair(Plane::kXz, "xz"), {Plane::kYz, "yz"}, {Plane::kFit, "fit"}}) {
    EXPECT_EQ(plane_named(name), plane);
    const SpacePath turned = in_plane(plane, in_space(path));
    const Trajectory back = on_plane(turned, onto_plane(plane, turned));
    const Pose2 T = path[0].pose * back[0].pose.inverse();
    for (std::size_t i = 0; i < path.size(); ++i)
      EXPECT_LT(difference(T * back[i].pose, path[i].pose).norm(), 1e-6) << name;
  }
  EXPECT_FALSE(plane_named("xyz"));
}

TEST(HasOrientation, NotWhereAPathTurnsWithoutTurning) {
  SpacePath path = in_space(wavy_path(300));
  EXPECT_TRUE(has_orientation(path));
  for (SpacePose& pose : path) pose.q = path.front().q;
  EXPECT_FALSE(has_orientation(path));
  EXPECT_TRUE(has_orientation(in_space(test::straight_path(50))));
  for (SpacePose& pose : path) pose.p_m *= 1e-4;
  EXPECT_TRUE(has_orientation(path)) << "of a robot that stands";
}

}  // namespace
}  // namespace waymark::eval
