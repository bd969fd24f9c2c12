#include "workbench/sim/renderer.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>

#include "workbench/sim/textures.hpp"

namespace waymark::sim {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using kernels::RayFunction;
using kernels::TexturedRectangle;

constexpr int kTileWidth = Renderer::kTileWidth;
constexpr int kTileHeight = 16;
constexpr std::size_t kTileRays = kTileWidth * kTileHeight;
// Rows of pixels are padded to this.
constexpr int kNoiseWidth = static_cast<int>(kernels::kNoisePixels);
static_assert(kTileRays % kernels::kRayLanes == 0 && kNoiseWidth % kTileWidth == 0);
constexpr std::size_t kRaysAtEdge = 16;
// As wide apart, in parts of a pixel, as if they stood in rows.
constexpr float kSpacingAtEdge = 0.25F;
constexpr double kNear_m = 0.005;
constexpr float kEndless = 1e9F;

RayFunction ray_function(const Vector3d& f) {
  return {static_cast<float>(f.x()), static_cast<float>(f.y()), static_cast<float>(f.z())};
}

float along(const RayFunction& f, float x, float y) { return f.x * x + f.y * y + f.z; }

/// The part of a polygon in front of the camera.
std::vector<Vector3d> clip_near(const std::array<Vector3d, 4>& polygon) {
  std::vector<Vector3d> inside;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector3d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    if (a.z() >= kNear_m) inside.push_back(a);
    if ((a.z() >= kNear_m) != (b.z() >= kNear_m))
      inside.emplace_back(a + (kNear_m - a.z()) / (b.z() - a.z()) * (b - a));
  }
  return inside;
}

std::vector<Vector3d> visible_polygon(const Rectangle& r, const Viewpoint& from) {
  const Vector3d s = r.width_m * r.along_s, t = r.height_m * r.along_t;
  std::array<Vector3d, 4> corners{r.corner_m, r.corner_m + s, r.corner_m + s + t, r.corner_m + t};
  for (Vector3d& corner : corners) corner = from.R_camera_world * (corner - from.p_world_camera);
  return clip_near(corners);
}

/// Of the plane n . (P - corner) = 0 with P = camera + depth * ray: one over the depth, and texture
/// coordinates times that.
TexturedRectangle seen_from(const Rectangle& r, const Viewpoint& from, double height_m,
                            const SummedMipmap& texture, std::int32_t id) {
  const Vector3d inverse_depth = -(from.R_camera_world * r.normal()) / height_m;
  const Vector3d from_corner = from.p_world_camera - r.corner_m;
  const auto coordinate = [&](const Vector3d& axis, double offset_m) {
    const double here = (offset_m + axis.dot(from_corner)) / r.texel_m;
    return ray_function(here * inverse_depth + from.R_camera_world * axis / r.texel_m);
  };
  const Vector2d first = r.texture_offset_m / r.texel_m;
  const Vector2d last = first + Vector2d(r.width_m, r.height_m) / r.texel_m;
  const auto limit = [&](double value, float endless) {
    return r.endless ? endless : static_cast<float>(value);
  };
  return {.inverse_depth = ray_function(inverse_depth),
          .s = coordinate(r.along_s, r.texture_offset_m.x()),
          .t = coordinate(r.along_t, r.texture_offset_m.y()),
          .s_min = limit(first.x(), -kEndless),
          .s_max = limit(last.x(), kEndless),
          .t_min = limit(first.y(), -kEndless),
          .t_max = limit(last.y(), kEndless),
          .texels = texture.texels(),
          .layout = texture.layout(),
          .gain = static_cast<float>(r.brightness),
          .id = id};
}

int tiles_over(int pixels, int side) { return (pixels + side - 1) / side; }

/// Up to this many pixels at edges are traced together.
constexpr std::size_t kBatch = 32;

/// Where in its pixel a ray goes through, in pixels from the middle.
struct SubRayOffsets {
  std::array<float, kRaysAtEdge> du{}, dv{};
};

// Hammersley's points: all columns differ and all rows, so that edges along either move evenly.
constexpr SubRayOffsets sub_ray_offsets() {
  SubRayOffsets offsets;
  for (std::size_t k = 0; k < kRaysAtEdge; ++k) {
    const std::size_t reversed = (k & 1) << 3 | (k & 2) << 1 | (k & 4) >> 1 | (k & 8) >> 3;
    offsets.du[k] = (static_cast<float>(k) + 0.5F) / kRaysAtEdge - 0.5F;
    offsets.dv[k] = (static_cast<float>(reversed) + 0.5F) / kRaysAtEdge - 0.5F;
  }
  return offsets;
}

