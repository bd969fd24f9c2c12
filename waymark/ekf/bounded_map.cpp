#include "waymark/ekf/bounded_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "waymark/ekf/pixel_noise.hpp"

namespace waymark::ekf {
namespace {

/// Maximum number of anchor poses in the state. Each takes three rows of the state, as a
/// landmark does: so many are few beside the landmarks, and where they do not do the least useful rays go.
constexpr int kMaxAnchors = 40;
/// Linearity index below which a ray may be kept as a point (x, y, z) (Civera, Davison, Montiel 2008).
constexpr double kLinear = 0.1;
/// Standard deviation of the depth over the depth below which a ray that has to be converted is kept as a
/// point. Nobody sees it at the time, and without a view its linearity index says nothing.
constexpr double kFairlySure = 0.1;

}  // namespace

BoundedMap::BoundedMap(const PixelSlamOptions& options, const Camera& camera, int threads)
    : map_(options.capacity, kMaxAnchors, options.consistency, threads,
           PixelNoise(options).has_jitter() ? 1 : 0),
      management_(options.capacity),
      camera_(camera),
      min_rho_per_m_(1.0 / options.depth.farthest_m) {
  removed_.reserve(static_cast<std::size_t>(options.capacity + options.max_candidates));
}

Result<void> BoundedMap::load(const MapState& saved) {
  if (auto fits = check_fits(saved, 3, map_.capacity()); !fits) return fits;
  if (!map_.features().empty())
    return Error{"map: can be loaded only before the first motion or observation"};
  map_.load(saved);
  for (int i = 0; i < static_cast<int>(saved.ids.size()); ++i) {
    PixelMap::Feature& feature = map_.feature(i);
    const auto patch = std::ranges::find(saved.patches, feature.id, &LandmarkPatch::id);
    const Pose2& seen_at = patch != saved.patches.end() ? patch->T_world_robot : saved.T_world_robot;
    feature.seen_from_m = camera_.pose(seen_at).p_world_camera;
    feature.first_view_m = feature.seen_from_m - map_.state().landmark(feature.element);
    management_.added();
  }
  return {};
}

MapState BoundedMap::save() const {
  const State& state = map_.state();
  MapState saved;
  saved.landmark_dimension = 3;
  saved.T_world_robot = state.pose().T_world_robot;
  std::vector<int> kept;
  for (int i = 0; i < static_cast<int>(map_.features().size()); ++i)
    if (map_.feature(i).is_point() || inverse_depth(i).rho > min_rho_per_m_) kept.push_back(i);
  const auto count = static_cast<int>(kept.size());
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(3 + 3 * count, 3 + 3 * state.landmarks());
  J.topLeftCorner<3, 3>().setIdentity();
  saved.landmarks.resize(3 * count);
  for (int k = 0; k < count; ++k) {
    const PixelMap::Feature& feature = map_.feature(kept[static_cast<std::size_t>(k)]);
    saved.ids.push_back(feature.id);
    saved.observations.push_back(feature.observations);
    const Eigen::Vector3d values = state.landmark(feature.element);
    auto J_element = J.block<3, 3>(3 + 3 * k, 3 + 3 * feature.element);
    J_element.setIdentity();
    saved.landmarks.segment<3>(3 * k) = values;
    if (feature.is_point()) continue;
    const RayPoint point = point_of_ray(camera_.pose(map_.anchor_pose(feature.anchor)), values);
    J_element = point.J_ray;
    J.block<3, 3>(3 + 3 * k, 3 + 3 * map_.anchor_element(feature.anchor)) = point.J_anchor;
    saved.landmarks.segment<3>(3 * k) = point.p_world;
  }
  saved.covariance = J * state.covariance() * J.transpose();
  saved.covariance = (0.5 * (saved.covariance + saved.covariance.transpose())).eval();
  return saved;
}

void BoundedMap::begin_image() {
  removed_.clear();
  management_.begin_scan();
}

void BoundedMap::retire() {
  for (int i = static_cast<int>(map_.features().size()) - 1; i >= 0; --i)
    if (management_.keeps_failing(i)) remove(i);
}

void BoundedMap::matched(int feature, const PoseObservation& observation) {
  ++map_.feature(feature).observations;
  management_.matched(feature, observation);
}

bool BoundedMap::make_room() {
  if (!map_.is_full()) return true;
  const auto least_useful = management_.least_useful();
  if (least_useful) remove(*least_useful);
  return least_useful.has_value();
}

bool BoundedMap::free_an_anchor() {
  if (map_.has_free_anchor()) return true;
  std::array<double, kMaxAnchors> worth{};
  std::array<int, kMaxAnchors> rays{};
  for (int i = 0; i < static_cast<int>(map_.features().size()); ++i) {
    if (map_.feature(i).is_point()) continue;
    const auto anchor = static_cast<std::size_t>(map_.feature(i).anchor);
    worth[anchor] += management_.is_in_scan(i) ? HUGE_VAL : management_.usefulness(i);
    ++rays[anchor];
  }
  for (std::size_t a = 0; a < worth.size(); ++a)  // who else holds it needs it
    if (map_.holders(static_cast<int>(a)) > rays[a]) worth[a] = HUGE_VAL;
  const auto least = std::ranges::min_element(worth);
  if (!std::isfinite(*least)) return false;
  convert_rays_of(static_cast<int>(least - worth.begin()));
  return true;
}

void BoundedMap::convert_rays_of(int anchor) {
  for (int i = static_cast<int>(map_.features().size()) - 1; i >= 0; --i) {
    if (map_.feature(i).anchor != anchor) continue;
    const auto [rho, sigma] = inverse_depth(i);
    if (sigma < kFairlySure * rho)
      map_.make_point(i, camera_);
    else
      remove(i);
  }
}

int BoundedMap::add_ray(LandmarkId id, int anchor, const Eigen::Vector3d& ray,
                        const Eigen::Matrix3d& covariance, int observations) {
  const int index = map_.add_ray(id, anchor, ray, covariance);
  management_.added();
  map_.feature(index).observations = observations;
  map_.feature(index).seen_from_m = camera_.pose(map_.anchor_pose(anchor)).p_world_camera;
  return index;
}

void BoundedMap::give_up(LandmarkId candidate, int anchor) {
  removed_.push_back(candidate);
  map_.release(anchor);
}

void BoundedMap::convert_ray(int feature, const Eigen::Vector3d& p_world_camera) {
  const PixelMap::Feature& ray = map_.feature(feature);
  if (ray.is_point()) return;
  const auto [rho, sigma] = inverse_depth(feature);
  if (rho + 2.0 * sigma < 0.0)
    remove(feature);
  else if (rho > 0.0 && linearity_index(camera_.pose(map_.anchor_pose(ray.anchor)),
                                        map_.state().landmark(ray.element), sigma, p_world_camera) < kLinear)
    map_.make_point(feature, camera_);
}

/// Of a ray.
BoundedMap::InverseDepth BoundedMap::inverse_depth(int feature) const {
  const int element = map_.feature(feature).element;
  return {map_.state().landmark(element)[2], std::sqrt(map_.state().landmark_covariance(element)(2, 2))};
}

void BoundedMap::remove(int feature) {
  removed_.push_back(map_.feature(feature).id);
  map_.remove(feature);
  management_.removed(feature);
}

}  // namespace waymark::ekf
