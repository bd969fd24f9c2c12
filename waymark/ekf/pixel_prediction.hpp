#pragma once

#include <optional>

#include <Eigen/Core>

#include "waymark/core/expectation.hpp"
#include "waymark/ekf/pixel_map.hpp"
#include "waymark/ekf/pixel_noise.hpp"
#include "waymark/ekf/pixel_slam_options.hpp"
#include "waymark/models/camera.hpp"

namespace waymark::ekf {

/// A pixel in which a landmark of the map was found, and its noise.
struct FoundPixel {
  int feature;           ///< in the map
  Eigen::Vector2d z_px;  ///< (u, v)
  Eigen::Matrix2d R;     ///< px^2
};

/// Where the landmarks of a map, points and rays, are in the image, with Jacobians: what a camera with
/// PixelNoise makes of them. Everything is O(1) and allocates nothing.
class PixelPrediction {
 public:
  PixelPrediction(const PixelSlamOptions& options, const CameraOptions& camera);

  [[nodiscard]] const Camera& camera() const { return camera_; }
  [[nodiscard]] const PixelNoise& noise() const { return noise_; }

  /// The camera at the present estimate. All functions below that take one want this, unless said otherwise;
  /// computed once it serves all landmarks.
  [[nodiscard]] CameraPose camera_pose(const PixelMap& map) const {
    return camera_.pose(map.state().pose().T_world_robot);
  }

  /// A found pixel, linearised at the present estimate, Jacobians where the consistency mode wants them.
  /// Nothing where the landmark cannot be seen.
  [[nodiscard]] std::optional<LinearizedObservation> linearize(const PixelMap& map, const FoundPixel& found,
                                                               const CameraPose& here) const;
  /// The same at what the state proposes, with Jacobians there.
  [[nodiscard]] std::optional<LinearizedObservation> linearize_at_proposal(const PixelMap& map,
                                                                           const FoundPixel& found) const;

  /// A landmark of the map in the image that is about to be looked at, with S = H P H^T + R; lets it drift
  /// before. Nothing where it should not be looked for: outside of the image, or seen from so far away from
  /// where it was first seen that it would not be recognised.
  [[nodiscard]] std::optional<Expectation> expect(PixelMap& map, int feature, const CameraPose& here) const;
  /// Whether a patch around the pixel (u, v) is in the image.
  [[nodiscard]] bool is_in_image(const Eigen::Vector2d& pixel) const;

  /// Where a landmark is in the world, m; a ray that leads behind infinity as far away as points may be.
  [[nodiscard]] Eigen::Vector3d place(const PixelMap& map, int feature) const;
  /// Process noise of a landmark at `p_world`: how far it has drifted across the line of sight since the
  /// camera last looked at it. A patch is no point. Warped as a plane that faces the camera it fits best a
  /// little beside where it was cut, and the more so the more the view has turned. Images from nearly the
  /// same place are off by the same: an error of the landmark, not of the pixel.
  void add_process_noise(PixelMap& map, int feature, const Eigen::Vector3d& p_world,
                         const CameraPose& here) const;

 private:
  /// A landmark in the image. The innovation and R of the observation are left to who knows the pixel.
  struct PredictedObservation {
    LinearizedObservation linearization;
    Eigen::Vector2d predicted;
  };

  template <class Values>
  [[nodiscard]] std::optional<PredictedObservation> project_feature(const PixelMap& map, int feature,
                                                                    const CameraPose& from,
                                                                    const Values& values) const;
  [[nodiscard]] std::optional<PredictedObservation> predict_feature(const PixelMap& map, int feature,
                                                                    const CameraPose& here) const;
  [[nodiscard]] bool is_recognisable(const PixelMap& map, int feature, const CameraPose& here) const;

  Camera camera_;
  PixelNoise noise_;
  double farthest_m_;
};

}  // namespace waymark::ekf