/// Rays of pixels at edges, and what they saw.
struct Batch {
  using RayStep = Renderer::RayStep;

  alignas(64) std::array<float, kBatch * kRaysAtEdge> x;
  alignas(64) std::array<float, kBatch * kRaysAtEdge> y;
  alignas(64) std::array<float, kBatch * kRaysAtEdge> grey;
  alignas(64) std::array<std::int32_t, kBatch * kRaysAtEdge> id;
  std::array<std::size_t, kBatch> places;
  std::size_t pixels = 0;

  void add(float ray_x, float ray_y, const RayStep& step, std::size_t place) {
    constexpr auto kOffsets = sub_ray_offsets();
    float* sub_x = x.data() + pixels * kRaysAtEdge;
    float* sub_y = y.data() + pixels * kRaysAtEdge;
    for (std::size_t k = 0; k < kRaysAtEdge; ++k) {
      sub_x[k] = ray_x + kOffsets.du[k] * step.dx_du + kOffsets.dv[k] * step.dx_dv;
      sub_y[k] = ray_y + kOffsets.du[k] * step.dy_du + kOffsets.dv[k] * step.dy_dv;
    }
    places[pixels++] = place;
  }

  void trace(const std::vector<TexturedRectangle>& rectangles, float spacing_x, float spacing_y,
             float* image) {
    kernels::trace_rays({x.data(), y.data(), spacing_x * kSpacingAtEdge, spacing_y * kSpacingAtEdge},
                        pixels * kRaysAtEdge, rectangles.data(), rectangles.size(), grey.data(), id.data());
    for (std::size_t i = 0; i < pixels; ++i) {
      float sum = 0.0F;
      for (std::size_t k = 0; k < kRaysAtEdge; ++k) sum += grey[i * kRaysAtEdge + k];
      image[places[i]] = sum / kRaysAtEdge;
    }
    pixels = 0;
  }
};

}  // namespace

Renderer::Renderer(const Camera& camera, ThreadPool& pool)
    : camera_(camera),
      pool_(pool),
      columns_(tiles_over(camera.width_px(), kNoiseWidth) * (kNoiseWidth / kTileWidth)),
      rows_(tiles_over(camera.height_px(), kTileHeight)),
      stride_(static_cast<std::size_t>(columns_) * kTileWidth),
      ray_x_(stride_ * static_cast<std::size_t>(rows_) * kTileHeight),
      ray_y_(ray_x_.size()),
      grey_(ray_x_.size()),
      light_(ray_x_.size()),
      ids_(ray_x_.size()) {
  for (int row = 0; row < rows_; ++row) {
    for (int column = 0; column < columns_; ++column) {
      constexpr float kFar = std::numeric_limits<float>::infinity();
      Tile& tile =
          tiles_.emplace_back(Tile{column * kTileWidth, row * kTileHeight, {kFar, -kFar, kFar, -kFar}, {}});
      for (int v = 0; v < kTileHeight; ++v)
        for (int u = 0; u < kTileWidth; ++u) add_pixel(tile, tile.u + u, tile.v + v);
    }
  }
}

// Tiles reach beyond the image, where they see what its last pixels see.
void Renderer::add_pixel(Tile& tile, int u, int v) {
  const Vector2d pixel(std::min(u, camera_.width_px() - 1), std::min(v, camera_.height_px() - 1));
  const PixelRay ray = camera_.ray(pixel).value();
  const auto x = static_cast<float>(ray.xy.x());
  const auto y = static_cast<float>(ray.xy.y());
  const Eigen::Matrix2f step = ray.dxy_dpixel.cast<float>();
  ray_x_[ray_steps_.size()] = x;
  ray_y_[ray_steps_.size()] = y;
  ray_steps_.push_back({step(0, 0), step(0, 1), step(1, 0), step(1, 1)});
  // Rays of the pixel itself go half a pixel to either side.
  const float reach_x = 0.6F * (std::abs(step(0, 0)) + std::abs(step(0, 1)));
  const float reach_y = 0.6F * (std::abs(step(1, 0)) + std::abs(step(1, 1)));
  tile.bounds = {std::min(tile.bounds.x_min, x - reach_x), std::max(tile.bounds.x_max, x + reach_x),
                 std::min(tile.bounds.y_min, y - reach_y), std::max(tile.bounds.y_max, y + reach_y)};
}

