#include "waymark/calibrate/plane_homography.hpp"

#include <cmath>
#include <vector>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SVD>

namespace waymark::calibrate {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using PlanePoints = std::vector<Vector2d>;

/// Moves the points about the origin, at a mean distance of sqrt(2).
Matrix3d scaling(const PlanePoints& points) {
  Vector2d mean = Vector2d::Zero();
  for (const Vector2d& p : points) mean += p;
  mean /= static_cast<double>(points.size());
  double distance = 0.0;
  for (const Vector2d& p : points) distance += (p - mean).norm();
  const double s = std::sqrt(2.0) * static_cast<double>(points.size()) / distance;
  return Matrix3d{{s, 0.0, -s * mean.x()}, {0.0, s, -s * mean.y()}, {0.0, 0.0, 1.0}};
}

/// Two rows for each pair; the homography is in their null space.
Eigen::MatrixX<double> equations(const PlanePoints& from, const PlanePoints& to, const Matrix3d& T_from,
                                 const Matrix3d& T_to) {
  Eigen::MatrixX<double> A(2 * static_cast<Eigen::Index>(from.size()), 9);
  A.setZero();
  for (std::size_t i = 0; i < from.size(); ++i) {
    const Eigen::RowVector3d p = (T_from * from[i].homogeneous()).transpose();
    const Eigen::Vector3d q = T_to * to[i].homogeneous();
    const auto row = static_cast<Eigen::Index>(2 * i);
    A.block<1, 3>(row, 0) = p;
    A.block<1, 3>(row, 6) = -q.x() * p;
    A.block<1, 3>(row + 1, 3) = p;
    A.block<1, 3>(row + 1, 6) = -q.y() * p;
  }
  return A;
}

}  // namespace

std::optional<Matrix3d> plane_homography(const Board& board, const BoardCorners& corners) {
  constexpr double kSingular = 1e-6;
  if (corners.size() < 4) return std::nullopt;
  PlanePoints from, to;
  for (const auto& [index, pixel] : corners) {
    from.push_back(board.corner_m(index));
    to.push_back(pixel);
  }
  const Matrix3d T_from = scaling(from), T_to = scaling(to);
  const Eigen::MatrixX<double> A = equations(from, to, T_from, T_to);
  const Eigen::JacobiSVD<Eigen::MatrixX<double>> svd(A, Eigen::ComputeFullV);
  const auto& values = svd.singularValues();
  if (!A.allFinite() || !(values[7] > kSingular * values[0])) return std::nullopt;
  const Eigen::Matrix<double, 9, 1> h = svd.matrixV().col(8);
  const Matrix3d H =
      T_to.inverse() * Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(h.data()) * T_from;
  return H / H(2, 2);
}

}  // namespace waymark::calibrate
