#pragma once

#include <span>
#include <vector>

#include "waymark/core/stopwatch.hpp"
#include "waymark/ekf/pixel_slam.hpp"
#include "waymark/slam/front_end.hpp"
#include "waymark/vision/tracker.hpp"

namespace waymark {

/// Camera front end of a filter over pixels: the filter predicts where landmarks are in the image, the
/// tracker searches for them there.
class CornerFrontEnd final : public FrontEnd {
 public:
  /// `filter` must outlive it. `threads` as in vision::Tracker.
  CornerFrontEnd(PixelSlam& filter, const vision::TrackerOptions& options,
                 const vision::SearchOptions& search, const Camera& camera, int threads);

  [[nodiscard]] bool fits(const ImageView& image) const override;
  [[nodiscard]] bool corrects_filter() const override { return true; }

  /// Landmarks first, then candidates and new corners at the pose that these corrected. Allocates nothing in
  /// a steady state.
  Seen see(const SharedImage& image) override { return &see(*image); }
  const Correction& see(const ImageView& image);

  [[nodiscard]] std::span<const FunctionBlocks::Row> blocks() const override {
    return tracker_.blocks().rows();
  }
  [[nodiscard]] std::vector<std::string> notes(std::span<const Innovation> innovations) const override;
  [[nodiscard]] std::span<const vision::SearchRecord> search_records() const override {
    return tracker_.search_records();
  }
  [[nodiscard]] std::vector<LandmarkPatch> patches() const override { return tracker_.patches(); }
  [[nodiscard]] vision::TrackerCounts tracker_counts() const override { return tracker_.counts(); }

  /// What landmarks of a saved map look like. Allocates.
  void remember(std::span<const LandmarkPatch> patches) { tracker_.remember(patches); }

 private:
  const Correction& correct(const vision::SearchOutcome& outcome);
  void leave_time();

  PixelSlam& filter_;
  Camera camera_;
  bool on_the_clock_;
  vision::Tracker tracker_;
  std::vector<Innovation> innovations_;
  Correction correction_;
  Stopwatch stopwatch_;
  Duration filter_took_{0};  ///< in this image
  Duration filter_takes_{0};
};

}  // namespace waymark
