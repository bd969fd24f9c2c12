#pragma once

#include <span>
#include <vector>

#include "waymark/core/stopwatch.hpp"
#include "waymark/ekf/pixel_slam.hpp"
#include "waymark/vision/tracker.hpp"

namespace waymark {

/// What a camera sees, brought to a filter over pixels: the filter says where to look, the tracker looks.
class CameraFrontEnd {
 public:
  /// `filter` must outlive it. `threads` as in vision::Tracker.
  CameraFrontEnd(PixelSlam& filter, const vision::TrackerOptions& options,
                 const vision::SearchOptions& search, const Camera& camera, int threads);

  /// Has it the size of the camera's pictures?
  [[nodiscard]] bool fits(const ImageView& image) const;

  /// A picture that was taken at the pose that the filter has reached: landmarks first, then candidates and
  /// new corners at the pose that these corrected. What both did, valid until the next call. The picture must
  /// fit. Allocates nothing in a steady state.
  const Correction& see(const ImageView& image);

  /// What became of everything that was looked for in the last picture.
  [[nodiscard]] std::span<const vision::Look> looks() const { return tracker_.looks(); }

  /// What landmarks look like: out of it, and into another one. Allocate.
  [[nodiscard]] std::vector<LandmarkPatch> patches() const { return tracker_.patches(); }
  void remember(std::span<const LandmarkPatch> patches) { tracker_.remember(patches); }

  [[nodiscard]] const vision::TrackerCounts& counts() const { return tracker_.counts(); }

  /// Blocks of filter and tracker in one table, by their names. Allocates.
  [[nodiscard]] std::vector<FunctionBlocks::Row> blocks() const;

 private:
  void begin(const ImageView& image);
  const Correction& correct(const vision::Sightings& sightings);
  void leave_time();

  PixelSlam& filter_;
  Camera camera_;
  bool on_the_clock_;
  vision::Tracker tracker_;
  std::vector<Innovation> innovations_;
  Correction correction_;
  Stopwatch stopwatch_;
  Duration filter_took_{0};  ///< in this picture
  Duration filter_takes_{0};
};

}  // namespace waymark
