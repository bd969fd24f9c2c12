#include "waymark/models/homography.hpp"

#include <cmath>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "waymark/core/symmetric_eigen.hpp"

namespace waymark {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;

using Side = Vector2d PlacePair::*;

/// Moves the points of one side about the origin, at a mean distance of sqrt(2).
Matrix3d scaling(std::span<const PlacePair> pairs, Side side) {
  const auto count = static_cast<double>(pairs.size());
  Vector2d mean = Vector2d::Zero();
  for (const PlacePair& pair : pairs) mean += pair.*side;
  mean /= count;
  double distance = 0.0;
  for (const PlacePair& pair : pairs) distance += (pair.*side - mean).norm();
  const double s = std::sqrt(2.0) * count / distance;
  return Matrix3d{{s, 0.0, -s * mean.x()}, {0.0, s, -s * mean.y()}, {0.0, 0.0, 1.0}};
}

/// A^T A, where A has two rows for each pair and the homography is in its null space.
SmallMatrix normal_matrix(std::span<const PlacePair> pairs, const Matrix3d& T_from, const Matrix3d& T_to) {
  SmallMatrix sum = SmallMatrix::Zero(9, 9);
  for (const PlacePair& pair : pairs) {
    const Eigen::Vector3d p = T_from * pair.from.homogeneous();
    const Eigen::Vector3d q = T_to * pair.to.homogeneous();
    for (Eigen::Index axis = 0; axis < 2; ++axis) {
      Eigen::Matrix<double, 9, 1> row = Eigen::Matrix<double, 9, 1>::Zero();
      row.segment<3>(3 * axis) = p;
      row.tail<3>() = -q[axis] * p;
      sum += row * row.transpose();
    }
  }
  return sum;
}

}  // namespace

std::optional<Matrix3d> homography(std::span<const PlacePair> pairs) {
  constexpr double kSingular = 1e-6;
  if (pairs.size() < 4) return std::nullopt;
  const Matrix3d T_from = scaling(pairs, &PlacePair::from), T_to = scaling(pairs, &PlacePair::to);
  const SmallMatrix A = normal_matrix(pairs, T_from, T_to);
  if (!A.allFinite()) return std::nullopt;
  const auto [squares, vectors] = symmetric_eigen(A);
  if (!(squares[1] > kSingular * kSingular * squares[8])) return std::nullopt;
  const Matrix3d scaled = vectors.col(0).reshaped<Eigen::RowMajor>(3, 3);
  const Matrix3d H = T_to.inverse() * scaled * T_from;
  return H / H(2, 2);
}

}  // namespace waymark
