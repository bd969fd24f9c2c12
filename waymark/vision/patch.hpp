#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include <Eigen/Core>

#include "waymark/core/grey_image.hpp"
#include "waymark/kernels/zmssd.hpp"
#include "waymark/models/camera.hpp"

namespace waymark::vision {

/// A square of n x n grey pixels around a place p: columns and rows p - n/2 to p + n - n/2 - 1, so p - 8 to
/// p + 7 for 16.
struct Patch {
  std::array<std::uint8_t, kernels::kMaxPatchSize * kernels::kMaxPatchSize> pixels{};
  int size = 0;  ///< n, 8 to 16

  [[nodiscard]] std::uint8_t operator()(int column, int row) const {
    return *(pixels.data() + row * size + column);
  }
  [[nodiscard]] kernels::ZmssdPatch for_search() const {
    return kernels::make_zmssd_patch(pixels.data(), size, size);
  }
};

/// Columns (or rows) of a patch before its place, and from it on.
constexpr int before_place(int size) { return size / 2; }
constexpr int from_place(int size) { return size - size / 2; }

/// Does the patch of this size around (u, v) lie inside the image with `border_px` to spare?
[[nodiscard]] bool patch_fits(const ImageView& image, int u, int v, int size, int border_px = 0);

/// The patch around (u, v); nothing where it leaves the image.
[[nodiscard]] std::optional<Patch> cut_patch(const ImageView& image, int u, int v, int size);

/// What a landmark looked like when it was first seen, with enough around it to be turned and scaled.
struct ReferencePatch {
  static constexpr int kRadius = 20;
  static constexpr int kSide = 2 * kRadius + 1;

  std::array<std::uint8_t, kSide * kSide> pixels{};  ///< centred on the landmark

  [[nodiscard]] ImageView view() const { return {pixels.data(), kSide, kSide, kSide}; }
};

[[nodiscard]] std::optional<ReferencePatch> cut_reference(const ImageView& image, int u, int v);

/// What the reference looks like where the image around the landmark is A times that of the reference: A =
/// d(pixel now)/d(pixel then). Each pixel is the mean of four bilinear samples of its area. Nothing where it
/// would need more than the reference holds.
[[nodiscard]] std::optional<Patch> warp_patch(const ReferencePatch& reference, const Eigen::Matrix2d& A,
                                              int size);

/// Where a camera is now, seen from where it was: p_now = R_now_then p_then + t_now_then.
struct CameraMotion {
  Eigen::Matrix3d R_now_then;
  Eigen::Vector3d t_now_then;
};
[[nodiscard]] CameraMotion motion_between(const CameraPose& then, const CameraPose& now);

/// A of warp_patch() for a small plane around the landmark at `p_then` (camera frame then) with normal
/// `normal_then`: the derivative of the homography R + t n^T/(n^T p) through both lenses. Nothing where the
/// landmark is not seen.
[[nodiscard]] std::optional<Eigen::Matrix2d> plane_warp(const Camera& camera, const Eigen::Vector3d& p_then,
                                                        const Eigen::Vector3d& normal_then,
                                                        const CameraMotion& motion);
/// ... for a plane that faced the camera then.
[[nodiscard]] std::optional<Eigen::Matrix2d> facing_warp(const Camera& camera, const Eigen::Vector3d& p_then,
                                                         const CameraMotion& motion);

/// The patch of a landmark as it should look now; drawn anew only when the warp has changed by more than 5 %.
class WarpedPatch {
 public:
  static constexpr double kSmallChange = 0.05;

  WarpedPatch(const ReferencePatch& reference, int size);

  /// The patch for this warp; the one before where the reference does not hold enough for it.
  const Patch& seen_under(const Eigen::Matrix2d& A);
  [[nodiscard]] const Patch& patch() const { return patch_; }
  [[nodiscard]] const Eigen::Matrix2d& A() const { return A_; }
  [[nodiscard]] const ReferencePatch& reference() const { return reference_; }

 private:
  ReferencePatch reference_;
  Eigen::Matrix2d A_ = Eigen::Matrix2d::Identity();
  Patch patch_;
};

}  // namespace waymark::vision
