#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "waymark/core/stamp.hpp"

#include "workbench/sim/summed_mipmap.hpp"
#include "workbench/sim/textures.hpp"

namespace waymark::sim {

/// A painted rectangle in the world. Seen from its front, columns of the texture run along `along_s` (to the
/// right) and rows along `along_t` (downwards); from behind it is invisible.
struct Rectangle {
  Eigen::Vector3d corner_m = Eigen::Vector3d::Zero();   ///< upper left
  Eigen::Vector3d along_s = Eigen::Vector3d::UnitX();   ///< unit vector
  Eigen::Vector3d along_t = -Eigen::Vector3d::UnitZ();  ///< unit vector, perpendicular to along_s
  double width_m = 0.0;
  double height_m = 0.0;
  std::size_t texture = 0;
  Eigen::Vector2d texture_offset_m = Eigen::Vector2d::Zero();  ///< of the corner on the texture
  double texel_m = kTexel_m;                                   ///< side of a texel
  double brightness = 1.0;
  bool endless = false;  ///< of a hull: goes on behind its neighbours, so that no gap opens in a corner

  /// Unit vector towards those who see it.
  [[nodiscard]] Eigen::Vector3d normal() const;
};

/// A block that stands or hangs in the world, its sides upright.
struct Block {
  Eigen::Vector2d centre_m = Eigen::Vector2d::Zero();
  double yaw_rad = 0.0;
  double bottom_m = 0.0;
  Eigen::Vector3d size_m = Eigen::Vector3d::Ones();  ///< along its own x and y, and up
  std::size_t texture = 0;
  Eigen::Vector2d texture_offset_m = Eigen::Vector2d::Zero();
};

/// Somebody who walks to and fro on a line.
struct Walker {
  Eigen::Vector2d from_m = Eigen::Vector2d::Zero();
  Eigen::Vector2d to_m = Eigen::Vector2d::UnitX();
  double speed_mps = 1.0;
  std::size_t texture = 0;
};

/// The light on a surface with that normal: it comes from above and from one side, so that faces of one
/// block differ.
[[nodiscard]] double brightness_of(const Eigen::Vector3d& normal);

/// Everything that a camera can see.
struct Scene {
  std::vector<SummedMipmap> textures;
  std::vector<Rectangle> rectangles;
  std::vector<Walker> walkers;

  /// The rectangles at a moment: first those that stand still, always at the same places.
  [[nodiscard]] std::vector<Rectangle> at(Stamp when) const;
};

/// Four upright walls around an area, from the ground up.
struct Walls {
  Eigen::Vector2d low_m = Eigen::Vector2d::Zero();
  Eigen::Vector2d high_m = Eigen::Vector2d::Ones();
  double height_m = 2.5;
  std::array<std::size_t, 4> textures{};
};

/// The hull of a scene, to be seen from inside.
void add_hull(const Walls& walls, std::size_t floor_texture, std::size_t ceiling_texture,
              std::vector<Rectangle>& rectangles);
/// A core that one walks around.
void add_core(const Walls& walls, std::vector<Rectangle>& rectangles);
/// All six faces, lit by their direction.
void add_block(const Block& block, std::vector<Rectangle>& rectangles);

}  // namespace waymark::sim
