#pragma once

#include <cmath>
#include <span>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "waymark/ekf/state.hpp"

namespace waymark::test {

/// EKF-SLAM as the textbook writes it, in long double and with dense matrices: what the fast state is held
/// against.
class DenseFilter {
 public:
  using Scalar = long double;
  using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;
  using Vector = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;

  DenseFilter(int dimension, ekf::Consistency consistency, int bias_pairs = 0)
      : dimension_(dimension),
        head_(3 + 2 * bias_pairs),
        consistency_(consistency),
        x_(Vector::Zero(head_)),
        P_(Matrix::Zero(head_, head_)),
        linearized_(Vector::Zero(3)) {}

  void predict(const Motion& motion) {
    const Vector base = consistency_ == ekf::Consistency::kFej ? linearized_ : Vector(x_.head(3));
    const Scalar c = std::cos(x_[2]);
    const Scalar s = std::sin(x_[2]);
    const Scalar dx = motion.increment.x_m;
    const Scalar dy = motion.increment.y_m;
    x_[0] += c * dx - s * dy;
    x_[1] += s * dx + c * dy;
    x_[2] = wrap(x_[2] + Scalar(motion.increment.theta_rad));
    Matrix F = Matrix::Identity(size(), size());
    F(0, 2) = -(x_[1] - base[1]);
    F(1, 2) = x_[0] - base[0];
    Matrix G = Matrix::Zero(size(), 3);
    G(0, 0) = G(1, 1) = std::cos(base[2]);
    G(1, 0) = std::sin(base[2]);
    G(0, 1) = -G(1, 0);
    G(2, 2) = 1;
    P_ = F * P_ * F.transpose() + G * motion.covariance.cast<Scalar>() * G.transpose();
    linearized_ = x_.head(3);
  }

  void propagate_bias(int pair, double rho) {
    Matrix F = Matrix::Identity(size(), size());
    F.block(3 + 2 * pair, 3 + 2 * pair, 2, 2) *= Scalar(rho);
    x_ = (F * x_).eval();
    P_ = (F * P_ * F.transpose()).eval();
    for (int k = 0; k < 2; ++k) P_(3 + 2 * pair + k, 3 + 2 * pair + k) += 1 - Scalar(rho) * Scalar(rho);
  }

  /// S = H P H^T + R of all observations together.
  [[nodiscard]] Eigen::MatrixXd innovation_covariance(
      std::span<const ekf::LinearizedObservation> linearizations) const {
    const auto [H, R, nu] = stack(linearizations);
    return (H * P_ * H.transpose() + R).cast<double>();
  }

  void update(std::span<const ekf::LinearizedObservation> linearizations) {
    const auto [H, R, nu] = stack(linearizations);
    const Matrix S = H * P_ * H.transpose() + R;
    const Matrix K = S.llt().solve(H * P_).transpose();
    const Vector dx = K * nu;
    const Matrix I_KH = Matrix::Identity(size(), size()) - K * H;
    P_ = (I_KH * P_ * I_KH.transpose() + K * R * K.transpose()).eval();  // Joseph's form
    consistency_ == ekf::Consistency::kInvariant ? move_invariantly(dx) : move(dx);
  }

  void add(const Eigen::Vector3d& position, const Eigen::Matrix3d& G_pose, const Eigen::Matrix3d& noise,
           const ekf::BiasTerms& errors = {}) {
    const int n = size();
    Matrix G = error_columns(errors, dimension_);
    G.leftCols(3) = G_pose.topRows(dimension_).cast<Scalar>();
    Matrix grown(n + dimension_, n + dimension_);
    grown.topLeftCorner(n, n) = P_;
    grown.bottomLeftCorner(dimension_, n) = G * P_;
    grown.topRightCorner(n, dimension_) = grown.bottomLeftCorner(dimension_, n).transpose();
    grown.bottomRightCorner(dimension_, dimension_) =
        G * P_ * G.transpose() + noise.topLeftCorner(dimension_, dimension_).cast<Scalar>();
    P_ = grown;
    x_.conservativeResize(n + dimension_);
    x_.tail(dimension_) = position.head(dimension_).cast<Scalar>();
    relative_.push_back(false);
  }

  void add_pose() {
    const Eigen::Vector3d here = x_.head(3).cast<double>();
    add(here, Eigen::Matrix3d::Identity(), Eigen::Matrix3d::Zero());
    x_.tail(3) = x_.head(3).eval();
  }

  void add_relative(const Eigen::Vector3d& values, const Eigen::Matrix3d& noise) {
    add(values, Eigen::Matrix3d::Zero(), noise);
    relative_.back() = true;
  }

  void make_absolute(int landmark, int anchor, const Eigen::Vector3d& position,
                     const Eigen::Matrix3d& G_anchor, const Eigen::Matrix3d& G_landmark) {
    Matrix G = Matrix::Identity(size(), size());
    G.block(place(landmark), place(landmark), 3, 3) = G_landmark.cast<Scalar>();
    G.block(place(landmark), place(anchor), 3, 3) = G_anchor.cast<Scalar>();
    P_ = (G * P_ * G.transpose()).eval();
    x_.segment(place(landmark), 3) = position.cast<Scalar>();
    relative_[static_cast<std::size_t>(landmark)] = false;
  }

