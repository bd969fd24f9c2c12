#include "waymark/vision/patch.hpp"

#include <algorithm>

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace waymark::vision {
namespace {

/// Between the four pixels around a place at least one pixel inside the image.
double grey_at(const ImageView& image, const Eigen::Vector2d& place) {
  const int u = static_cast<int>(place.x()), v = static_cast<int>(place.y());
  const double a = place.x() - u, b = place.y() - v;
  const std::uint8_t* upper = image.pixel(u, v);
  const std::uint8_t* lower = upper + image.stride;
  return (1.0 - b) * ((1.0 - a) * upper[0] + a * upper[1]) + b * ((1.0 - a) * lower[0] + a * lower[1]);
}

/// Does the square of offsets from -radius to radius, mapped by M, stay inside the reference?
bool fits_reference(const Eigen::Matrix2d& M, double radius) {
  const Eigen::Array2d reach = radius * M.cwiseAbs().rowwise().sum();
  return (reach < ReferencePatch::kRadius).all();  // not for what is no number
}

}  // namespace

bool patch_fits(const ImageView& image, int u, int v, int size, int border_px) {
  const int before = before_place(size) + border_px, from = from_place(size) + border_px;
  return u >= before && v >= before && u + from <= image.width_px && v + from <= image.height_px;
}

std::optional<Patch> cut_patch(const ImageView& image, int u, int v, int size) {
  if (!patch_fits(image, u, v, size)) return std::nullopt;
  Patch patch;
  patch.size = size;
  for (int row = 0; row < size; ++row)
    std::copy_n(image.pixel(u - before_place(size), v - before_place(size) + row), size,
                patch.pixels.data() + row * size);
  return patch;
}

std::optional<ReferencePatch> cut_reference(const ImageView& image, int u, int v) {
  constexpr int kRadius = ReferencePatch::kRadius, kSide = ReferencePatch::kSide;
  if (!patch_fits(image, u, v, kSide)) return std::nullopt;
  ReferencePatch reference;
  for (int row = 0; row < kSide; ++row)
    std::copy_n(image.pixel(u - kRadius, v - kRadius + row), kSide, reference.pixels.data() + row * kSide);
  return reference;
}

std::optional<Patch> warp_patch(const ReferencePatch& reference, const Eigen::Matrix2d& A, int size) {
  const Eigen::Matrix2d then_now = A.inverse();
  const Eigen::Vector2d centre = Eigen::Vector2d::Constant(ReferencePatch::kRadius);
  // Four samples where a pixel now covers more than one of then; else one, which keeps the sharpness.
  const bool is_smaller = then_now.cwiseAbs().maxCoeff() > 1.05;
  const Eigen::Matrix2d spread = 0.25 * then_now;
  if (!fits_reference(then_now, before_place(size) + 0.25)) return std::nullopt;
  const Eigen::Vector2d across = spread.col(0) + spread.col(1), along = spread.col(0) - spread.col(1);
  const ImageView then = reference.view();
  Patch patch;
  patch.size = size;
  std::uint8_t* pixel = patch.pixels.data();
  for (int row = 0; row < size; ++row) {
    for (int column = 0; column < size; ++column) {
      const Eigen::Vector2d offset(column - before_place(size), row - before_place(size));
      const Eigen::Vector2d place = centre + then_now * offset;
      const double grey = is_smaller ? 0.25 * (grey_at(then, place + across) + grey_at(then, place - across) +
                                               grey_at(then, place + along) + grey_at(then, place - along))
                                     : grey_at(then, place);
      // NOLINTNEXTLINE(bugprone-incorrect-roundings): never negative, and lround() is a call
      *pixel++ = static_cast<std::uint8_t>(grey + 0.5);
    }
  }
  return patch;
}

CameraMotion motion_between(const CameraPose& then, const CameraPose& now) {
  return {now.R_camera_world * then.R_camera_world.transpose(),
          now.R_camera_world * (then.p_world_camera - now.p_world_camera)};
}

std::optional<Eigen::Matrix2d> plane_warp(const Camera& camera, const Eigen::Vector3d& p_then,
                                          const Eigen::Vector3d& normal_then, const CameraMotion& motion) {
  const auto then = camera.project(p_then);
  const auto now = camera.project(motion.R_now_then * p_then + motion.t_now_then);
  if (!then || !now) return std::nullopt;
  const auto ray = camera.ray(then->pixel);
  if (!ray) return std::nullopt;
  // The point of the plane on the ray r = (x, y, 1) is r (n^T p)/(n^T r).
  const Eigen::Vector3d r = ray->xy.homogeneous();
  const double scale = normal_then.dot(p_then) / normal_then.dot(r);
  const Eigen::Matrix<double, 3, 2> dr = Eigen::Matrix<double, 3, 2>::Identity();
  const Eigen::Matrix<double, 3, 2> dp_dxy =
      scale * (dr - r * (normal_then.transpose() * dr) / normal_then.dot(r));
  return Eigen::Matrix2d(now->dpixel_dpoint * motion.R_now_then * dp_dxy * ray->dxy_dpixel);
}

std::optional<Eigen::Matrix2d> facing_warp(const Camera& camera, const Eigen::Vector3d& p_then,
                                           const CameraMotion& motion) {
  return plane_warp(camera, p_then, -p_then.normalized(), motion);
}

WarpedPatch::WarpedPatch(const ReferencePatch& reference, int size)
    : reference_(reference), patch_(*warp_patch(reference, A_, size)) {}

const Patch& WarpedPatch::seen_under(const Eigen::Matrix2d& A) {
  if ((A - A_).norm() <= kSmallChange * A_.norm()) return patch_;
  if (const auto patch = warp_patch(reference_, A, patch_.size)) {
    patch_ = *patch;
    A_ = A;
  }
  return patch_;
}

}  // namespace waymark::vision
