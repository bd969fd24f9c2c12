#include "waymark/markers/marker_observation.hpp"

#include <cmath>
#include <utility>

#include <Eigen/LU>

#include "waymark/core/angle.hpp"
#include "waymark/markers/black_border.hpp"
#include "waymark/markers/corner_refinement.hpp"

namespace waymark::markers {
namespace {

using Eigen::Matrix2d;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

// Four corners of a square leave two degrees of freedom for their misfit. Blur adds to the noise of points
// that are seen at a slant, hence a multiple of the chi-square quantile; a side that is half hidden gives
// hundreds.
constexpr double kMisfitMax = 40.0;
// More edge-on markers are not used.
constexpr double kMaxTilt_deg = 75.0;

}  // namespace

const char* describe(Refusal refusal) {
  switch (refusal) {
    case Refusal::kNoSize:
      return "their size is unknown: set markers.size_m or markers.sizes_m";
    case Refusal::kNoBorder:
      return "without a black border on white";
    case Refusal::kUnclear:
      return "not all of their sides are clearly visible";
    case Refusal::kEdgeOn:
      return "seen edge-on";
    case Refusal::kDuplicate:
      return "their identity appears twice in one image";
  }
  return "unknown";
}

PlanarView view_in_plane(const CameraMount& mount, const Vector3d& p_camera) {
  const double yaw_rad = to_radians(mount.yaw_deg);
  const Matrix2d unyaw{{std::cos(yaw_rad), std::sin(yaw_rad)}, {-std::sin(yaw_rad), std::cos(yaw_rad)}};
  const Eigen::Matrix<double, 2, 3> to_plane = unyaw * mount.R_robot_camera().topRows<2>();
  const Vector2d p = to_plane * p_camera;
  const double range_m = p.norm();
  const Matrix2d polar{{p.x() / range_m, p.y() / range_m},
                       {-p.y() / (range_m * range_m), p.x() / (range_m * range_m)}};
  return {{range_m, std::atan2(p.y(), p.x())}, polar * to_plane};
}

MarkerObserver::MarkerObserver(Camera camera, MarkerOptions options, MarkerSet markers)
    : camera_(std::move(camera)), options_(std::move(options)), markers_(std::move(markers)) {}

std::variant<Observation, Refusal> MarkerObserver::observe(const ImageView& image,
                                                           const Marker& marker) const {
  if (markers_.size_of(marker.id) <= 0.0) return Refusal::kNoSize;
  const int cells = markers_.dictionary.bits_per_side + 2;
  if (!has_black_border(image, marker.corners_px, cells)) return Refusal::kNoBorder;
  const auto corners = refine_corners(image, camera_, marker.corners_px, cells);
  if (!corners) return Refusal::kUnclear;
  return observe(*corners, marker.id);
}

std::variant<Observation, Refusal> MarkerObserver::observe(const Corners& corners_px, std::int32_t id) const {
  if (markers_.size_of(id) <= 0.0) return Refusal::kNoSize;
  const double ratio = options_.corner_sigma_px / options_.side_sigma_px;
  return observe({corners_px, ratio * ratio * CornerCovariance::Identity()}, id);
}

std::variant<Observation, Refusal> MarkerObserver::observe(const RefinedCorners& corners,
                                                           std::int32_t id) const {
  const auto poses = estimate_marker_poses(camera_, corners, markers_.size_of(id));
  if (!poses) return Refusal::kUnclear;
  if (is_edge_on(poses->best)) return Refusal::kEdgeOn;
  const double variance = options_.side_sigma_px * options_.side_sigma_px;
  if (poses->best.error > kMisfitMax * variance) return Refusal::kUnclear;
  const RangeBearingEstimate seen = mixture(estimate(poses->best), estimate(poses->other),
                                            (poses->other.error - poses->best.error) / variance);
  if (!seen.covariance.allFinite()) return Refusal::kUnclear;
  return Observation{LandmarkId{LandmarkId::Family::kMarker, id},
                     RangeBearing{seen.value[0], wrap_angle(seen.value[1])}, seen.covariance};
}

RangeBearingEstimate MarkerObserver::estimate(const MarkerPose& pose) const {
  const double variance = options_.side_sigma_px * options_.side_sigma_px;
  const Matrix3d P = variance * pose.information.inverse().bottomRightCorner<3, 3>();
  const PlanarView view = view_in_plane(camera_.options().mount, pose.p_camera_marker);
  // A shaking camera turns the point about itself.
  const Vector3d& p = pose.p_camera_marker;
  const Matrix3d turn{{0.0, p.z(), -p.y()}, {-p.z(), 0.0, p.x()}, {p.y(), -p.x(), 0.0}};
  const double shake_rad = to_radians(options_.jitter_deg);
  const Matrix3d shaken = P + shake_rad * shake_rad * turn * turn.transpose();
  return {view.value, view.dvalue_dpoint * shaken * view.dvalue_dpoint.transpose()};
}

bool MarkerObserver::is_edge_on(const MarkerPose& pose) const {
  const double cosine = pose.R_camera_marker.col(2).dot(pose.p_camera_marker.normalized());
  return cosine < std::cos(to_radians(kMaxTilt_deg));
}

RangeBearingEstimate mixture(const RangeBearingEstimate& best, const RangeBearingEstimate& other,
                             double error_difference) {
  const double ratio = std::exp(-0.5 * error_difference);
  if (!(ratio > 1e-6) || !other.covariance.allFinite()) return best;
  const double w = ratio / (1.0 + ratio);  // of the other
  Vector2d apart = other.value - best.value;
  apart[1] = wrap_angle(apart[1]);
  return {best.value + w * apart,
          (1.0 - w) * best.covariance + w * other.covariance + w * (1.0 - w) * apart * apart.transpose()};
}

}  // namespace waymark::markers
