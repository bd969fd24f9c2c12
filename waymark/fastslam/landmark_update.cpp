#include "waymark/fastslam/landmark_update.hpp"

#include <algorithm>
#include <cmath>

#include "waymark/models/observation_models.hpp"

namespace waymark::fastslam {
namespace {

/// From a particle's sensor to its landmark, and what the sighting has to say about that.
struct Ray {
  double r;   ///< length, m
  double ux;  ///< direction in the world, unit vector; across is (-uy, ux), to the left
  double uy;
  double nu_r;  ///< innovation
  double nu_b;
};

inline Ray ray_of(const Sighting& z, const Particles& p, const LandmarkColumns& landmark, std::size_t i) {
  const double c = p.cos_theta[i];
  const double s = p.sin_theta[i];
  const double dx = landmark.x[i] - (p.x_m[i] + c * z.sensor_x_m - s * z.sensor_y_m);
  const double dy = landmark.y[i] - (p.y_m[i] + s * z.sensor_x_m + c * z.sensor_y_m);
  const double r = std::max(std::sqrt(dx * dx + dy * dy), kMinDistance_m);
  const double ux = dx / r;
  const double uy = dy / r;
  // The bearing's innovation is the angle from the ray to the measured direction, without a difference to
  // wrap.
  const double ahead = c * ux + s * uy;
  const double left = c * uy - s * ux;
  const double cross = z.sin_bearing * ahead - z.cos_bearing * left;
  const double dot = z.cos_bearing * ahead + z.sin_bearing * left;
  return {r, ux, uy, z.range_m - r, std::atan2(cross, dot)};
}

}  // namespace

Sighting::Sighting(const RangeBearing& z, const Eigen::Matrix2d& R, const Pose2& T_robot_sensor)
    : sensor_x_m(T_robot_sensor.x_m),
      sensor_y_m(T_robot_sensor.y_m),
      range_m(z.range_m),
      cos_bearing(std::cos(z.bearing_rad + T_robot_sensor.theta_rad)),
      sin_bearing(std::sin(z.bearing_rad + T_robot_sensor.theta_rad)),
      R_rr(R(0, 0)),
      R_rb(R(0, 1)),
      R_bb(R(1, 1)) {}

InnovationMoments update_landmark(const Sighting& z, const Particles& p, const LandmarkColumns& before,
                                  const LandmarkColumns& after, double* log_likelihood, std::size_t begin,
                                  std::size_t end) {
  InnovationMoments moments{};
  // Innovations about half a turn off have either sign; their mean is taken on one side, that of the first
  // particle.
  const double side_rad = ray_of(z, p, before, 0).nu_b;
  for (std::size_t i = begin; i < end; ++i) {
    const LandmarkGaussian m = before.at(i);
    const auto [r, ux, uy, nu_r, nu_b] = ray_of(z, p, before, i);
    const double nu_t = r * nu_b;

    const double S_aa = ux * ux * m.xx + 2.0 * ux * uy * m.xy + uy * uy * m.yy;
    const double S_at = ux * uy * (m.yy - m.xx) + (ux * ux - uy * uy) * m.xy;
    const double S_tt = uy * uy * m.xx - 2.0 * ux * uy * m.xy + ux * ux * m.yy;
    const double R_at = r * z.R_rb;
    const double R_tt = r * r * z.R_bb;
    const double Z_aa = S_aa + z.R_rr;
    const double Z_at = S_at + R_at;
    const double Z_tt = S_tt + R_tt;
    const double det_z = Z_aa * Z_tt - Z_at * Z_at;

    // f = Z^-1 e, so that d^2 = e . f and m' = m + Sigma f, turned back into the world.
    const double f_a = (Z_tt * nu_r - Z_at * nu_t) / det_z;
    const double f_t = (Z_aa * nu_t - Z_at * nu_r) / det_z;
    const double step_a = S_aa * f_a + S_at * f_t;
    const double step_t = S_at * f_a + S_tt * f_t;
    after.x[i] = m.x + ux * step_a - uy * step_t;
    after.y[i] = m.y + uy * step_a + ux * step_t;

    const double weight_of_landmark = (z.R_rr * R_tt - R_at * R_at) / det_z;
    const double weight_of_noise = std::max(m.xx * m.yy - m.xy * m.xy, 0.0) / det_z;
    after.xx[i] = weight_of_landmark * m.xx +
                  weight_of_noise * (ux * ux * z.R_rr - 2.0 * ux * uy * R_at + uy * uy * R_tt);
    after.xy[i] = weight_of_landmark * m.xy +
                  weight_of_noise * (ux * uy * (z.R_rr - R_tt) + (ux * ux - uy * uy) * R_at);
    after.yy[i] = weight_of_landmark * m.yy +
                  weight_of_noise * (uy * uy * z.R_rr + 2.0 * ux * uy * R_at + ux * ux * R_tt);

    const double d2 = nu_r * f_a + nu_t * f_t;
    log_likelihood[i] = -0.5 * (d2 + std::log(det_z / (r * r)));

    const double w = p.weight[i];
    const double nu = side_rad + wrap_angle(nu_b - side_rad);
    moments[0] += w * nu_r;
    moments[1] += w * nu;
    moments[2] += w * (Z_aa + nu_r * nu_r);
    moments[3] += w * (Z_at / r + nu_r * nu);
    moments[4] += w * (Z_tt / (r * r) + nu * nu);
    moments[5] += w * log_likelihood[i];
  }
  return moments;
}

void place_landmark(const Sighting& z, const Particles& p, const LandmarkColumns& landmark, std::size_t begin,
                    std::size_t end) {
  const double R_at = z.range_m * z.R_rb;
  const double R_tt = z.range_m * z.range_m * z.R_bb;
  for (std::size_t i = begin; i < end; ++i) {
    const double c = p.cos_theta[i];
    const double s = p.sin_theta[i];
    const double ux = c * z.cos_bearing - s * z.sin_bearing;
    const double uy = s * z.cos_bearing + c * z.sin_bearing;
    landmark.x[i] = p.x_m[i] + c * z.sensor_x_m - s * z.sensor_y_m + z.range_m * ux;
    landmark.y[i] = p.y_m[i] + s * z.sensor_x_m + c * z.sensor_y_m + z.range_m * uy;
    landmark.xx[i] = ux * ux * z.R_rr - 2.0 * ux * uy * R_at + uy * uy * R_tt;
    landmark.xy[i] = ux * uy * (z.R_rr - R_tt) + (ux * ux - uy * uy) * R_at;
    landmark.yy[i] = uy * uy * z.R_rr + 2.0 * ux * uy * R_at + ux * ux * R_tt;
  }
}

}  // namespace waymark::fastslam
