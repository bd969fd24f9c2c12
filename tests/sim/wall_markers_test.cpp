#include "workbench/sim/wall_markers.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "workbench/sim/rooms.hpp"

namespace waymark::sim {
namespace {

TEST(WallMarkers, HangOnTheWallsOfARoomOfSixMetres) {
  const SimOptions options = *scenario("marker-room");
  const Path path = make_path(options.path, 1);
  const Walls hull = hull_around(options.room, path);
  EXPECT_TRUE((hull.high_m - hull.low_m).isApprox(Eigen::Vector2d(6.0, 6.0), 0.02));
  const auto markers = place_markers(options.room, path, 1);
  ASSERT_EQ(markers.size(), 12U);
  for (const WallMarker& marker : markers) {
    EXPECT_EQ(marker.size_m, 0.2);
    const Eigen::Vector2d p = marker.centre_m.head<2>();
    const double to_wall_m = std::min((p - hull.low_m).minCoeff(), (hull.high_m - p).minCoeff());
    EXPECT_NEAR(to_wall_m, 0.003, 1e-9);
    EXPECT_GT(marker.centre_m.z(), 0.3);
    EXPECT_LT(marker.centre_m.z(), 1.0);
  }
}

/// Seen from inside, with its corners clockwise from the upper left and apart from its neighbours.
TEST(WallMarkers, FaceTheRoomAndDoNotOverlap) {
  const SimOptions options = *scenario("marker-room");
  const Path path = make_path(options.path, 2);
  const auto markers = place_markers(options.room, path, 2);
  for (const WallMarker& marker : markers) {
    const auto corners = marker.corners_m();
    EXPECT_GT(corners[0].z(), corners[3].z());
    EXPECT_NEAR((corners[1] - corners[0]).norm(), marker.size_m, 1e-12);
    const Eigen::Vector3d out = (corners[3] - corners[0]).cross(corners[1] - corners[0]);
    EXPECT_GT(out.dot(-marker.centre_m), 0.0);  // the room is about the origin
    for (const WallMarker& other : markers) {
      if (other.number != marker.number) {
        EXPECT_GT((other.centre_m - marker.centre_m).norm(), 0.5);
      }
    }
  }
}

TEST(WallMarkers, HangElsewhereForAnotherSeed) {
  const SimOptions options = *scenario("marker-room");
  const Path path = make_path(options.path, 1);
  const auto some = place_markers(options.room, path, 1), same = place_markers(options.room, path, 1);
  const auto others = place_markers(options.room, path, 2);
  EXPECT_EQ(some[5].centre_m, same[5].centre_m);
  EXPECT_NE(some[5].centre_m, others[5].centre_m);
}

}  // namespace
}  // namespace waymark::sim
