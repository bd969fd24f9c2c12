#pragma once

#include <array>

#include <Eigen/Core>

#include "waymark/core/observation.hpp"
#include "waymark/core/pose2.hpp"
#include "waymark/fastslam/landmark_store.hpp"
#include "waymark/fastslam/particles.hpp"

namespace waymark::fastslam {

/// A range-bearing sighting with all that is the same for every particle.
struct Sighting {
  Sighting(const RangeBearing& z, const Eigen::Matrix2d& R, const Pose2& T_robot_sensor);

  double sensor_x_m;  ///< the sensor in the robot frame
  double sensor_y_m;
  double range_m;
  double cos_bearing;  ///< of the bearing in the robot frame, mounting yaw included
  double sin_bearing;
  double R_rr;  ///< noise covariance of (range, bearing)
  double R_rb;
  double R_bb;
};

/// sum w (nu_r, nu_b, P_rr, P_rb, P_bb, l) over particles of weight w, with nu the innovation, P = Z + nu
/// nu^T its second moment about zero (Z = H Sigma H^T + R) and l the log-likelihood. To take the mean of
/// angles, nu_b is within half a turn of that of the first particle, and so may leave (-pi, pi].
using InnovationMoments = std::array<double, 6>;

/// For each particle in [begin, end): the EKF update of its landmark (Montemerlo et al. 2002), from `before`
/// to `after`, and the log-likelihood log N(nu; 0, Z) but for its constant log 2 pi. Measuring the bearing's
/// error in metres across the ray makes H a rotation, and then, in the frame of the ray with e = (nu_r, r
/// nu_b),
///     Z = Sigma + R,   m' = m + Sigma Z^-1 e,   Sigma' = (det R Sigma + det Sigma R) / det Z.
/// The last is (I - K H) Sigma as 2x2 matrices allow it to be written: a sum of positive terms. It stays
/// positive however sharp the sensor, which the usual difference does not, and is cheaper than Joseph's form.
InnovationMoments update_landmark(const Sighting& z, const Particles& p, const LandmarkColumns& before,
                                  const LandmarkColumns& after, double* log_likelihood, std::size_t begin,
                                  std::size_t end);

/// For each particle in [begin, end): the landmark that it sees for the first time, Sigma = Hm^-1 R Hm^-T.
void place_landmark(const Sighting& z, const Particles& p, const LandmarkColumns& landmark, std::size_t begin,
                    std::size_t end);

}  // namespace waymark::fastslam
