#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "waymark/core/aligned_array.hpp"
#include "waymark/core/motion.hpp"
#include "waymark/ekf/consistency.hpp"
#include "waymark/ekf/covariance.hpp"
#include "waymark/ekf/linearized_observation.hpp"
#include "waymark/ekf/state_layout.hpp"

namespace waymark::ekf {

/// What is believed of the robot, the biases and the landmarks: a mean and a covariance, and all that
/// follows from these. Nothing here changes them; State does, which is a belief. World frame, m and rad.
class Belief {
 public:
  [[nodiscard]] const StateLayout& layout() const { return layout_; }
  [[nodiscard]] int dimension() const { return layout_.dimension; }
  [[nodiscard]] int landmarks() const { return layout_.landmarks; }
  /// Row or column of a landmark in mean and covariance.
  [[nodiscard]] std::size_t offset(int index) const { return layout_.offset(index); }
  /// n
  [[nodiscard]] std::size_t size() const { return layout_.size(); }
  [[nodiscard]] Consistency consistency() const { return consistency_; }

  [[nodiscard]] PoseEstimate pose() const { return {StateLayout::pose(x_.data()), P_.block<3>(0)}; }
  /// Position and covariance of a landmark; z is 0 for 2-D ones.
  [[nodiscard]] Eigen::Vector3d landmark(int index) const { return layout_.landmark(x_.data(), index); }
  [[nodiscard]] Eigen::Matrix3d landmark_covariance(int index) const;
  /// Turns of the world leave it alone: it is relative to another landmark.
  [[nodiscard]] bool is_relative(int index) const { return relative_[static_cast<std::size_t>(index)] != 0; }
  /// First estimate of a landmark.
  [[nodiscard]] Eigen::Vector3d first_estimate(int index) const {
    return layout_.landmark(first_.data(), index);
  }

  /// Expected values of a pair of biases; zero at first, and certainly so.
  [[nodiscard]] Eigen::Vector2d biases(int pair) const { return bias_pair(x_.data(), pair); }
  /// Covariance of a pair with another, or with itself.
  [[nodiscard]] Eigen::Matrix2d bias_covariance(int pair, int other) const {
    return P_.block<2>(bias_offset(pair), bias_offset(other));
  }
  /// What is expected of the errors in an observation.
  [[nodiscard]] Eigen::Vector2d expected(const BiasTerms& terms) const { return bias_part(x_.data(), terms); }

  /// Where Jacobians are to be taken: the present estimate, or the first ones with kFej.
  [[nodiscard]] Pose2 linearization_pose() const { return StateLayout::pose(linearization()); }
  [[nodiscard]] Eigen::Vector3d linearization_landmark(int index) const {
    return layout_.landmark(linearization(), index);
  }

  /// S = H P H^T + R of one observation (its leading rows x rows part counts), from marginals only: O(1).
  [[nodiscard]] Eigen::Matrix2d innovation_covariance(const LinearizedObservation& linearized) const;
  /// H_a P H_b^T: what two observations have in common besides their noise. O(1).
  [[nodiscard]] Eigen::Matrix2d common_covariance(const LinearizedObservation& a,
                                                  const LinearizedObservation& b) const;
  /// C = P(pose, :) H^T of one observation: how what it measures goes with (x, y, theta). O(1).
  [[nodiscard]] Eigen::Matrix<double, 3, 2> pose_correlation(const LinearizedObservation& linearized) const;

  /// One entry of the covariance.
  [[nodiscard]] double covariance(std::size_t i, std::size_t j) const { return P_(i, j); }
  /// Mean and symmetric covariance of robot and landmarks; allocates.
  [[nodiscard]] Eigen::VectorXd mean() const;
  [[nodiscard]] Eigen::MatrixXd covariance() const;

 protected:
  /// No landmarks yet; memory for `capacity` of them.
  Belief(const StateLayout& layout, int capacity, Consistency consistency);
  ~Belief() = default;

  [[nodiscard]] const double* linearization() const {
    return linearizes_at_first_estimates(consistency_) ? first_.data() : x_.data();
  }

  StateLayout layout_;
  Consistency consistency_;
  AlignedArray<double> x_;      // n: the mean
  AlignedArray<double> first_;  // n: the pose as it was predicted, landmarks as they were added
  std::vector<char> relative_;  // by landmark
  Covariance P_;
};

}  // namespace waymark::ekf
