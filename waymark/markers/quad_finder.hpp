#pragma once

#include <vector>

#include "waymark/core/grey_image.hpp"
#include "waymark/markers/contours.hpp"
#include "waymark/markers/corners.hpp"
#include "waymark/markers/local_contrast.hpp"

namespace waymark::markers {

/// Finds dark quadrilaterals on brighter ground, the outlines of markers among them. Not to be called from
/// two threads at once; its memory is used again.
class QuadFinder {
 public:
  /// Their corners, clockwise in the image, to about a pixel; the same one more than once where several
  /// looks show it. Sides are of 5 pixels or more. 3 to 5 ms for 640 x 480 pixels.
  [[nodiscard]] std::vector<Corners> find(const ImageView& image);

 private:
  ContrastMap map_;
  ContourTracer tracer_;
  GreyImage halved_;
};

}  // namespace waymark::markers
