#include "workbench/sim/rooms.hpp"

#include <algorithm>

#include <gtest/gtest.h>

namespace waymark::sim {
namespace {

using Eigen::Vector2d;

struct Built {
  SimOptions options;
  Path path;
  Scene scene;
};

Built build(std::string_view name, std::uint64_t seed) {
  const SimOptions options = *scenario(name);
  const Path path = make_path(options.path, seed);
  return {options, path, build_scene(options.room, path, seed)};
}

/// Everything but the hull (6) and the core.
std::vector<Rectangle> furniture(const Built& built) {
  const bool has_core = built.options.room.scene == SceneKind::kCorridor;
  return {built.scene.rectangles.begin() + (has_core ? 10 : 6), built.scene.rectangles.end()};
}

TEST(Rooms, TheRoomMeasuresTenByTenMetres) {
  const SimOptions options = *scenario("room");
  const Walls hull = hull_around(options.room, make_path(options.path, 1));
  EXPECT_NEAR((hull.low_m - Vector2d(-5.0, -5.0)).norm(), 0.0, 1e-9);
  EXPECT_NEAR((hull.high_m - Vector2d(5.0, 5.0)).norm(), 0.0, 1e-9);
}

TEST(Rooms, TheCorridorIsTwoMetresWide) {
  const SimOptions options = *scenario("corridor");
  const Path path = make_path(options.path, 1);
  const Walls hull = hull_around(options.room, path);
  const Walls core = core_inside(options.room, path);
  EXPECT_NEAR((hull.high_m - core.high_m - Vector2d(2.0, 2.0)).norm(), 0.0, 1e-9);
  EXPECT_NEAR((hull.high_m - hull.low_m - Vector2d(26.0, 10.0)).norm(), 0.0, 1e-9);
}

TEST(Rooms, NothingStandsInTheWayOrBeyondTheWalls) {
  for (const char* name : {"room", "corridor"}) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const Built built = build(name, seed);
      const Walls hull = hull_around(built.options.room, built.path);
      EXPECT_GT(furniture(built).size(), 60u);
      for (const Rectangle& r : furniture(built)) {
        const Vector2d corner = r.corner_m.head<2>();
        ASSERT_GT(distance_m(built.path, corner), 0.4) << name << seed;
        ASSERT_TRUE(((corner - hull.low_m).array() > -0.3).all());
        ASSERT_LT(r.texture, built.scene.textures.size());
      }
    }
  }
}

TEST(Rooms, SomebodyWalksInTheRoom) {
  const Built built = build("room", 1);
  ASSERT_EQ(built.scene.walkers.size(), 1u);
  const Walker& walker = built.scene.walkers.front();
  EXPECT_GT((walker.to_m - walker.from_m).norm(), 3.0);
}

TEST(Rooms, ASeedDecidesWhatIsPaintedAndWhereItStands) {
  const auto look = [](const Built& built) {
    const SummedMipmap& wall = built.scene.textures.front();
    return std::vector<int>(wall.texels(), wall.texels() + 100000);
  };
  const Built one = build("room", 1), again = build("room", 1), other = build("room", 2);
  EXPECT_EQ(look(one), look(again));
  EXPECT_NE(look(one), look(other));
  EXPECT_EQ(one.scene.rectangles.back().corner_m, again.scene.rectangles.back().corner_m);
  EXPECT_NE(one.scene.rectangles.back().corner_m, other.scene.rectangles.back().corner_m);
}

}  // namespace
}  // namespace waymark::sim
