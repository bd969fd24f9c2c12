#pragma once

#include <optional>

#include <Eigen/Core>

#include "waymark/core/expectation.hpp"
#include "waymark/core/observation.hpp"
#include "waymark/ekf/depth_particles.hpp"
#include "waymark/ekf/pixel_map.hpp"
#include "waymark/ekf/pixel_prediction.hpp"
#include "waymark/models/camera.hpp"

namespace waymark::ekf {

/// Something that was seen from an anchor, and whose depth particles find out, before it becomes a landmark.
/// Its ray and its depth are not in the state; the anchor is.
struct Candidate {
  LandmarkId id;
  int anchor = -1;                               ///< below 0: a free slot
  Eigen::Vector2d xy = Eigen::Vector2d::Zero();  ///< its ray, in the camera of the anchor
  Eigen::Matrix2d xy_covariance = Eigen::Matrix2d::Zero();
  DepthParticles depths;
  int images = 0;   ///< since it began
  int looks = 0;    ///< of these, in which it was looked for
  int matches = 0;  ///< of these, in which it was found

  [[nodiscard]] bool is_free() const { return anchor < 0; }
  /// Takes the slot for something that was just seen.
  void start(LandmarkId seen, int from, const Eigen::Vector2d& ray_xy, const Eigen::Matrix2d& covariance);
  [[nodiscard]] Eigen::Vector3d ray(double rho_per_m) const { return {xy.x(), xy.y(), rho_per_m}; }
};

/// Where a candidate should appear in the present image. What this depends on besides the depth, robot and
/// anchor with their joint covariance, is fetched once for all depths. A view of its arguments, which must
/// not change meanwhile.
class CandidatePrediction {
 public:
  CandidatePrediction(const Candidate& candidate, const PixelMap& map, const PixelPrediction& prediction);

  struct PredictedPixel {
    Eigen::Vector2d pixel;  ///< (u, v)
    Eigen::Matrix2d S;      ///< px^2, without the noise of the pixel
  };
  /// At inverse depth rho, 1/m: S = H P H^T + H_xy R_xy H_xy^T, jitter, and how far its patch has
  /// drifted. Nothing where it cannot be seen.
  [[nodiscard]] std::optional<PredictedPixel> at(double rho_per_m) const;
  /// Mean and covariance of all pixels that its depths predict, by three of them (Gauss and Hermite). Nothing
  /// where it should not be looked for.
  [[nodiscard]] std::optional<Expectation> expect() const;

 private:
  const Candidate& candidate_;
  const PixelPrediction& prediction_;
  CameraPose here_;
  CameraPose anchor_;
  Eigen::Matrix<double, 6, 6> P_;  ///< of the (x, y, theta) of robot and anchor
};

}  // namespace waymark::ekf
