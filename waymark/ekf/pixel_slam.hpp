#pragma once

#include <optional>
#include <span>
#include <vector>

#include "waymark/core/expectation.hpp"
#include "waymark/core/filter.hpp"
#include "waymark/core/function_blocks.hpp"
#include "waymark/ekf/bounded_map.hpp"
#include "waymark/ekf/depth_initialiser.hpp"
#include "waymark/ekf/pixel_map.hpp"
#include "waymark/ekf/pixel_prediction.hpp"
#include "waymark/ekf/pixel_slam_options.hpp"
#include "waymark/ekf/pixel_update.hpp"
#include "waymark/models/camera.hpp"

namespace waymark {

/// EKF-SLAM with 3-D points observed as pixels (Vincke et al. 2012 \cite vincke2012). It handles no
/// images: the front end asks expect() where to search for landmarks, and tells correct() which were
/// found and which were not. A pixel of a new identity starts a candidate, whose depth is estimated from
/// later pixels.
class PixelSlam final : public Filter {
 public:
  /// `threads` share updates of large maps; the result does not depend on them. Takes all its memory here.
  /// One object must not be used by two threads at once; two objects may.
  PixelSlam(const PixelSlamOptions& options, const CameraOptions& camera, int threads = 1);

  /// Goes on from a saved map of points; only before anything was predicted or seen. Changes nothing where it
  /// does not fit. A landmark without patch is taken to have been seen from where the map ends.
  [[nodiscard]] Result<void> load(const MapState& map) { return map_.load(map); }

  void predict(const Motion& motion) override;
  /// Landmarks and candidates that should be in the image, at the present pose. Begins an image: call it
  /// once per image. Valid until the next call of anything that changes the filter.
  [[nodiscard]] std::span<const Expectation> expect();
  /// Pixels that were found, and who was looked for where it was expected and not found; may be called
  /// several times per image. Correction::removed names those (landmarks and candidates) that nobody needs
  /// to look for any more since the image began.
  const Correction& correct(std::span<const Observation> found, std::span<const LandmarkId> missed);
  const Correction& correct(std::span<const Observation> observations) override {
    return correct(observations, {});
  }
  [[nodiscard]] PoseEstimate pose() const override { return map().state().pose(); }
  [[nodiscard]] Snapshot snapshot() const override;
  [[nodiscard]] MapState save() const override { return map_.save(); }
  [[nodiscard]] const FunctionBlocks& blocks() const override { return blocks_; }

  [[nodiscard]] const ekf::PixelMap& map() const { return map_.map(); }
  [[nodiscard]] int candidates() const { return initialiser_.size(); }

 private:
  void begin_image();
  void miss(std::span<const LandmarkId> landmarks);
  void identify(std::span<const Observation> observations);
  [[nodiscard]] Outcome what_is(std::size_t index) const;
  void update(std::span<const Observation> observations);
  void convert_rays();
  void weigh_candidates(std::span<const Observation> observations);
  void accept(Innovation& innovation, const Eigen::Vector2d& z_px, const Eigen::Matrix2d& R);
  void begin_candidates(std::span<const Observation> observations);

  ekf::PixelPrediction prediction_;
  ekf::BoundedMap map_;
  ekf::DepthInitialiser initialiser_;
  ekf::PixelUpdate update_;
  bool in_image_ = false;

  std::vector<Expectation> expectations_;
  std::vector<Innovation> innovations_;
  std::vector<ekf::FoundPixel> found_;
  std::vector<std::size_t> found_in_;  // the observations that found_ is of
  Correction correction_;
  // Vincke Table 1
  FunctionBlocks blocks_{"FB1 predict",  "FB3 project", "FB5 Jacobians",
                         "FB6 estimate", "FB8 weights", "FB9 add"};
};

}  // namespace waymark
