#include "waymark/ekf/pixel_prediction.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "waymark/core/angle.hpp"
#include "waymark/models/pixel_model.hpp"

namespace waymark::ekf {
namespace {

/// As far inside the image a landmark must be expected, px: there is room for its whole patch.
constexpr double kBorder_px = 8.0;
// A patch changes with the view of it. It is still recognised where the view has turned by at most 45 deg
// since it was cut, and from between these ratios of the distance of then.
const double kMinCosine = std::cos(to_radians(45.0));
constexpr double kNearest = 0.4, kFarthest = 2.5;

}  // namespace

PixelPrediction::PixelPrediction(const PixelSlamOptions& options, const CameraOptions& camera)
    : camera_(camera), noise_(options), farthest_m_(options.depth.farthest_m) {}

/// A landmark as it looks from a pose, with `values` of what stands in the state.
template <class Values>
std::optional<PixelPrediction::PredictedObservation> PixelPrediction::project_feature(
    const PixelMap& map, int feature, const CameraPose& from, const Values& values) const {
  const PixelMap::Feature& landmark = map.feature(feature);
  PredictedObservation seen;
  seen.linearization.landmark = landmark.element;
  if (landmark.is_point()) {
    const auto h = observe_point(camera_, from, values(landmark.element));
    if (!h) return std::nullopt;
    seen.linearization.H_pose = h->H_pose;
    seen.linearization.H_landmark = h->H_landmark;
    seen.linearization.errors = noise_.attitude_jitter(h->p_camera, h->dpixel_dpoint);
    seen.predicted = h->predicted;
  } else {
    seen.linearization.anchor = map.anchor_element(landmark.anchor);
    const Eigen::Vector3d anchor = values(seen.linearization.anchor);
    const auto h =
        observe_ray(camera_, from, camera_.pose({anchor[0], anchor[1], anchor[2]}), values(landmark.element));
    if (!h) return std::nullopt;
    seen.linearization.H_pose = h->H_pose;
    seen.linearization.H_landmark = h->H_ray;
    seen.linearization.H_anchor = h->H_anchor;
    seen.linearization.errors = noise_.attitude_jitter(h->p_camera, h->dpixel_dpoint);
    seen.predicted = h->predicted;
  }
  return seen;
}

/// At the present estimate.
std::optional<PixelPrediction::PredictedObservation> PixelPrediction::predict_feature(
    const PixelMap& map, int feature, const CameraPose& here) const {
  const State& state = map.state();
  auto seen = project_feature(map, feature, here, [&](int element) { return state.landmark(element); });
  if (!seen || state.consistency() != Consistency::kFej) return seen;
  auto first = project_feature(map, feature, camera_.pose(state.linearization_pose()),
                               [&](int element) { return state.linearization_landmark(element); });
  if (first) first->predicted = seen->predicted;
  return first;
}

std::optional<LinearizedObservation> PixelPrediction::linearize(const PixelMap& map, const FoundPixel& found,
                                                                const CameraPose& here) const {
  auto seen = predict_feature(map, found.feature, here);
  if (!seen) return std::nullopt;
  seen->linearization.R = found.R;
  // Vincke (10)
  seen->linearization.nu = found.z_px - seen->predicted - map.state().expected(seen->linearization.errors);
  return seen->linearization;
}

std::optional<LinearizedObservation> PixelPrediction::linearize_at_proposal(const PixelMap& map,
                                                                            const FoundPixel& found) const {
  const Proposal proposal = map.state().proposal();
  auto seen = project_feature(map, found.feature, camera_.pose(proposal.pose()),
                              [&](int element) { return proposal.landmark(element); });
  if (!seen) return std::nullopt;
  seen->linearization.R = found.R;
  seen->linearization.nu = found.z_px - seen->predicted - proposal.expected(seen->linearization.errors);
  return seen->linearization;
}

bool PixelPrediction::is_in_image(const Eigen::Vector2d& pixel) const {
  return camera_.sees(pixel, kBorder_px);
}

/// Points are known by how they looked, which holds from about where they were first seen.
bool PixelPrediction::is_recognisable(const PixelMap& map, int feature, const CameraPose& here) const {
  const PixelMap::Feature& landmark = map.feature(feature);
  if (!landmark.is_point()) return true;
  const Eigen::Vector3d view = here.p_world_camera - map.state().landmark(landmark.element);
  const double ratio = view.norm() / landmark.first_view_m.norm();
  return ratio > kNearest && ratio < kFarthest &&
         view.normalized().dot(landmark.first_view_m.normalized()) > kMinCosine;
}

std::optional<Expectation> PixelPrediction::expect(PixelMap& map, int feature, const CameraPose& here) const {
  auto seen = predict_feature(map, feature, here);
  if (!seen || !is_in_image(seen->predicted) || !is_recognisable(map, feature, here)) return std::nullopt;
  Expectation expected;
  expected.id = map.feature(feature).id;
  expected.predicted_px = seen->predicted;
  expected.p_world_m = place(map, feature);
  add_process_noise(map, feature, expected.p_world_m, here);
  seen->linearization.R = noise_.of_search();
  expected.S = map.state().innovation_covariance(seen->linearization);
  if (!(expected.S.determinant() > 0.0)) return std::nullopt;
  expected.information_nats = 0.5 * std::log(expected.S.determinant() / seen->linearization.R.determinant());
  return expected;
}

Eigen::Vector3d PixelPrediction::place(const PixelMap& map, int feature) const {
  const PixelMap::Feature& landmark = map.feature(feature);
  const Eigen::Vector3d values = map.state().landmark(landmark.element);
  if (landmark.is_point()) return values;
  const double min_rho = 1.0 / farthest_m_;
  return point_of_ray(camera_.pose(map.anchor_pose(landmark.anchor)),
                      {values[0], values[1], std::max(values[2], min_rho)})
      .p_world;
}

void PixelPrediction::add_process_noise(PixelMap& map, int feature, const Eigen::Vector3d& p_world,
                                        const CameraPose& here) const {
  PixelMap::Feature& landmark = map.feature(feature);
  const Eigen::Vector3d view = p_world - here.p_world_camera;
  const double metres_per_px = view.norm() / camera_.options().fu_px;
  const double variance_m2 = noise_.process_noise_px2(p_world, landmark.seen_from_m, here.p_world_camera) *
                             metres_per_px * metres_per_px;
  landmark.seen_from_m = here.p_world_camera;
  const double rho = map.state().landmark(landmark.element)[2];
  const Eigen::Vector3d along = view.normalized();
  map.state().inflate(landmark.element,
                      landmark.is_point()
                          ? (variance_m2 * (Eigen::Matrix3d::Identity() - along * along.transpose())).eval()
                          : ray_covariance(variance_m2 * rho * rho * Eigen::Matrix2d::Identity(), 0.0));
}

}  // namespace waymark::ekf
