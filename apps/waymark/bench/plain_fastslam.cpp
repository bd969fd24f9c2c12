#include "plain_fastslam.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "waymark/core/angle.hpp"
#include "waymark/models/observation_models.hpp"

namespace waymark::app {

PlainFastSlam::PlainFastSlam(int particles, std::span<const Observation> all_landmarks) {
  Particle first;
  for (const Observation& each : all_landmarks) {
    const auto [p, G_pose, G] = RangeBearingModel::locate({}, {}, std::get<RangeBearing>(each.value));
    first.landmarks.push_back({p, G * *each.covariance * G.transpose()});
  }
  particles_.assign(static_cast<std::size_t>(particles), first);
}

void PlainFastSlam::step(const Motion& motion, std::span<const Observation> observations) {
  const Eigen::Matrix3d L = motion.covariance.llt().matrixL();
  for (Particle& particle : particles_) {
    const Eigen::Vector3d n = L * Eigen::Vector3d(random_.normal(), random_.normal(), random_.normal());
    const Pose2& d = motion.increment;
    // Francisco (5)
    particle.T_world_robot = particle.T_world_robot * Pose2{d.x_m + n[0], d.y_m + n[1], d.theta_rad + n[2]};
    for (const Observation& each : observations) update(particle, each);
  }
  resample();
}

void PlainFastSlam::update(Particle& particle, const Observation& observation) {
  Landmark& landmark = particle.landmarks[static_cast<std::size_t>(observation.id->number)];
  const auto& z = std::get<RangeBearing>(observation.value);
  const Pose2& pose = particle.T_world_robot;
  const Eigen::Vector2d d = landmark.mean - pose.position();
  const double r = d.norm();
  const Eigen::Vector2d nu(z.range_m - r,
                           wrap_angle(z.bearing_rad - std::atan2(d.y(), d.x()) + pose.theta_rad));
  Eigen::Matrix2d H;
  H << d.x() / r, d.y() / r, -d.y() / (r * r), d.x() / (r * r);
  const Eigen::Matrix2d PHt = landmark.covariance * H.transpose();
  const Eigen::Matrix2d Z = H * PHt + *observation.covariance;
  const Eigen::Matrix2d K = PHt * Z.inverse();
  // Francisco (6)
  particle.log_weight -= 0.5 * (nu.dot(Z.inverse() * nu) + std::log(Z.determinant()));  // Francisco (7)
  landmark.mean += K * nu;
  landmark.covariance -= K * PHt.transpose();
}

void PlainFastSlam::resample() {
  double best = particles_.front().log_weight;
  for (const Particle& each : particles_) best = std::max(best, each.log_weight);
  std::vector<double> prefix;
  double sum = 0.0;
  for (const Particle& each : particles_) prefix.push_back(sum += std::exp(each.log_weight - best));
  const auto count = static_cast<double>(particles_.size());
  const double u = random_.uniform();
  chosen_.clear();
  std::size_t from = 0;
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    while (from + 1 < prefix.size() && prefix[from] * count < (static_cast<double>(i) + u) * sum) ++from;
    chosen_.push_back(particles_[from]);
    chosen_.back().log_weight = 0.0;
  }
  particles_.swap(chosen_);
}

}  // namespace waymark::app
