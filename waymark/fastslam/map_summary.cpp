#include "waymark/fastslam/map_summary.hpp"

namespace waymark::fastslam {
namespace {

std::vector<int> landmarks_in_map(const Belief& belief) {
  std::vector<int> indices;
  for (int k = 0; k < belief.landmarks.size(); ++k)
    if (belief.landmarks.is_in_map(k)) indices.push_back(k);
  return indices;
}

LandmarkEstimate summarise_landmark(const Belief& belief, int landmark) {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  Eigen::Matrix2d second = Eigen::Matrix2d::Zero();
  Eigen::Matrix2d within = Eigen::Matrix2d::Zero();
  const Eigen::Vector2d near = belief.store.at(landmark, 0).mean;
  for (int i = 0; i < belief.particles.count(); ++i) {
    const PointGaussian m = belief.store.at(landmark, i);
    const Eigen::Vector2d d = m.mean - near;
    const double w = belief.particles.weights()[static_cast<std::size_t>(i)];
    mean += w * d;
    within += w * m.covariance;
    second += w * d * d.transpose();
  }
  LandmarkEstimate estimate;
  estimate.id = belief.landmarks[landmark].id;
  estimate.observations = belief.landmarks[landmark].observations;
  estimate.position_m.head<2>() = near + mean;
  estimate.covariance.topLeftCorner<2, 2>() = within + second - mean * mean.transpose();
  estimate.within = Eigen::Matrix3d::Zero();
  estimate.within->topLeftCorner<2, 2>() = within;
  return estimate;
}

/// Of the particles before the pending motion, about (T_world_robot, landmarks).
Eigen::MatrixXd joint_covariance(const Belief& belief, const Pose2& T_world_robot,
                                 const std::vector<int>& indices, const Eigen::VectorXd& landmarks) {
  Eigen::MatrixXd P = Eigen::MatrixXd::Zero(3 + landmarks.size(), 3 + landmarks.size());
  Eigen::VectorXd deviation(P.rows());
  for (int i = 0; i < belief.particles.count(); ++i) {
    const double w = belief.particles.weights()[static_cast<std::size_t>(i)];
    deviation.head<3>() = difference(belief.particles.pose(i), T_world_robot);
    for (Eigen::Index k = 0; 2 * k < landmarks.size(); ++k) {
      const PointGaussian m = belief.store.at(indices[static_cast<std::size_t>(k)], i);
      deviation.segment<2>(3 + 2 * k) = m.mean - landmarks.segment<2>(2 * k);
      P.block<2, 2>(3 + 2 * k, 3 + 2 * k) += w * m.covariance;
    }
    P += w * deviation * deviation.transpose();  // Francisco (2)
  }
  return P;
}

}  // namespace

std::vector<LandmarkEstimate> summarise_landmarks(const Belief& belief) {
  std::vector<LandmarkEstimate> estimates;
  for (const int k : landmarks_in_map(belief)) estimates.push_back(summarise_landmark(belief, k));
  return estimates;
}

MapState summarise(const Belief& belief) {
  ParticleBlocks blocks(belief.particles.count());
  const Pose2 T_world_robot = estimate(belief.particles, blocks).T_world_robot;
  MapState map;
  const std::vector<int> indices = landmarks_in_map(belief);
  map.landmarks.resize(2 * static_cast<Eigen::Index>(indices.size()));
  for (std::size_t k = 0; k < indices.size(); ++k) {
    const LandmarkEstimate landmark = summarise_landmark(belief, indices[k]);
    map.ids.push_back(landmark.id);
    map.observations.push_back(landmark.observations);
    map.landmarks.segment<2>(2 * static_cast<Eigen::Index>(k)) = landmark.position_m.head<2>();
  }
  Eigen::MatrixXd P = joint_covariance(belief, T_world_robot, indices, map.landmarks);

  // The robot's rows follow the motion that the particles have not made yet.
  const Eigen::Matrix3d F = compose_jacobian_left(T_world_robot, belief.pending.increment);
  const Eigen::Matrix3d G = compose_jacobian_right(T_world_robot);
  P.topRows<3>() = (F * P.topRows<3>()).eval();
  P.leftCols<3>() = (P.leftCols<3>() * F.transpose()).eval();
  P.topLeftCorner<3, 3>() += G * belief.pending.covariance * G.transpose();
  map.T_world_robot = T_world_robot * belief.pending.increment;
  map.covariance = 0.5 * (P + P.transpose());
  return map;
}

}  // namespace waymark::fastslam
