#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "waymark/core/result.hpp"
#include "waymark/models/camera.hpp"

#include "workbench/calibrate/board.hpp"
#include "workbench/logs/image_file.hpp"

namespace waymark::calibrate {

/// The intrinsics in this order: fu, fv, cu, cv, k1, k2, p1, p2, k3.
inline constexpr int kIntrinsics = 9;
using Intrinsics = Eigen::Matrix<double, kIntrinsics, 1>;
using IntrinsicsCovariance = Eigen::Matrix<double, kIntrinsics, kIntrinsics>;

[[nodiscard]] Intrinsics intrinsics_of(const CameraOptions& camera);
[[nodiscard]] CameraOptions with_intrinsics(CameraOptions camera, const Intrinsics& values);

/// How a pixel depends on them, for the pixel of a point in the camera frame: 2 x 9.
[[nodiscard]] Eigen::Matrix<double, 2, kIntrinsics> intrinsics_jacobian(const Camera& camera,
                                                                        const Eigen::Vector3d& p_camera);

/// Which terms of the lens are estimated; the others are zero.
enum class Lens {
  kFourTerms,  ///< k1, k2, p1, p2
  kFiveTerms,  ///< and k3
};

/// A board as one view shows it.
struct FittedView {
  Eigen::Isometry3d T_camera_board = Eigen::Isometry3d::Identity();
  std::vector<Eigen::Vector2d> residuals_px;  ///< found less expected, in the order of the corners

  [[nodiscard]] double rms_px() const;  ///< of the length of a residual
};

struct CameraFit {
  CameraOptions camera;
  /// For errors of corners that are independent and as large as the residuals; zero where a term is fixed.
  IntrinsicsCovariance covariance = IntrinsicsCovariance::Zero();
  std::vector<FittedView> views;
  double rms_px = 0.0;  ///< over all corners, of the length of a residual

  [[nodiscard]] Intrinsics sigma() const { return covariance.diagonal().cwiseSqrt(); }
};

/// A view has at least so many corners, not all on a line; so many views make a camera that is of use.
inline constexpr int kMinCorners = 6;
inline constexpr int kMinViews = 3;
/// Fewer leave intrinsics open: a homography has two numbers more than a pose (Zhang, section 3.1).
inline constexpr int kFewestViews = 2;

/// Camera and poses of the board by least squares over all corners: Levenberg-Marquardt, the poses eliminated
/// from each step, from a start by the homographies of the views (Zhang, "A flexible new technique for camera
/// calibration", PAMI 2000). Some 10 ms for 15 views of 54 corners. An error: fewer than kFewestViews views,
/// or views that leave the camera open.
[[nodiscard]] Result<CameraFit> fit_camera(const Board& board, std::span<const BoardCorners> views,
                                           ImageSize size, Lens lens);

/// The board's pose alone, for a camera that is known; nothing where the corners fit no pose.
[[nodiscard]] std::optional<FittedView> fit_pose(const Board& board, const BoardCorners& corners,
                                                 const CameraOptions& camera);

/// Root mean square length of the residuals of several views.
[[nodiscard]] double rms_px(std::span<const FittedView> views);

}  // namespace waymark::calibrate