Renderer::Bounds Renderer::bounds_of(const std::vector<Vector3d>& polygon_camera) {
  constexpr float kFar = std::numeric_limits<float>::infinity();
  Bounds b{kFar, -kFar, kFar, -kFar};
  for (const Vector3d& p : polygon_camera) {
    const auto x = static_cast<float>(p.x() / p.z());
    const auto y = static_cast<float>(p.y() / p.z());
    b = {std::min(b.x_min, x), std::max(b.x_max, x), std::min(b.y_min, y), std::max(b.y_max, y)};
  }
  return b;
}

bool Renderer::may_see(const Bounds& b, const Seen& seen) {
  const Bounds& other = seen.bounds;
  return b.x_min <= other.x_max && b.x_max >= other.x_min && b.y_min <= other.y_max && b.y_max >= other.y_min;
}

void Renderer::find_visible(const std::vector<SummedMipmap>& textures,
                            const std::vector<Rectangle>& rectangles, const Viewpoint& viewpoint) {
  constexpr float kFar = std::numeric_limits<float>::infinity();
  seen_.clear();
  for (std::size_t i = 0; i < rectangles.size(); ++i) {
    const Rectangle& r = rectangles[i];
    const double height_m = r.normal().dot(viewpoint.p_world_camera - r.corner_m);
    if (height_m < 1e-6) continue;
    const auto polygon = visible_polygon(r, viewpoint);
    if (polygon.empty() && !r.endless) continue;
    seen_.push_back({seen_from(r, viewpoint, height_m, textures[r.texture], static_cast<std::int32_t>(i)),
                     r.endless ? Bounds{-kFar, kFar, -kFar, kFar} : bounds_of(polygon)});
  }
}

// Over a tile, one over the depth of a plane is a linear function: what is farther in its four corners than a
// rectangle that fills the tile is hidden by it.
void Renderer::remove_hidden(Tile& tile) {
  const Bounds& b = tile.bounds;
  const std::array<std::pair<float, float>, 4> corners{
      {{b.x_min, b.y_min}, {b.x_max, b.y_min}, {b.x_min, b.y_max}, {b.x_max, b.y_max}}};
  const auto fills = [&](const TexturedRectangle& r) {
    return std::ranges::all_of(corners, [&](const auto& c) {
      const float w = along(r.inverse_depth, c.first, c.second);
      const float s = along(r.s, c.first, c.second), t = along(r.t, c.first, c.second);
      return w > 0.0F && s > r.s_min * w && s < r.s_max * w && t > r.t_min * w && t < r.t_max * w;
    });
  };
  const auto is_behind = [&](const TexturedRectangle& r, const TexturedRectangle& front) {
    return std::ranges::all_of(corners, [&](const auto& c) {
      return along(r.inverse_depth, c.first, c.second) < along(front.inverse_depth, c.first, c.second);
    });
  };
  auto& all = tile.rectangles;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!fills(all[i])) continue;
    const TexturedRectangle front = all[i];
    std::erase_if(all, [&](const TexturedRectangle& r) { return is_behind(r, front); });
    i = static_cast<std::size_t>(std::ranges::find(all, front.id, &TexturedRectangle::id) - all.begin());
  }
}

void Renderer::trace(std::size_t index) {
  Tile& tile = tiles_[index];
  tile.rectangles.clear();
  for (const Seen& seen : seen_)
    if (may_see(tile.bounds, seen)) tile.rectangles.push_back(seen.rectangle);
  remove_hidden(tile);
  alignas(64) std::array<float, kTileRays> grey;
  alignas(64) std::array<std::int32_t, kTileRays> ids;
  const std::size_t first = index * kTileRays;
  const CameraOptions& options = camera_.options();
  kernels::trace_rays({ray_x_.data() + first, ray_y_.data() + first, static_cast<float>(1.0 / options.fu_px),
                       static_cast<float>(1.0 / options.fv_px)},
                      kTileRays, tile.rectangles.data(), tile.rectangles.size(), grey.data(), ids.data());
  for (int v = 0; v < kTileHeight; ++v) {
    std::copy_n(grey.data() + v * kTileWidth, kTileWidth, grey_.data() + place(tile.u, tile.v + v));
    std::copy_n(ids.data() + v * kTileWidth, kTileWidth, ids_.data() + place(tile.u, tile.v + v));
  }
}

