#include "waymark/ekf/pixel_noise.hpp"

#include <cmath>

#include <Eigen/Geometry>

#include "waymark/core/angle.hpp"

namespace waymark::ekf {
namespace {

/// Variance of a place that is known to the whole pixel, px^2: that of a uniform distribution 1 px wide.
constexpr double kRounding_px2 = 1.0 / 12.0;

}  // namespace

PixelNoise::PixelNoise(const PixelSlamOptions& options)
    : own_(options.sigma_px * options.sigma_px * Eigen::Matrix2d::Identity()),
      model_(options.model_sigma_px * options.model_sigma_px * Eigen::Matrix2d::Identity()),
      search_(model_ + kRounding_px2 * Eigen::Matrix2d::Identity()),
      landmark_noise_px_(options.landmark_noise_px),
      jitter_rad_(to_radians(options.jitter_deg)) {}

Eigen::Matrix2d PixelNoise::of(const Observation& observation) const {
  return model_ + observation.covariance.value_or(own_);
}

void PixelNoise::begin_image(State& state) const {
  if (has_jitter()) state.propagate_bias(0, 0.0);
}

BiasTerms PixelNoise::attitude_jitter(const Eigen::Vector3d& p_camera,
                                      const Eigen::Matrix<double, 2, 3>& J) const {
  BiasTerms terms;
  if (!has_jitter()) return terms;
  terms[0].pair = 0;
  terms[0].J.topRows<2>() << jitter_rad_ * J * Eigen::Vector3d::UnitX().cross(p_camera),
      jitter_rad_ * J * Eigen::Vector3d::UnitZ().cross(p_camera);
  return terms;
}

double PixelNoise::process_noise_px2(const Eigen::Vector3d& p_world, const Eigen::Vector3d& from,
                                     const Eigen::Vector3d& to) const {
  const Eigen::Vector3d before = from - p_world, now = to - p_world;
  const double angle_rad = std::atan2(before.cross(now).norm(), before.dot(now));
  return landmark_noise_px_ * landmark_noise_px_ * to_degrees(angle_rad);
}

}  // namespace waymark::ekf
