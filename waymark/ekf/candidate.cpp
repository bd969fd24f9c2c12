#include "waymark/ekf/candidate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "waymark/models/pixel_model.hpp"

namespace waymark::ekf {

void Candidate::start(LandmarkId seen, int from, const Eigen::Vector2d& ray_xy,
                      const Eigen::Matrix2d& covariance) {
  id = seen;
  anchor = from;
  xy = ray_xy;
  xy_covariance = covariance;
  depths.restart();
  images = looks = matches = 0;
}

CandidatePrediction::CandidatePrediction(const Candidate& candidate, const PixelMap& map,
                                         const PixelPrediction& prediction)
    : candidate_(candidate),
      prediction_(prediction),
      here_(prediction.camera_pose(map)),
      anchor_(prediction.camera().pose(map.anchor_pose(candidate.anchor))) {
  const State& state = map.state();
  const std::size_t anchor = state.offset(map.anchor_element(candidate.anchor));
  const std::array<std::size_t, 6> rows{0, 1, 2, anchor, anchor + 1, anchor + 2};
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j)
      P_(i, j) = state.covariance(rows[static_cast<std::size_t>(i)], rows[static_cast<std::size_t>(j)]);
}

std::optional<CandidatePrediction::PredictedPixel> CandidatePrediction::at(double rho_per_m) const {
  const Eigen::Vector3d ray = candidate_.ray(rho_per_m);
  const auto h = observe_ray(prediction_.camera(), here_, anchor_, ray);
  if (!h) return std::nullopt;
  Eigen::Matrix<double, 2, 6> H;
  H << h->H_pose, h->H_anchor;
  const Eigen::Matrix2d H_xy = h->H_ray.leftCols<2>();
  const PixelNoise& noise = prediction_.noise();
  const BiasTerms jittered = noise.attitude_jitter(h->p_camera, h->dpixel_dpoint);
  const Eigen::Matrix2d J = jittered[0].J.topRows<2>();
  const double process_noise_px2 = rho_per_m > 0.0
                                       ? noise.process_noise_px2(point_of_ray(anchor_, ray).p_world,
                                                                 anchor_.p_world_camera, here_.p_world_camera)
                                       : 0.0;
  return PredictedPixel{h->predicted,
                        H * P_ * H.transpose() + H_xy * candidate_.xy_covariance * H_xy.transpose() +
                            J * J.transpose() + process_noise_px2 * Eigen::Matrix2d::Identity()};
}

std::optional<Expectation> CandidatePrediction::expect() const {
  const auto [mean, sigma] = candidate_.depths.inverse_depth();
  const double step = std::sqrt(3.0) * sigma;
  const auto middle = at(mean);
  const auto near = at(mean + step);
  const auto far = at(std::max(0.0, mean - step));
  if (!middle || !near || !far) return std::nullopt;
  Expectation expected;
  expected.id = candidate_.id;
  expected.candidate = true;
  expected.predicted_px = (4.0 * middle->pixel + near->pixel + far->pixel) / 6.0;
  expected.S = prediction_.noise().of_search();
  for (const auto& [weight, one] : {std::pair(4.0 / 6.0, *middle), {1.0 / 6.0, *near}, {1.0 / 6.0, *far}}) {
    const Eigen::Vector2d d = one.pixel - expected.predicted_px;
    expected.S += weight * (one.S + d * d.transpose());
  }
  if (!prediction_.is_in_image(expected.predicted_px) || !expected.S.allFinite()) return std::nullopt;
  expected.p_world_m = point_of_ray(anchor_, candidate_.ray(mean)).p_world;
  return expected;
}

}  // namespace waymark::ekf
