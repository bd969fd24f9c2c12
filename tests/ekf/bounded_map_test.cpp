#include "waymark/ekf/bounded_map.hpp"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "support/allocation_counter.hpp"
#include "support/matrix_near.hpp"
#include "waymark/core/gaussian.hpp"

#include "pixel_world.hpp"

namespace waymark::ekf {
namespace {

using test::corner_id;
using test::matrix_near;
using test::PixelWorld;

const Eigen::Vector3d kCorner(4.0, 0.3, 0.6);

/// An observation that tells the more about the pose, the larger `information`.
PoseObservation telling(double information) {
  PoseObservation observation;
  observation.P_pose.setIdentity();
  Eigen::Matrix<double, 2, 3> H_pose;
  H_pose << information, 0.0, 0.0, 0.0, information, 0.0;
  observation.C_pose = H_pose.transpose();
  observation.S = (1.0 + information * information) * Eigen::Matrix2d::Identity();
  return observation;
}

std::vector<LandmarkId> removed(const BoundedMap& map) {
  return {map.removed().begin(), map.removed().end()};
}

TEST(BoundedMap, TheLeastUsefulOneThatIsNotInViewMakesRoom) {
  PixelWorld world({.capacity = 3});
  world.load(test::wall(3));
  world.map.begin_image();
  world.map.matched(0, telling(0.5));
  world.map.matched(1, telling(0.1));
  world.map.matched(2, telling(1.0));
  EXPECT_FALSE(world.map.make_room()) << "all are in view";
  world.map.begin_image();
  ASSERT_TRUE(world.map.make_room());
  EXPECT_EQ(removed(world.map), std::vector{corner_id(1)});
  EXPECT_FALSE(world.map.map().find(corner_id(1)));
  EXPECT_TRUE(world.map.make_room());
  EXPECT_EQ(world.map.map().features().size(), 2U) << "there was room";
  world.map.begin_image();
  EXPECT_TRUE(world.map.removed().empty());
}

TEST(BoundedMap, WhoKeepsFailingIsRetired) {
  PixelWorld world;
  world.load(test::wall(3));
  world.map.begin_image();
  for (int k = 0; k < 12; ++k) {
    world.map.missed(1);
    if (k % 2 == 0) {
      world.map.matched(0, telling(0.5));
      world.map.missed(0);
    }
  }
  world.map.retire();
  EXPECT_EQ(removed(world.map), std::vector{corner_id(1)});
  EXPECT_EQ(world.map.map().feature(0).observations, 1 + 6);
}

TEST(BoundedMap, ARayBecomesAPointWhereItIsAsGoodAsLinear) {
  PixelWorld world;
  world.map.begin_image();
  world.add_ray(0, kCorner, 0.2);
  world.add_ray(1, kCorner, 0.001);
  const Eigen::Vector3d here = world.here().p_world_camera;
  world.map.convert_ray(0, here);
  world.map.convert_ray(1, here);
  const PixelMap& map = world.map.map();
  EXPECT_FALSE(map.feature(0).is_point());
  ASSERT_TRUE(map.feature(1).is_point());
  EXPECT_TRUE(matrix_near(map.state().landmark(map.feature(1).element), kCorner, 1e-9));
  world.map.convert_ray(1, here);  // a point stays one
  EXPECT_TRUE(world.map.removed().empty());
}

TEST(BoundedMap, ARayThatLeadsBehindInfinityGoes) {
  PixelWorld world;
  world.map.begin_image();
  const int anchor = *world.map.map().add_anchor();
  const auto behind = [&](int number, double rho) {
    return world.map.add_ray(corner_id(number), anchor, {0.0, 0.0, rho},
                             ray_covariance(1e-6 * Eigen::Matrix2d::Identity(), 0.1), 1);
  };
  world.map.convert_ray(behind(0, -0.15), world.here().p_world_camera);
  EXPECT_EQ(world.map.map().features().size(), 1U) << "it may lead there by chance";
  world.map.convert_ray(behind(1, -0.25), world.here().p_world_camera);
  EXPECT_EQ(removed(world.map), std::vector{corner_id(1)});
}

TEST(BoundedMap, FreesTheAnchorOfTheLeastUsefulRaysThatNobodyNeeds) {
  PixelWorld world;
  world.map.begin_image();
  world.map.map().hold(
      world.map.map().feature(world.add_ray(0, kCorner, 0.2)).anchor);  // by a candidate, say
  for (int k = 1; world.map.map().has_free_anchor(); ++k) {
    const int ray = world.add_ray(k, kCorner, k == 6 ? 0.001 : 0.2);
    world.map.matched(ray, telling(k == 6 ? 0.1 : k == 7 ? 0.2 : 1.0));
  }
  EXPECT_FALSE(world.map.free_an_anchor()) << "all are in view";
  world.map.begin_image();
  ASSERT_TRUE(world.map.free_an_anchor());
  EXPECT_TRUE(world.map.map().has_free_anchor());
  EXPECT_TRUE(world.map.map().feature(6).is_point()) << "of fairly sure depth";
  EXPECT_TRUE(world.map.removed().empty());
  ASSERT_TRUE(world.map.map().add_anchor());
  ASSERT_TRUE(world.map.free_an_anchor());
  EXPECT_EQ(removed(world.map), std::vector{corner_id(7)}) << "of unsure depth";
  EXPECT_FALSE(world.map.map().feature(0).is_point());
}

TEST(BoundedMap, ACandidateThatIsGivenUpLeavesItsAnchor) {
  PixelWorld world;
  world.map.begin_image();
  world.map.give_up(corner_id(5), *world.map.map().add_anchor());
  EXPECT_EQ(removed(world.map), std::vector{corner_id(5)});
  EXPECT_EQ(world.map.map().state().landmarks(), 0);
}

TEST(BoundedMap, SavesRaysAsThePointsThatTheyLeadTo) {
  PixelWorld world({.depth = {.farthest_m = 20.0}});
  world.load({kCorner});
  world.move({0.3, 0.1, 0.1});
  world.add_ray(1, {5.0, -0.5, 0.7}, 0.02);
  world.add_ray(2, {40.0, -0.5, 0.7}, 0.02);  // farther away than points may be
  const MapState saved = world.map.save();
  EXPECT_EQ(saved.ids, (std::vector{corner_id(0), corner_id(1)}));
  EXPECT_TRUE(matrix_near(saved.landmarks.segment<3>(0), kCorner, 1e-12));
  EXPECT_TRUE(matrix_near(saved.landmarks.segment<3>(3), Eigen::Vector3d(5.0, -0.5, 0.7), 1e-9));
  EXPECT_TRUE(is_covariance(saved.covariance));

  PixelWorld again;
  ASSERT_TRUE(again.map.load(saved));
  const MapState loaded = again.map.save();
  EXPECT_EQ(loaded.ids, saved.ids);
  EXPECT_EQ(loaded.landmarks, saved.landmarks);
  EXPECT_EQ(loaded.covariance, saved.covariance);
  EXPECT_FALSE(again.map.load(saved)) << "only before the first";
}

TEST(BoundedMap, APatchSaysFromWhereALandmarkWasSeen) {
  PixelWorld world;
  MapState saved;
  saved.landmark_dimension = 3;
  saved.ids = {corner_id(0), corner_id(1)};
  saved.observations = {3, 3};
  saved.landmarks = Eigen::VectorXd::Ones(6);
  saved.covariance = Eigen::MatrixXd::Identity(9, 9);
  saved.T_world_robot = {2.0, 0.0, 0.0};
  saved.patches.push_back({corner_id(1), {1.0, 0.0, 0.0}, {}});
  ASSERT_TRUE(world.map.load(saved));
  EXPECT_TRUE(matrix_near(world.map.map().feature(0).seen_from_m, Eigen::Vector3d(2.1, 0.0, 0.5), 1e-12));
  EXPECT_TRUE(matrix_near(world.map.map().feature(1).seen_from_m, Eigen::Vector3d(1.1, 0.0, 0.5), 1e-12));
  EXPECT_TRUE(matrix_near(world.map.map().feature(1).first_view_m, Eigen::Vector3d(0.1, -1.0, -0.5), 1e-12));
}

TEST(BoundedMap, RefusesAMapThatDoesNotFit) {
  PixelWorld world({.capacity = 2});
  MapState saved;
  saved.landmark_dimension = 3;
  saved.ids = {corner_id(0), corner_id(1), corner_id(2)};
  saved.observations = {1, 1, 1};
  saved.landmarks = Eigen::VectorXd::Ones(9);
  saved.covariance = Eigen::MatrixXd::Identity(12, 12);
  EXPECT_FALSE(world.map.load(saved));
  EXPECT_TRUE(world.map.map().features().empty());
}

TEST(BoundedMap, AllocatesNothingOnceItIsMade) {
  PixelWorld world({.capacity = 4});
  const test::AllocationCount count;
  for (int k = 0; k < 100; ++k) {
    world.map.begin_image();
    ASSERT_TRUE(world.map.free_an_anchor());
    ASSERT_TRUE(world.map.make_room());
    const int feature = world.add_ray(k, kCorner, k % 2 == 0 ? 0.2 : 0.001);
    world.map.matched(feature, telling(1.0));
    world.map.convert_ray(feature, world.here().p_world_camera);
  }
  EXPECT_EQ(count.allocations(), 0);
}

}  // namespace
}  // namespace waymark::ekf
