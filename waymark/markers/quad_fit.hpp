#pragma once

#include <optional>

#include "waymark/markers/contours.hpp"
#include "waymark/markers/corners.hpp"

namespace waymark::markers {

/// The corners of the quadrilateral that a contour is, clockwise: lines through the points between its four
/// outermost points, by least squares, meet there. Nothing where it is no convex quadrilateral around
/// something dark, or its shortest side is below `side_min_px`.
[[nodiscard]] std::optional<Corners> fit_quad(const Contour& contour, double side_min_px);

}  // namespace waymark::markers
