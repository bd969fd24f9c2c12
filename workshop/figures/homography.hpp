#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "waymark/models/homography.hpp"

namespace waymark {

/// A homography, now ~ H (before, 1), and which pairs agree with it.
struct Consensus {
  Eigen::Matrix3d H = Eigen::Matrix3d::Identity();
  std::vector<bool> agrees;

  [[nodiscard]] Eigen::Vector2d map(const Eigen::Vector2d& before) const;
  /// d(now)/d(before)
  [[nodiscard]] Eigen::Matrix2d derivative(const Eigen::Vector2d& before) const;
  [[nodiscard]] std::size_t size() const;
};

/// The homography with which most pairs agree within `threshold_px`: RANSAC with fixed draws (Fischler and
/// Bolles 1981), then least squares over those that agree. The identity and nobody with fewer than five.
[[nodiscard]] Consensus find_homography(std::span<const PlacePair> pairs, double threshold_px);

}  // namespace waymark
