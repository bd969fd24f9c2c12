#pragma once

#include <memory>
#include <vector>

#include "waymark/core/event.hpp"
#include "waymark/core/grey_image.hpp"
#include "waymark/core/result.hpp"
#include "waymark/markers/corners.hpp"
#include "waymark/markers/marker_dictionary.hpp"

namespace waymark::markers {

/// A marker in an image, its corners to about a pixel; the centre of the first pixel is at (0, 0).
using Marker = MarkerOutline;

/// Finds the markers of one dictionary. Not to be called from two threads at once; starts none.
class MarkerDetector {
 public:
  MarkerDetector() = default;
  MarkerDetector(const MarkerDetector&) = delete;
  MarkerDetector& operator=(const MarkerDetector&) = delete;
  virtual ~MarkerDetector() = default;

  /// Ordered by identity, then from left to right; one identity may appear more than once. 3 to 6 ms for
  /// 640 x 480 pixels.
  [[nodiscard]] virtual std::vector<Marker> detect(const ImageView& image) = 0;
};

/// Does this build find markers of that kind?
[[nodiscard]] bool can_detect(MarkerKind kind);

/// A detector for the dictionary, or that this build lacks what it takes.
[[nodiscard]] Result<std::unique_ptr<MarkerDetector>> make_marker_detector(
    const MarkerDictionary& dictionary);

}  // namespace waymark::markers