// Beside pixels that see another rectangle than one of their four neighbours the surface may end.
Renderer::EdgeRow Renderer::edges_of(const Tile& tile, int v) const {
  const std::int32_t* here = ids_.data() + place(tile.u, v);
  const std::int32_t* above = v > 0 ? here - stride_ : here;
  const std::int32_t* below = v + 1 < camera_.height_px() ? here + stride_ : here;
  EdgeRow edges{};
  for (std::size_t u = 0; u < kTileWidth; ++u)
    edges[u] = static_cast<std::uint8_t>((here[u] != above[u]) | (here[u] != below[u]));
  for (std::size_t u = 0; u + 1 < kTileWidth; ++u) {
    const auto ends = static_cast<std::uint8_t>(here[u] != here[u + 1]);
    edges[u] |= ends;
    edges[u + 1] |= ends;
  }
  if (tile.u > 0) edges.front() |= static_cast<std::uint8_t>(here[0] != here[-1]);
  if (tile.u + kTileWidth < camera_.width_px())
    edges.back() |= static_cast<std::uint8_t>(here[kTileWidth - 1] != here[kTileWidth]);
  return edges;
}

void Renderer::smooth_edges(const Tile& tile, std::size_t first_ray) {
  const auto spacing_x = static_cast<float>(1.0 / camera_.options().fu_px);
  const auto spacing_y = static_cast<float>(1.0 / camera_.options().fv_px);
  const int width = std::min(kTileWidth, camera_.width_px() - tile.u);
  Batch batch;
  for (int v = 0; v < std::min(kTileHeight, camera_.height_px() - tile.v); ++v) {
    const EdgeRow edges = edges_of(tile, tile.v + v);
    for (int u = 0; u < width; ++u) {
      if (edges[static_cast<std::size_t>(u)] == 0) continue;
      const std::size_t ray = first_ray + static_cast<std::size_t>(v * kTileWidth + u);
      batch.add(ray_x_[ray], ray_y_[ray], ray_steps_[ray], place(tile.u + u, tile.v + v));
      if (batch.pixels == kBatch) batch.trace(tile.rectangles, spacing_x, spacing_y, grey_.data());
    }
  }
  if (batch.pixels > 0) batch.trace(tile.rectangles, spacing_x, spacing_y, grey_.data());
}

void Renderer::add_light(const Tile& tile, float weight) {
  for (int v = tile.v; v < tile.v + kTileHeight; ++v) {
    const float* grey = grey_.data() + place(tile.u, v);
    float* light = light_.data() + place(tile.u, v);
    for (int u = 0; u < kTileWidth; ++u) light[u] += weight * grey[u];
  }
}

void Renderer::clear() { std::fill_n(light_.data(), light_.size(), 0.0F); }

void Renderer::expose(const std::vector<SummedMipmap>& textures, const std::vector<Rectangle>& rectangles,
                      const Viewpoint& viewpoint, double weight) {
  find_visible(textures, rectangles, viewpoint);
  const int count = static_cast<int>(tiles_.size());
  pool_.run(count, [&](int i) { trace(static_cast<std::size_t>(i)); });
  // Edges show in the ids of the neighbouring tiles too, so all must be there.
  pool_.run(count, [&](int i) {
    const auto index = static_cast<std::size_t>(i);
    smooth_edges(tiles_[index], index * kTileRays);
    add_light(tiles_[index], static_cast<float>(weight));
  });
}

GreyImage Renderer::apply_image_noise(const kernels::ImageNoiseModel& noise_model) {
  const int height = camera_.height_px();
  const auto width = static_cast<std::size_t>(camera_.width_px());
  GreyImage image(camera_.width_px(), height);
  pool_.run(rows_, [&](int band) {
    AlignedArray<float> scratch(stride_ + 2 * kernels::kRayLanes);
    AlignedArray<float> noise(stride_);
    std::vector<std::uint8_t> out(stride_);
    for (int v = band * kTileHeight; v < std::min(height, (band + 1) * kTileHeight); ++v) {
      std::array<const float*, 2 * kernels::kBlurRadiusMax + 1> rows{};
      for (int k = 0; k < static_cast<int>(rows.size()); ++k)
        rows[static_cast<std::size_t>(k)] =
            light_.data() + place(0, std::clamp(v + k - kernels::kBlurRadiusMax, 0, height - 1));
      kernels::apply_image_noise(noise_model, static_cast<std::uint32_t>(v), rows.data(), width,
                                 scratch.data(), noise.data(), out.data());
      std::copy_n(out.data(), width, image.data() + std::ptrdiff_t{v} * image.stride());
    }
  });
  return image;
}

}  // namespace waymark::sim
