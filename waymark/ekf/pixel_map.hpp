#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <vector>

#include "waymark/core/map_state.hpp"
#include "waymark/core/observation.hpp"
#include "waymark/ekf/state.hpp"
#include "waymark/models/pixel_model.hpp"

namespace waymark::ekf {

/// Covariance of a ray's (x, y, rho) whose direction and inverse depth have nothing in common.
[[nodiscard]] inline Eigen::Matrix3d ray_covariance(const Eigen::Matrix2d& xy_covariance, double rho_sigma) {
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  covariance.topLeftCorner<2, 2>() = xy_covariance;
  covariance(2, 2) = rho_sigma * rho_sigma;
  return covariance;
}

/// The landmarks of a camera and what of them stands where in the state: points (x, y, z), and rays (x, y,
/// rho) relative to the pose of the robot from which they were first seen, their anchor, which stays in the
/// state for as long as something needs it. Nothing allocates after construction.
class PixelMap {
 public:
  struct Feature {
    LandmarkId id;
    int element = 0;  ///< in the state
    int anchor = -1;  ///< of a ray; below 0: a point
    int observations = 0;
    Eigen::Vector3d first_view_m = Eigen::Vector3d::Zero();  ///< from a point to the camera that first saw it
    Eigen::Vector3d seen_from_m = Eigen::Vector3d::Zero();   ///< where the camera last was that looked at it

    [[nodiscard]] bool is_point() const { return anchor < 0; }
  };

  PixelMap(int capacity, int anchors, Consistency consistency, int threads, int bias_pairs);

  /// Starts from a saved map of points; only before anything was added. It must fit.
  void load(const MapState& map);

  [[nodiscard]] State& state() { return state_; }
  [[nodiscard]] const State& state() const { return state_; }
  [[nodiscard]] std::span<const Feature> features() const { return features_; }
  [[nodiscard]] Feature& feature(int index) { return features_[static_cast<std::size_t>(index)]; }
  [[nodiscard]] const Feature& feature(int index) const { return features_[static_cast<std::size_t>(index)]; }
  [[nodiscard]] std::optional<int> find(LandmarkId id) const;
  [[nodiscard]] int capacity() const { return capacity_; }
  [[nodiscard]] bool is_full() const { return features_.size() == static_cast<std::size_t>(capacity_); }

  [[nodiscard]] bool has_free_anchor() const {
    return std::ranges::any_of(anchors_, [](const AnchorPose& anchor) { return anchor.holders == 0; });
  }
  /// The robot's present pose as an anchor, held once; nothing where there is no room for another one.
  [[nodiscard]] std::optional<int> add_anchor();
  /// An anchor leaves the state when it has been released as often as held.
  void hold(int anchor) { ++anchors_[static_cast<std::size_t>(anchor)].holders; }
  void release(int anchor);
  [[nodiscard]] Pose2 anchor_pose(int anchor) const;
  [[nodiscard]] int anchor_element(int anchor) const {
    return anchors_[static_cast<std::size_t>(anchor)].element;
  }
  /// How often it is held: once by each of its rays, and by whoever called add_anchor() or hold().
  [[nodiscard]] int holders(int anchor) const { return anchors_[static_cast<std::size_t>(anchor)].holders; }

  /// Appends a ray (x, y, rho) with its covariance and returns its index; it holds its anchor. The map must
  /// not be full.
  int add_ray(LandmarkId id, int anchor, const Eigen::Vector3d& ray, const Eigen::Matrix3d& covariance);
  /// Turns a ray into the point that it says.
  void make_point(int index, const Camera& camera);
  /// The last feature takes the place of a removed one.
  void remove(int index);

 private:
  struct AnchorPose {
    int element = -1;
    int holders = 0;
  };
  /// Who stands in an element of the state: feature `index`, or an anchor.
  struct Owner {
    bool is_anchor = false;
    int index = 0;
  };

  void remove_element(int element);

  int capacity_;
  State state_;
  std::vector<Feature> features_;
  std::vector<AnchorPose> anchors_;
  std::vector<Owner> owners_;  // by element
};

}  // namespace waymark::ekf
