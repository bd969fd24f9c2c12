#pragma once

#include <Eigen/Core>

#include "waymark/core/observation.hpp"
#include "waymark/ekf/pixel_slam_options.hpp"
#include "waymark/ekf/state.hpp"

namespace waymark::ekf {

/// Part of the true pixels that passes the gate of one pixel.
inline constexpr double kPixelGateProbability = 0.9999;

/// In what ways the pixel of a landmark differs from where the landmark is (docs/camera.md, "What a pixel is
/// worth"): noise that is new in every observation, an attitude jitter of the camera that all observations of
/// one image share, and the drift of a patch, which is an error of the landmark. All functions are O(1).
class PixelNoise {
 public:
  explicit PixelNoise(const PixelSlamOptions& options);

  /// R of a pixel that was found, 2x2, px^2. One without covariance has that of the options.
  [[nodiscard]] Eigen::Matrix2d of(const Observation& observation) const;
  /// R of a pixel that is to be found, 2x2, px^2: known to the whole pixel.
  [[nodiscard]] const Eigen::Matrix2d& of_search() const { return search_; }

  /// Whether the camera has attitude jitter: the state then holds one pair of biases for it, pair 0.
  [[nodiscard]] bool has_jitter() const { return jitter_rad_ > 0.0; }
  /// A new image: what the camera's pitch and roll were is forgotten. O(n) for a state of n values.
  void begin_image(State& state) const;
  /// What an attitude jitter about the camera's x and z axis does to the pixel of a point, d(u, v)/d(pair 0).
  /// `p_camera` is the point in the camera frame, up to a factor, J = d(u, v)/d p_camera.
  [[nodiscard]] BiasTerms attitude_jitter(const Eigen::Vector3d& p_camera,
                                          const Eigen::Matrix<double, 2, 3>& J) const;

  /// Variance of how far a patch drifts on a point `p_world` while the camera moves between two places,
  /// px^2: it grows with the angle between the two views.
  [[nodiscard]] double process_noise_px2(const Eigen::Vector3d& p_world, const Eigen::Vector3d& from,
                                         const Eigen::Vector3d& to) const;

 private:
  Eigen::Matrix2d own_;       ///< of a pixel without covariance
  Eigen::Matrix2d model_;     ///< of every pixel besides
  Eigen::Matrix2d search_;    ///< of a pixel that is to be found
  double landmark_noise_px_;  ///< in a turn of the view by 1 deg
  double jitter_rad_;
};

}  // namespace waymark::ekf
