#include "waymark/markers/marker_detector.hpp"

#include <string>

#include "waymark/markers/april_tag_detector.hpp"
#include "waymark/markers/aruco_detector.hpp"

namespace waymark::markers {

#ifndef WAYMARK_HAVE_APRILTAG
Result<std::unique_ptr<MarkerDetector>> make_april_tag_detector(const MarkerDictionary& dictionary) {
  return Error{"markers.dictionary: " + std::string(dictionary.name) +
               " needs libapriltag, which this build of Waymark lacks: install libapriltag-dev, configure "
               "with WAYMARK_WITH_APRILTAG=ON and build again, or use ArUco markers"};
}
#endif

bool can_detect([[maybe_unused]] MarkerKind kind) {
#ifdef WAYMARK_HAVE_APRILTAG
  return true;
#else
  return kind == MarkerKind::kAruco;
#endif
}

Result<std::unique_ptr<MarkerDetector>> make_marker_detector(const MarkerDictionary& dictionary) {
  if (dictionary.kind == MarkerKind::kAruco) return make_aruco_detector(dictionary);
  return make_april_tag_detector(dictionary);
}

}  // namespace waymark::markers