  /// Marginalises a landmark out; the last one takes its index.
  void remove(int index) {
    const int to = place(index);
    const int from = size() - dimension_;
    Eigen::PermutationMatrix<Eigen::Dynamic> swap(size());
    swap.setIdentity();
    for (int a = 0; a < dimension_ && to != from; ++a)
      std::swap(swap.indices()[to + a], swap.indices()[from + a]);
    P_ = (swap * P_ * swap.transpose()).eval().topLeftCorner(from, from).eval();
    x_ = (swap * x_).eval().head(from).eval();
    relative_[static_cast<std::size_t>(index)] = relative_.back();
    relative_.pop_back();
  }

  [[nodiscard]] int size() const { return static_cast<int>(x_.size()); }
  /// Of robot and landmarks.
  [[nodiscard]] Eigen::VectorXd mean() const { return x_(places()).cast<double>(); }
  [[nodiscard]] Eigen::MatrixXd covariance() const { return P_(places(), places()).cast<double>(); }
  [[nodiscard]] Eigen::Vector2d biases(int pair) const { return x_.segment(3 + 2 * pair, 2).cast<double>(); }

 private:
  struct Stack {
    Matrix H, R;
    Vector nu;
  };
  [[nodiscard]] Stack stack(std::span<const ekf::LinearizedObservation> linearizations) const {
    int rows = 0;
    for (const auto& s : linearizations) rows += s.rows;
    Stack all{Matrix::Zero(rows, size()), Matrix::Zero(rows, rows), Vector(rows)};
    int row = 0;
    for (const auto& s : linearizations) {
      auto H = all.H.middleRows(row, s.rows);
      H.leftCols(3) = s.H_pose.topRows(s.rows).cast<Scalar>();
      H.middleCols(place(s.landmark), dimension_) =
          s.H_landmark.topLeftCorner(s.rows, dimension_).cast<Scalar>();
      if (s.anchor >= 0)
        H.middleCols(place(s.anchor), dimension_) =
            s.H_anchor.topLeftCorner(s.rows, dimension_).cast<Scalar>();
      H += error_columns(s.errors, s.rows);
      all.R.block(row, row, s.rows, s.rows) = s.R.topLeftCorner(s.rows, s.rows).cast<Scalar>();
      all.nu.segment(row, s.rows) = s.nu.head(s.rows).cast<Scalar>();
      row += s.rows;
    }
    return all;
  }

  [[nodiscard]] int place(int landmark) const { return head_ + dimension_ * landmark; }
  [[nodiscard]] std::vector<int> places() const {
    std::vector<int> places{0, 1, 2};
    for (int i = head_; i < size(); ++i) places.push_back(i);
    return places;
  }

  [[nodiscard]] Matrix error_columns(const ekf::BiasTerms& errors, int rows) const {
    Matrix J = Matrix::Zero(rows, size());
    for (const auto& error : errors)
      if (error.pair >= 0) J.middleCols(3 + 2 * error.pair, 2) += error.J.topRows(rows).cast<Scalar>();
    return J;
  }

  static Scalar wrap(Scalar a) {
    return std::remainder(a, 2 * Scalar(3.14159265358979323846264338327950288L));
  }

  void move(const Vector& dx) {
    x_ += dx;
    x_[2] = wrap(x_[2]);
    if (consistency_ == ekf::Consistency::kStandard) linearized_ = x_.head(3);
  }

  /// The right-invariant filter in its native words: every point q moves as the group does,
  /// q+ = R(a) q + V(a) (dq - a J q), and the covariance is sheared along d = J (q+ - q). The heading of a
  /// pose is added to, and so is all that is relative to one.
  void move_invariantly(const Vector& dx) {
    const Scalar a = dx[2];
    Eigen::Matrix<Scalar, 2, 2> R{{std::cos(a), -std::sin(a)}, {std::sin(a), std::cos(a)}};
    Eigen::Matrix<Scalar, 2, 2> J{{0, -1}, {1, 0}};
    Eigen::Matrix<Scalar, 2, 2> V = Eigen::Matrix<Scalar, 2, 2>::Identity();
    if (a != 0) V << std::sin(a) / a, -(1 - std::cos(a)) / a, (1 - std::cos(a)) / a, std::sin(a) / a;
    Vector d = Vector::Zero(size());
    for (int at = 0; at < size(); at = at == 0 ? head_ : at + dimension_) {
      if (at > 0 && relative_[static_cast<std::size_t>((at - head_) / dimension_)]) {
        x_.segment(at, dimension_) += dx.segment(at, dimension_);
        continue;
      }
      const Eigen::Matrix<Scalar, 2, 1> q = x_.segment(at, 2);
      const Eigen::Matrix<Scalar, 2, 1> moved =
          R * q + V * (Eigen::Matrix<Scalar, 2, 1>(dx.segment(at, 2)) - a * J * q);
      d.segment(at, 2) = J * (moved - q);
      x_.segment(at, 2) = moved;
      if (at > 0 && dimension_ == 3) x_[at + 2] += dx[at + 2];
    }
    x_[2] = wrap(x_[2] + a);
    x_.segment(3, head_ - 3) += dx.segment(3, head_ - 3);
    const Vector c = P_.col(2);
    P_ += d * c.transpose() + c * d.transpose() + c[2] * d * d.transpose();
    linearized_ = x_.head(3);
  }

  int dimension_;
  int head_;
  ekf::Consistency consistency_;
  Vector x_;
  Matrix P_;
  Vector linearized_;
  std::vector<bool> relative_;  // by landmark
};

}  // namespace waymark::test
