#include "workbench/sim/wall_markers.hpp"

#include "waymark/core/random.hpp"

#include "workbench/sim/rooms.hpp"

namespace waymark::sim {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kLowest_m = 0.35;
constexpr double kHighest_m = 0.9;
// Part of the room between neighbours by which a marker may be off its even place.
constexpr double kUneven = 0.25;
// A marker is a plate in front of its wall.
constexpr double kThickness_m = 0.003;

}  // namespace

std::array<Vector3d, 4> WallMarker::corners_m() const {
  const Vector3d right = 0.5 * size_m * along_s, down = -0.5 * size_m * Vector3d::UnitZ();
  return {centre_m - right - down, centre_m + right - down, centre_m + right + down, centre_m - right + down};
}

std::vector<WallMarker> place_markers(const RoomOptions& options, const Path& path, std::uint64_t seed) {
  const Walls hull = hull_around(options, path);
  const Vector2d &low = hull.low_m, &high = hull.high_m;
  const std::array<Vector2d, 4> corners{low, {high.x(), low.y()}, high, {low.x(), high.y()}};
  RandomStream random(seed, StreamPurpose::kWorld, 4);
  std::vector<WallMarker> markers;
  for (int i = 0; i < options.markers; ++i) {
    const auto wall = static_cast<std::size_t>(i) % 4;
    const int on_wall = (options.markers - static_cast<int>(wall) + 3) / 4;
    const Vector2d along = corners[wall] - corners[(wall + 1) % 4];  // from left to right as seen from inside
    const int number_on_wall = i / 4;
    const double place = (number_on_wall + 0.5 + random.uniform(-kUneven, kUneven)) / on_wall;
    const Vector2d inwards = Vector2d(along.y(), -along.x()).normalized();
    const Vector2d p = corners[(wall + 1) % 4] + place * along + kThickness_m * inwards;
    markers.push_back({i,
                       options.marker_size_m,
                       {p.x(), p.y(), random.uniform(kLowest_m, kHighest_m)},
                       {along.normalized().x(), along.normalized().y(), 0.0}});
  }
  return markers;
}

}  // namespace waymark::sim
