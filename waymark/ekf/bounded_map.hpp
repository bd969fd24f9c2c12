#pragma once

#include <optional>
#include <span>
#include <vector>

#include "waymark/core/map_state.hpp"
#include "waymark/core/result.hpp"
#include "waymark/ekf/map_management.hpp"
#include "waymark/ekf/pixel_map.hpp"
#include "waymark/ekf/pixel_slam_options.hpp"
#include "waymark/models/camera.hpp"

namespace waymark::ekf {

/// Map management of a camera's filter: a PixelMap that stays within its bounds because it knows how useful
/// its landmarks have been. Landmarks that keep failing leave, the least useful one makes room for a new one,
/// and rays become points when they can, so that their anchors are free again. Takes its memory once.
class BoundedMap {
 public:
  BoundedMap(const PixelSlamOptions& options, const Camera& camera, int threads);

  [[nodiscard]] PixelMap& map() { return map_; }
  [[nodiscard]] const PixelMap& map() const { return map_; }

  /// Goes on from a saved map of points; only before anything was predicted or added. Changes nothing where
  /// it does not fit. A landmark without patch is taken to have been seen from where the map ends.
  [[nodiscard]] Result<void> load(const MapState& saved);
  /// Robot and landmarks, all as points, with all their correlations. A ray that leads farther away than
  /// points may be is left out. Allocates.
  [[nodiscard]] MapState save() const;

  /// Forgets who has left.
  void begin_image();
  /// Landmarks that were missed in more than half of at least ten attempts leave.
  void retire();
  /// The landmark was found where it was expected.
  void matched(int feature, const PoseObservation& observation);
  /// The landmark was looked for and not found, or found where it cannot be.
  void missed(int feature) { management_.missed(feature); }
  /// Who left since the image began: landmarks, and candidates that were given up.
  [[nodiscard]] std::span<const LandmarkId> removed() const { return removed_; }

  /// Whether there is room for one more landmark, if need be by removing the least useful one.
  [[nodiscard]] bool make_room();
  /// Whether there is a free anchor, if need be by converting the rays of the one whose rays are least
  /// useful of those that nobody sees or needs: those of fairly sure depth to points, the others are removed.
  [[nodiscard]] bool free_an_anchor();
  /// Appends a ray (x, y, rho) as PixelMap::add_ray() does, seen in so many images already. Its index. The
  /// map must not be full.
  int add_ray(LandmarkId id, int anchor, const Eigen::Vector3d& ray, const Eigen::Matrix3d& covariance,
              int observations);
  /// A candidate that stood on an anchor will be no landmark.
  void give_up(LandmarkId candidate, int anchor);

  /// A ray that has become as good as linear goes on as a point; one that leads behind infinity goes. Only
  /// where it was just seen, by a camera at `p_world_camera`: from elsewhere any ray may look linear.
  void convert_ray(int feature, const Eigen::Vector3d& p_world_camera);

 private:
  struct InverseDepth {
    double rho, sigma;  ///< 1/m
  };

  [[nodiscard]] InverseDepth inverse_depth(int feature) const;
  void convert_rays_of(int anchor);
  void remove(int feature);

  PixelMap map_;
  MapManagement management_;
  Camera camera_;
  double min_rho_per_m_;  ///< of a ray that is saved
  std::vector<LandmarkId> removed_;
};

}  // namespace waymark::ekf
