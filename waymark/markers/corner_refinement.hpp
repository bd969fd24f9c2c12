#pragma once

#include <optional>

#include "waymark/core/grey_image.hpp"
#include "waymark/markers/corners.hpp"
#include "waymark/models/camera.hpp"

namespace waymark::markers {

/// Where the lines along the four sides of a black square cross. Points along each side are moved to where
/// the grey rises from inside to outside, a line is fitted to their rays, in which sides are straight
/// whatever the lens does to them, and neighbours are intersected. `corners_px` are good to a pixel or two;
/// `cells` is the number of cells along a side, the black border included, because the search must not reach
/// the next cell. Nothing where a side cannot be seen. Some 70 us for sides of 40 px.
[[nodiscard]] std::optional<RefinedCorners> refine_corners(const ImageView& image, const Camera& camera,
                                                           const Corners& corners_px, int cells);

}  // namespace waymark::markers
