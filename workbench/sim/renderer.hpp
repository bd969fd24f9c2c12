#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "waymark/core/aligned_array.hpp"
#include "waymark/core/grey_image.hpp"
#include "waymark/core/parallel.hpp"
#include "waymark/models/camera.hpp"

#include "workbench/sim/apply_image_noise.hpp"
#include "workbench/sim/scene.hpp"
#include "workbench/sim/trace_rays.hpp"

namespace waymark::sim {

/// Where a camera is and how it looks.
struct Viewpoint {
  Eigen::Matrix3d R_camera_world = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p_world_camera = Eigen::Vector3d::Zero();
};

/// Takes images of rectangles through a camera with distortion. One ray per pixel, its texture averaged
/// over the pixel; sixteen rays where pixels border on another surface, so that edges lie where they should
/// to a few hundredths of a pixel. The image is cut into tiles, and a tile looks only at rectangles that it
/// may see. Same bits on any number of threads and every processor.
class Renderer {
 public:
  static constexpr int kTileWidth = 32;
  /// How a ray changes from pixel to pixel.
  struct RayStep {
    float dx_du = 0.0F, dx_dv = 0.0F, dy_du = 0.0F, dy_dv = 0.0F;
  };

  /// Light must reach all of the camera's image. Both arguments are referred to.
  Renderer(const Camera& camera, ThreadPool& pool);

  /// Forgets all light.
  void clear();
  /// Adds `weight` times what is seen from a viewpoint.
  void expose(const std::vector<SummedMipmap>& textures, const std::vector<Rectangle>& rectangles,
              const Viewpoint& viewpoint, double weight);
  /// Turns the light into the grey values of a noisy image.
  [[nodiscard]] GreyImage apply_image_noise(const kernels::ImageNoiseModel& noise_model);

 private:
  /// A part of the image, in rays (x, y, 1).
  struct Bounds {
    float x_min = 0.0F, x_max = 0.0F, y_min = 0.0F, y_max = 0.0F;
  };
  /// A rectangle as this viewpoint sees it, and where.
  struct Seen {
    kernels::TexturedRectangle rectangle;
    Bounds bounds;
  };
  /// Of each pixel of one row of a tile: 1 at an edge.
  using EdgeRow = std::array<std::uint8_t, kTileWidth>;
  struct Tile {
    int u = 0, v = 0;  ///< its first pixel
    Bounds bounds;
    std::vector<kernels::TexturedRectangle> rectangles;
  };

  [[nodiscard]] static Bounds bounds_of(const std::vector<Eigen::Vector3d>& polygon_camera);
  [[nodiscard]] static bool may_see(const Bounds& bounds, const Seen& seen);
  static void remove_hidden(Tile& tile);

  void add_pixel(Tile& tile, int u, int v);
  void find_visible(const std::vector<SummedMipmap>& textures, const std::vector<Rectangle>& rectangles,
                    const Viewpoint& viewpoint);
  void trace(std::size_t index);
  void smooth_edges(const Tile& tile, std::size_t first_ray);
  void add_light(const Tile& tile, float weight);
  [[nodiscard]] EdgeRow edges_of(const Tile& tile, int v) const;
  [[nodiscard]] std::size_t place(int u, int v) const {
    return static_cast<std::size_t>(v) * stride_ + static_cast<std::size_t>(u);
  }

  const Camera& camera_;
  ThreadPool& pool_;
  int columns_, rows_;  ///< of tiles
  std::size_t stride_;  ///< of the arrays that hold whole rows of pixels
  std::vector<Tile> tiles_;
  AlignedArray<float> ray_x_, ray_y_;  ///< tile after tile
  std::vector<RayStep> ray_steps_;     ///< likewise
  AlignedArray<float> grey_, light_;
  AlignedArray<std::int32_t> ids_;
  std::vector<Seen> seen_;
};

}  // namespace waymark::sim
