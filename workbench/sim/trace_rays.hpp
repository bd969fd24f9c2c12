#pragma once

#include <cstddef>
#include <cstdint>

#include "workbench/sim/summed_mipmap_rows.hpp"

namespace waymark::kernels {

/// A linear function of a ray (x, y, 1) of a camera.
struct RayFunction {
  float x = 0.0F;
  float y = 0.0F;
  float z = 0.0F;
};

/// A textured rectangle as a camera sees it. Along the ray (x, y, 1), w = inverse_depth(ray) is one over the
/// depth of its plane, and s(ray) / w, t(ray) / w are the texture coordinates there, in texels with whole
/// numbers between texels.
struct TexturedRectangle {
  RayFunction inverse_depth;
  RayFunction s;
  RayFunction t;
  float s_min = 0.0F, s_max = 0.0F, t_min = 0.0F, t_max = 0.0F;
  const std::uint16_t* texels = nullptr;
  MipmapLayout layout;
  float gain = 1.0F;    ///< grey per texel value
  std::int32_t id = 0;  ///< at least 0
};

/// Rays (x[i], y[i], 1), and how far apart neighbouring ones are: the patch of a surface that each averages.
/// Arrays are aligned and padded to kRayLanes.
struct Rays {
  const float* x = nullptr;
  const float* y = nullptr;
  float spacing_x = 0.0F;
  float spacing_y = 0.0F;
};

inline constexpr std::size_t kRayLanes = 16;

/// What each of `count` rays hits first: grey, texture filtered over the spacing, and the rectangle's id; 0
/// and -1 where there is nothing. Same bits on every processor. Some 7 ns per ray among a few rectangles,
/// most of it waiting for texels.
void trace_rays(const Rays& rays, std::size_t count, const TexturedRectangle* rectangles,
                std::size_t rectangle_count, float* grey, std::int32_t* id);

namespace reference {
void trace_rays(const Rays& rays, std::size_t count, const TexturedRectangle* rectangles,
                std::size_t rectangle_count, float* grey, std::int32_t* id);
}  // namespace reference
}  // namespace waymark::kernels
