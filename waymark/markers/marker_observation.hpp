#pragma once

#include <cstdint>
#include <variant>

#include "waymark/core/observation.hpp"
#include "waymark/markers/marker_detector.hpp"
#include "waymark/markers/marker_options.hpp"
#include "waymark/markers/planar_pose.hpp"
#include "waymark/models/camera.hpp"

namespace waymark::markers {

/// Why a marker in an image is not used.
enum class Refusal : std::uint8_t {
  kNoSize,    ///< nobody said how large it is
  kNoBorder,  ///< not on white paper: perhaps no marker at all
  kUnclear,   ///< a side or a pose cannot be found
  kEdgeOn,    ///< turned too far from the camera
  kDuplicate  ///< its identity is in the image twice
};

inline constexpr std::size_t kRefusals = 5;

[[nodiscard]] const char* describe(Refusal refusal);

/// A value and how it is known.
struct RangeBearingEstimate {
  Eigen::Vector2d value = Eigen::Vector2d::Zero();  ///< range m, bearing rad
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
};

/// Range and bearing of a marker's middle from the camera, in the plane of the robot: the sensor stands where
/// the camera does and looks where it is yawed to. The Jacobian (2 x 3) is to the point in the camera frame.
struct PlanarView {
  Eigen::Vector2d value;
  Eigen::Matrix<double, 2, 3> dvalue_dpoint;
};
[[nodiscard]] PlanarView view_in_plane(const CameraMount& mount, const Eigen::Vector3d& p_camera);

/// Makes observations of markers in one camera's images.
class MarkerObserver {
 public:
  MarkerObserver(Camera camera, MarkerOptions options, MarkerSet markers);

  /// Range and bearing of a marker. The covariance is the noise of points on its sides, carried through the
  /// fitted sides, corners and pose, and the shaking of the mount. Where the other pose fits nearly as well
  /// the observation is the mean of both by their likelihoods, and their distance counts as noise.
  [[nodiscard]] std::variant<Observation, Refusal> observe(const ImageView& image,
                                                           const Marker& marker) const;

  /// The same from corners that another program found, each with noise of its own.
  [[nodiscard]] std::variant<Observation, Refusal> observe(const Corners& corners_px, std::int32_t id) const;

  /// The same from corners that are refined already.
  [[nodiscard]] std::variant<Observation, Refusal> observe(const RefinedCorners& corners,
                                                           std::int32_t id) const;

 private:
  [[nodiscard]] RangeBearingEstimate estimate(const MarkerPose& pose) const;
  [[nodiscard]] bool is_edge_on(const MarkerPose& pose) const;

  Camera camera_;
  MarkerOptions options_;
  MarkerSet markers_;
};

/// The mean of two estimates of one value, weighted by how well their poses fit: differences of the errors in
/// units of their variance.
[[nodiscard]] RangeBearingEstimate mixture(const RangeBearingEstimate& best,
                                           const RangeBearingEstimate& other, double error_difference);

}  // namespace waymark::markers
