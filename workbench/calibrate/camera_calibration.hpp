#pragma once

#include <optional>
#include <string>
#include <vector>

#include "workbench/calibrate/camera_fit.hpp"
#include "workbench/calibrate/projection_sigma.hpp"
#include "workbench/calibrate/two_cameras.hpp"
#include "workbench/calibrate/view.hpp"

namespace waymark::calibrate {

/// What makes a set of views weak, and what to photograph to mend it.
struct Weakness {
  std::string what;
  std::string advice;
};

/// What is known of a camera that was fitted without some of the views, in turn.
struct HeldOutErrors {
  int folds = 0;
  double rms_px = 0.0;  ///< of the views left out, their poses fitted, the camera not
  /// Between the cameras of the folds: delete-a-group jackknife (Shao and Tu, "The Jackknife and Bootstrap",
  /// 1995, section 2.3). Also sees errors that all corners of a view share, as a bent or blurred board makes.
  Intrinsics sigma = Intrinsics::Zero();
  double shortest_focal_px = 0.0;  ///< of the folds, mean of fu and fv
  double longest_focal_px = 0.0;
};

struct CameraCalibration {
  Board board;
  std::vector<BoardView> views;  ///< all of them, in the order that they came
  Lens lens = Lens::kFourTerms;
  double k3_in_sigmas = 0.0;  ///< where it was tried
  CameraFit fit;              ///< its views are those used, in their order
  HeldOutErrors held_out;
  std::vector<ProjectionSigma> projection;
  double covered = 0.0;                   ///< part of the cells of a grid over the image with corners in them
  std::optional<TwoCameras> two_cameras;  ///< where the views are not all of one
  std::vector<Weakness> weaknesses;

  [[nodiscard]] bool is_weak() const { return !weaknesses.empty(); }
  [[nodiscard]] std::size_t used() const { return fit.views.size(); }
};

/// Drops what is of another size, blurred or an outlier, fits the camera with the terms that the views
/// support, tests it on views left out, and judges the set. An error: too few views are left.
[[nodiscard]] Result<CameraCalibration> calibrate_camera(const Board& board, std::vector<BoardView> views);

/// Angle between the board and the image plane, degrees.
[[nodiscard]] double tilt_deg(const FittedView& view);
/// From the camera to the middle of the corners, in units of the board's lengths.
[[nodiscard]] double distance_m(const FittedView& view, const Board& board);

}  // namespace waymark::calibrate
