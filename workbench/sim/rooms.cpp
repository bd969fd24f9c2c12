#include "workbench/sim/rooms.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "waymark/core/angle.hpp"
#include "waymark/core/random.hpp"

#include "workbench/sim/marker_pattern.hpp"
#include "workbench/sim/textures.hpp"
#include "workbench/sim/wall_markers.hpp"

namespace waymark::sim {
namespace {

using Eigen::Vector2d;

constexpr std::size_t kFurnitureTextures = 8;
constexpr int kTries = 3000;
// What a robot needs on either side.
constexpr double kClearance_m = 0.45;
constexpr double kBlockRadiusMin_m = 0.15;
constexpr double kBlockRadiusMax_m = 0.65;
constexpr double kWalkerRadius_m = 0.35;
constexpr double kWalkMin_m = 3.0;

/// The smallest upright rectangle around the path, widened.
Walls around(const Path& path, double margin_m, double height_m) {
  Walls walls{.low_m = path.front().at(0.0).position(), .high_m = walls.low_m, .height_m = height_m};
  for (const PathSegment& segment : path) {
    for (int i = 0; i <= 32; ++i) {
      const Vector2d p = segment.at(i / 32.0).position();
      walls.low_m = walls.low_m.cwiseMin(p);
      walls.high_m = walls.high_m.cwiseMax(p);
    }
  }
  walls.low_m.array() -= margin_m;
  walls.high_m.array() += margin_m;
  return walls;
}

bool contains(const Walls& walls, const Vector2d& p, double margin_m) {
  return ((p - walls.low_m).array() > margin_m).all() && ((walls.high_m - p).array() > margin_m).all();
}

/// A disc of the floor that something occupies.
struct Spot {
  Vector2d centre_m;
  double radius_m = 0.0;
};

/// Furnishes and peoples a hull.
class Interior {
 public:
  Interior(const RoomOptions& options, const Path& path, std::uint64_t seed)
      : options_(options),
        path_(path),
        hull_(hull_around(options, path)),
        core_(core_inside(options, path)),
        random_(seed, StreamPurpose::kWorld, 2) {}

  /// Fewer than wanted where there is no room.
  [[nodiscard]] std::vector<Block> furniture(std::size_t first_texture) {
    std::vector<Block> blocks;
    for (int i = 0; i < options_.blocks; ++i) {
      const auto spot = find_spot();
      if (!spot) break;
      spots_.push_back(*spot);
      blocks.push_back(block_at(*spot));
      blocks.back().texture = first_texture + static_cast<std::size_t>(i) % kFurnitureTextures;
    }
    return blocks;
  }

  [[nodiscard]] std::vector<Walker> walkers(std::size_t texture) {
    std::vector<Walker> all;
    for (int i = 0; i < kTries && static_cast<int>(all.size()) < options_.walkers; ++i) {
      const Walker walker{.from_m = draw_place(),
                          .to_m = draw_place(),
                          .speed_mps = options_.walker_speed_mps,
                          .texture = texture};
      if (is_free(walker)) all.push_back(walker);
    }
    return all;
  }

 private:
  Vector2d draw_place() {
    const double x_m = random_.uniform(hull_.low_m.x(), hull_.high_m.x());
    return {x_m, random_.uniform(hull_.low_m.y(), hull_.high_m.y())};
  }

  [[nodiscard]] bool is_on_floor(const Vector2d& p, double radius_m) const {
    const bool in_core = options_.scene == SceneKind::kCorridor && contains(core_, p, -radius_m);
    return contains(hull_, p, radius_m) && !in_core;
  }

  [[nodiscard]] bool is_apart(const Vector2d& p, double radius_m) const {
    return std::ranges::none_of(
        spots_, [&](const Spot& spot) { return (spot.centre_m - p).norm() < spot.radius_m + radius_m; });
  }

  std::optional<Spot> find_spot() {
    const double largest_m = std::min(kBlockRadiusMax_m, options_.margin_m - 0.1 - kClearance_m);
    for (int i = 0; i < kTries; ++i) {
      const Spot spot{draw_place(), random_.uniform(kBlockRadiusMin_m, largest_m)};
      if (is_on_floor(spot.centre_m, 0.7 * spot.radius_m) && is_apart(spot.centre_m, spot.radius_m) &&
          distance_m(path_, spot.centre_m) > kClearance_m + spot.radius_m)
        return spot;
    }
    return std::nullopt;
  }

