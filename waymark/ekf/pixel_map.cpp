#include "waymark/ekf/pixel_map.hpp"

#include <algorithm>
#include <utility>

namespace waymark::ekf {

PixelMap::PixelMap(int capacity, int anchors, Consistency consistency, int threads, int bias_pairs)
    : capacity_(capacity),
      state_(3, capacity + anchors, consistency, threads, bias_pairs),
      anchors_(static_cast<std::size_t>(anchors)) {
  features_.reserve(static_cast<std::size_t>(capacity));
  owners_.reserve(static_cast<std::size_t>(capacity) + static_cast<std::size_t>(anchors));
}

void PixelMap::load(const MapState& map) {
  state_.load(mean_of(map), map.covariance);
  for (std::size_t i = 0; i < map.ids.size(); ++i) {
    const auto element = static_cast<int>(i);
    owners_.push_back({false, element});
    features_.push_back({.id = map.ids[i], .element = element, .observations = map.observations[i]});
  }
}

std::optional<int> PixelMap::find(LandmarkId id) const {
  const auto found = std::ranges::find(features_, id, &Feature::id);
  if (found == features_.end()) return std::nullopt;
  return static_cast<int>(found - features_.begin());
}

std::optional<int> PixelMap::add_anchor() {
  const auto free = std::ranges::find(anchors_, 0, &AnchorPose::holders);
  if (free == anchors_.end()) return std::nullopt;
  const auto index = static_cast<int>(free - anchors_.begin());
  *free = {state_.add_pose(), 1};
  owners_.push_back({true, index});
  return index;
}

void PixelMap::release(int anchor) {
  AnchorPose& released = anchors_[static_cast<std::size_t>(anchor)];
  if (--released.holders == 0) remove_element(released.element);
}

Pose2 PixelMap::anchor_pose(int anchor) const {
  const Eigen::Vector3d pose = state_.landmark(anchor_element(anchor));
  return {pose[0], pose[1], pose[2]};
}

int PixelMap::add_ray(LandmarkId id, int anchor, const Eigen::Vector3d& ray,
                      const Eigen::Matrix3d& covariance) {
  hold(anchor);
  owners_.push_back({false, static_cast<int>(features_.size())});
  Feature added;
  added.id = id;
  added.anchor = anchor;
  added.element = state_.add_relative(ray, covariance);
  features_.push_back(added);
  return static_cast<int>(features_.size()) - 1;
}

void PixelMap::make_point(int index, const Camera& camera) {
  Feature& ray = feature(index);
  const CameraPose anchor = camera.pose(anchor_pose(ray.anchor));
  const RayPoint point = point_of_ray(anchor, state_.landmark(ray.element));
  state_.make_absolute(ray.element, anchor_element(ray.anchor), point.p_world, point.J_anchor, point.J_ray);
  ray.first_view_m = anchor.p_world_camera - point.p_world;
  release(std::exchange(ray.anchor, -1));
}

void PixelMap::remove(int index) {
  const Feature removed = feature(index);
  remove_element(removed.element);
  if (!removed.is_point()) release(removed.anchor);
  feature(index) = features_.back();
  features_.pop_back();
  if (index < static_cast<int>(features_.size()))
    owners_[static_cast<std::size_t>(feature(index).element)].index = index;
}

/// The state lets its last element take the place of a removed one.
void PixelMap::remove_element(int element) {
  state_.remove(element);
  const Owner moved = owners_.back();
  owners_.pop_back();
  if (element == static_cast<int>(owners_.size())) return;
  owners_[static_cast<std::size_t>(element)] = moved;
  if (moved.is_anchor)
    anchors_[static_cast<std::size_t>(moved.index)].element = element;
  else
    features_[static_cast<std::size_t>(moved.index)].element = element;
}

}  // namespace waymark::ekf
