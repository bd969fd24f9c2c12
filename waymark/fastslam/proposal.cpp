#include "waymark/fastslam/proposal.hpp"

#include <cmath>
#include <utility>

#include <Eigen/LU>

#include "waymark/models/observation_models.hpp"

namespace waymark::fastslam {
namespace {

/// Symmetric to the last bit, which differences of products are not.
Eigen::Matrix3d symmetric(const Eigen::Matrix3d& P) { return 0.5 * (P + P.transpose()); }

}  // namespace

Proposal::Proposal(int particles)
    : now_(static_cast<std::size_t>(particles)),
      draft_(static_cast<std::size_t>(particles)),
      log_likelihood_(static_cast<std::size_t>(particles)) {}

void Proposal::start(const Particles& particles, const Motion& motion, ParticleBlocks& blocks) {
  blocks.run([&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const PoseEstimate after =
          propagate({particles.pose(static_cast<int>(i)), Eigen::Matrix3d::Zero()}, motion);
      const Pose2& T = after.T_world_robot;
      now_[i] = {{T.x_m, T.y_m, T.theta_rad}, after.covariance};
    }
  });
}

InnovationMoments Proposal::condition(const RangeBearing& z, const Eigen::Matrix2d& R,
                                      const Pose2& T_robot_sensor, const Particles& particles,
                                      const LandmarkColumns& landmark, ParticleBlocks& blocks) {
  const auto linearize = [&](std::size_t i) {
    const Eigen::Vector3d& mu = now_[i].mean;
    return RangeBearingModel::linearize({mu.x(), mu.y(), mu.z()}, T_robot_sensor,
                                        {landmark.x[i], landmark.y[i]});
  };
  const double side_rad = RangeBearingModel::innovation(z, linearize(0).predicted).y();
  return blocks.sum([&](std::size_t begin, std::size_t end) {
    InnovationMoments moments{};
    for (std::size_t i = begin; i < end; ++i) {
      const auto [predicted, Hx, Hm] = linearize(i);
      const LandmarkGaussian m = landmark.at(i);
      const Eigen::Matrix3d& P = now_[i].covariance;
      const Eigen::Vector2d nu = RangeBearingModel::innovation(z, predicted);
      const Eigen::Matrix2d Z = Hm * Eigen::Matrix2d{{m.xx, m.xy}, {m.xy, m.yy}} * Hm.transpose() + R;
      const Eigen::Matrix<double, 3, 2> PHt = P * Hx.transpose();
      const Eigen::Matrix2d L = Hx * PHt + Z;
      const Eigen::Matrix2d L_inverse = L.inverse();
      const Eigen::Matrix<double, 3, 2> K = PHt * L_inverse;
      draft_[i] = {now_[i].mean + K * nu, symmetric(P - K * PHt.transpose())};
      log_likelihood_[i] = -0.5 * (nu.dot(L_inverse * nu) + std::log(L.determinant()));

      const double w = particles.weight[i];
      const double nu_b = side_rad + wrap_angle(nu.y() - side_rad);
      moments[0] += w * nu.x();
      moments[1] += w * nu_b;
      moments[2] += w * (L(0, 0) + nu.x() * nu.x());
      moments[3] += w * (L(0, 1) + nu.x() * nu_b);
      moments[4] += w * (L(1, 1) + nu_b * nu_b);
      moments[5] += w * log_likelihood_[i];
    }
    return moments;
  });
}

void Proposal::accept(Particles& particles, double evidence) {
  std::swap(now_, draft_);
  for (std::size_t i = 0; i < log_likelihood_.size(); ++i)
    particles.log_weight[i] += evidence * log_likelihood_[i];
}

void Proposal::sample(Particles& particles, const StreamKey& key, ParticleBlocks& blocks) const {
  blocks.run([&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      RandomStream random(key.seed, key.purpose, key.step, static_cast<std::uint32_t>(i));
      const double n0 = random.normal();
      const double n1 = random.normal();
      const double n2 = random.normal();
      const Eigen::Vector3d x =
          now_[i].mean + semidefinite_root(now_[i].covariance) * Eigen::Vector3d(n0, n1, n2);
      particles.set_pose(i, {x.x(), x.y(), x.z()});
    }
  });
}

}  // namespace waymark::fastslam
