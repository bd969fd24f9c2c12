#pragma once

#include <algorithm>
#include <memory>

#include <Eigen/Core>

#include "support/poses.hpp"
#include "waymark/core/random.hpp"
#include "waymark/ekf/state.hpp"

namespace waymark::test {

inline Motion random_motion(RandomStream& random) {
  const Pose2 increment{random.uniform(0.0, 0.3), random.uniform(-0.02, 0.02), random.uniform(-0.2, 0.2)};
  return {increment, random_covariance<3>(random, 1e-4)};
}

inline ekf::BiasTerms random_errors(RandomStream& random, int pairs) {
  ekf::BiasTerms errors;
  for (int k = 0; k < std::min(pairs, ekf::kBiasTerms); ++k) {
    if (random.uniform() < 0.3) continue;
    auto& error = errors[static_cast<std::size_t>(k)];
    error.pair = (k + static_cast<int>(random.uniform() * (pairs - 1))) % pairs;
    for (auto& entry : error.J.reshaped()) entry = 0.1 * random.normal();
  }
  if (errors[0].pair == errors[1].pair) errors[1].pair = -1;
  return errors;
}

/// An observation as a filter would linearise it, with Jacobians of no particular sensor.
inline ekf::LinearizedObservation random_observation(RandomStream& random, int landmark, int dimension,
                                                     int bias_pairs = 0) {
  ekf::LinearizedObservation s;
  s.landmark = landmark;
  s.rows = random.uniform() < 0.3 ? 1 : 2;
  s.nu = Eigen::Vector2d(random.normal(), random.normal()) * 0.05;
  for (auto& entry : s.H_pose.reshaped()) entry = random.normal();
  for (auto& entry : s.H_landmark.reshaped()) entry = random.normal();
  for (auto& entry : s.H_anchor.reshaped()) entry = random.normal();
  if (dimension == 2) s.H_landmark.col(2).setZero();
  s.R = random_covariance<2>(random, 0.05);
  s.errors = random_errors(random, bias_pairs);
  return s;
}

/// A robot that saw `landmarks` 2-D ones, in the invariant filter.
inline std::unique_ptr<ekf::State> small_map(RandomStream& random, int landmarks, int threads = 1) {
  auto made = std::make_unique<ekf::State>(2, landmarks, ekf::Consistency::kInvariant, threads);
  ekf::State& state = *made;
  state.predict({{0.1, 0.0, 0.1}, 1e-3 * Eigen::Matrix3d::Identity()});
  for (int i = 0; i < landmarks; ++i) {
    const Eigen::Vector3d position(random.uniform(-20.0, 20.0), random.uniform(-20.0, 20.0), 0.0);
    Eigen::Matrix3d G = Eigen::Matrix3d::Identity();
    G.block<2, 1>(0, 2) = perpendicular(position.head<2>());
    state.add(position, G, random_covariance<3>(random, 0.01));
  }
  return made;
}

/// P of all values of a belief, biases included.
inline Eigen::MatrixXd whole_covariance(const ekf::Belief& belief) {
  const auto n = static_cast<Eigen::Index>(belief.size());
  return Eigen::MatrixXd::NullaryExpr(n, n, [&belief](Eigen::Index i, Eigen::Index j) {
    return belief.covariance(static_cast<std::size_t>(i), static_cast<std::size_t>(j));
  });
}

/// J of what something linear depends on, as a dense matrix of n columns.
inline Eigen::MatrixXd dense(const ekf::SparseJacobian& jacobian, std::size_t n) {
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(jacobian.J.rows(), static_cast<Eigen::Index>(n));
  for (std::size_t k = 0; k < jacobian.size(); ++k)
    J.col(static_cast<Eigen::Index>(jacobian.rows[k])) += jacobian.J.col(static_cast<Eigen::Index>(k));
  return J;
}

}  // namespace waymark::test