  /// Within the spot: standing on the floor, or hanging from the ceiling.
  Block block_at(const Spot& spot) {
    const double slant_rad = random_.uniform(0.25 * kPi - 0.35, 0.25 * kPi + 0.35);
    Block block{.centre_m = spot.centre_m, .yaw_rad = random_.uniform(-kPi, kPi)};
    const double height_m = random_.uniform(0.3, 0.8 * options_.height_m);
    block.size_m = {2.0 * spot.radius_m * std::cos(slant_rad), 2.0 * spot.radius_m * std::sin(slant_rad),
                    height_m};
    if (random_.uniform() < 0.25) {
      block.size_m.z() = 0.5 * height_m;
      block.bottom_m = options_.height_m - block.size_m.z();
    }
    const double offset_m = random_.uniform(0.0, 1.28);
    block.texture_offset_m = {offset_m, random_.uniform(0.0, 1.28)};
    return block;
  }

  [[nodiscard]] bool is_free(const Walker& walker) const {
    const Vector2d line = walker.to_m - walker.from_m;
    for (double along_m = 0.0; along_m < line.norm(); along_m += 0.1) {
      const Vector2d p = walker.from_m + along_m * line.normalized();
      if (!is_on_floor(p, kWalkerRadius_m) || !is_apart(p, kWalkerRadius_m)) return false;
    }
    return line.norm() > kWalkMin_m;
  }

  const RoomOptions& options_;
  const Path& path_;
  Walls hull_;
  Walls core_;
  RandomStream random_;
  std::vector<Spot> spots_;
};

/// Paints textures one after the other, each from a stream of its own.
class Painter {
 public:
  Painter(std::vector<SummedMipmap>& textures, std::uint64_t seed) : textures_(textures), seed_(seed) {}

  template <class Paint>
  std::size_t add(Paint&& paint) {
    const std::size_t number = textures_.size();
    RandomStream random(seed_, StreamPurpose::kWorld, 3, static_cast<std::uint32_t>(number));
    textures_.emplace_back(paint(random));
    return number;
  }

  void add_walls(Walls& walls) {
    const Vector2d size = walls.high_m - walls.low_m;
    for (std::size_t i = 0; i < 4; ++i)
      walls.textures[i] =
          add([&](RandomStream& random) { return paint_wall(i % 2 == 0 ? size.x() : size.y(), random); });
  }

 private:
  std::vector<SummedMipmap>& textures_;
  std::uint64_t seed_;
};

/// A marker on its paper.
Rectangle plate(const WallMarker& marker, std::size_t texture) {
  const double cell_m = marker.size_m / kMarkerBlackCells;
  const double side_m = kMarkerCells * cell_m;
  const Eigen::Vector3d down = -Eigen::Vector3d::UnitZ();
  Rectangle paper{.corner_m = marker.centre_m - 0.5 * side_m * (marker.along_s + down),
                  .along_s = marker.along_s,
                  .along_t = down,
                  .width_m = side_m,
                  .height_m = side_m,
                  .texture = texture,
                  .texel_m = cell_m / kTexelsPerMarkerCell};
  paper.brightness = brightness_of(paper.normal());
  return paper;
}

}  // namespace

Walls hull_around(const RoomOptions& options, const Path& path) {
  return around(path, options.margin_m, options.height_m);
}

Walls core_inside(const RoomOptions& options, const Path& path) {
  return around(path, -options.margin_m, options.height_m);
}

Scene build_scene(const RoomOptions& options, const Path& path, std::uint64_t seed) {
  Scene scene;
  Painter painter(scene.textures, seed);
  Walls hull = hull_around(options, path);
  painter.add_walls(hull);
  const std::size_t floor = painter.add(paint_floor);
  add_hull(hull, floor, painter.add(paint_ceiling), scene.rectangles);
  if (options.scene == SceneKind::kCorridor) {
    Walls core = core_inside(options, path);
    painter.add_walls(core);
    add_core(core, scene.rectangles);
  }
  const std::size_t clothes = painter.add(paint_clothes);
  for (std::size_t i = 0; i < kFurnitureTextures; ++i) painter.add(paint_furniture);
  Interior interior(options, path, seed);
  for (const Block& block : interior.furniture(clothes + 1)) add_block(block, scene.rectangles);
  scene.walkers = interior.walkers(clothes);
  for (const WallMarker& marker : place_markers(options, path, seed)) {
    scene.rectangles.push_back(plate(marker, scene.textures.size()));
    scene.textures.emplace_back(paint_marker(marker.number));
  }
  return scene;
}

}  // namespace waymark::sim
