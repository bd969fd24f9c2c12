#include "waymark/markers/april_tag_detector.hpp"

#include <algorithm>
#include <tuple>

#include <apriltag/apriltag.h>
#include <apriltag/tag16h5.h>
#include <apriltag/tag25h9.h>
#include <apriltag/tag36h10.h>
#include <apriltag/tag36h11.h>

namespace waymark::markers {
namespace {

struct Family {
  std::string_view name;
  apriltag_family_t* (*create)();
  void (*destroy)(apriltag_family_t*);
};

constexpr std::array kFamilies{
    Family{"apriltag_16h5", tag16h5_create, tag16h5_destroy},
    Family{"apriltag_25h9", tag25h9_create, tag25h9_destroy},
    Family{"apriltag_36h10", tag36h10_create, tag36h10_destroy},
    Family{"apriltag_36h11", tag36h11_create, tag36h11_destroy},
};

/// libapriltag begins at the lower left, goes counter-clockwise, and counts from the edge of the first pixel.
Marker marker(const apriltag_detection_t& detection) {
  Marker found{detection.id, {}};
  for (std::size_t i = 0; i < 4; ++i)
    found.corners_px[i] = {detection.p[3 - i][0] - 0.5, detection.p[3 - i][1] - 0.5};
  return found;
}

class AprilTagDetector final : public MarkerDetector {
 public:
  AprilTagDetector(const Family& family, int corrected_bits)
      : destroy_(family.destroy), family_(family.create()), detector_(apriltag_detector_create()) {
    apriltag_detector_add_family_bits(detector_, family_, corrected_bits);
    detector_->nthreads = 1;
    detector_->quad_decimate = 1.0F;
    detector_->refine_edges = false;
  }
  AprilTagDetector(const AprilTagDetector&) = delete;
  AprilTagDetector& operator=(const AprilTagDetector&) = delete;
  ~AprilTagDetector() override {
    apriltag_detector_destroy(detector_);
    destroy_(family_);
  }

  std::vector<Marker> detect(const ImageView& image) override {
    // libapriltag has no view of what must not be written to, but without blur it does not write.
    image_u8_t pixels{image.width_px, image.height_px, static_cast<int>(image.stride),
                      const_cast<std::uint8_t*>(image.data)};
    zarray_t* detections = apriltag_detector_detect(detector_, &pixels);
    std::vector<Marker> found;
    for (int i = 0; i < zarray_size(detections); ++i) {
      apriltag_detection_t* detection = nullptr;
      zarray_get(detections, i, static_cast<void*>(&detection));
      found.push_back(marker(*detection));
    }
    apriltag_detections_destroy(detections);
    std::ranges::sort(found, {}, [](const Marker& each) {
      return std::tuple(each.id, each.corners_px[0].x(), each.corners_px[0].y());
    });
    return found;
  }

 private:
  void (*destroy_)(apriltag_family_t*);
  apriltag_family_t* family_;
  apriltag_detector_t* detector_;
};

}  // namespace

Result<std::unique_ptr<MarkerDetector>> make_april_tag_detector(const MarkerDictionary& dictionary) {
  const auto family = std::ranges::find(kFamilies, dictionary.name, &Family::name);
  return std::unique_ptr<MarkerDetector>(
      std::make_unique<AprilTagDetector>(*family, dictionary.corrected_bits));
}

}  // namespace waymark::markers
