#pragma once

#include <span>
#include <vector>

#include "waymark/association/gate.hpp"
#include "waymark/core/expectation.hpp"
#include "waymark/core/filter.hpp"
#include "waymark/core/function_blocks.hpp"
#include "waymark/ekf/state.hpp"
#include "waymark/models/camera.hpp"

namespace waymark {

struct PixelSlamOptions {
  int capacity = 100;  ///< most landmarks in the map
};

void describe(Schema& schema, PixelSlamOptions& options);

/// EKF-SLAM over the pixels of points in space (Vincke et al. 2012). It sees no image: who looks for its
/// landmarks asks expect() where to look, and reports what it found (correct()) and what not (missed()).
/// A pixel with an identity that is not known begins a candidate, whose distance later pixels find out.
class PixelSlam final : public Filter {
 public:
  PixelSlam(const PixelSlamOptions& options, const GateOptions& gate, const CameraOptions& camera);

  void predict(const Motion& motion) override;
  /// Landmarks and candidates that should be in the picture, at the present pose. Valid until the next call
  /// of anything that changes the filter.
  [[nodiscard]] std::span<const Expectation> expect();
  /// Looked for where it was expected, and not found.
  void missed(std::span<const LandmarkId> landmarks);
  /// Pixel observations; may be called several times per picture. Correction::removed names those (landmarks
  /// and candidates) that nobody needs to look for any more.
  const Correction& correct(std::span<const Observation> observations) override;
  [[nodiscard]] PoseEstimate pose() const override;
  [[nodiscard]] Snapshot snapshot() const override;
  [[nodiscard]] MapState save() const override;
  [[nodiscard]] const FunctionBlocks& blocks() const override { return blocks_; }

 private:
  Correction correction_;
  FunctionBlocks blocks_{"FB1 predict",  "FB3 project", "FB5 Jacobians",
                         "FB6 estimate", "FB8 weights", "FB9 add"};
};

}  // namespace waymark
