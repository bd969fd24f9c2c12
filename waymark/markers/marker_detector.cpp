#include "waymark/markers/marker_detector.hpp"

#include <string>

#include "waymark/markers/april_tag_detector.hpp"
#include "waymark/markers/aruco_detector.hpp"

namespace waymark::markers {

#ifndef WAYMARK_HAVE_ARUCO
Result<std::unique_ptr<MarkerDetector>> make_aruco_detector(const MarkerDictionary& dictionary) {
  return Error{"markers.dictionary: " + std::string(dictionary.name) +
               " needs OpenCV, which this build of Waymark lacks: install libopencv-contrib-dev, configure "
               "with WAYMARK_WITH_OPENCV=ON and build again, or use AprilTags"};
}
#endif

#ifndef WAYMARK_HAVE_APRILTAG
Result<std::unique_ptr<MarkerDetector>> make_april_tag_detector(const MarkerDictionary& dictionary) {
  return Error{"markers.dictionary: " + std::string(dictionary.name) +
               " needs libapriltag, which this build of Waymark lacks: install libapriltag-dev, configure "
               "with WAYMARK_WITH_APRILTAG=ON and build again, or use ArUco markers"};
}
#endif

bool can_detect([[maybe_unused]] MarkerKind kind) {
#ifdef WAYMARK_HAVE_ARUCO
  if (kind == MarkerKind::kAruco) return true;
#endif
#ifdef WAYMARK_HAVE_APRILTAG
  if (kind == MarkerKind::kAprilTag) return true;
#endif
  return false;
}

Result<std::unique_ptr<MarkerDetector>> make_marker_detector(const MarkerDictionary& dictionary) {
  return dictionary.kind == MarkerKind::kAruco ? make_aruco_detector(dictionary)
                                               : make_april_tag_detector(dictionary);
}

}  // namespace waymark::markers
