#include "waymark/ekf/state.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <utility>

#include "waymark/ekf/turn_jacobian.hpp"
#include "waymark/kernels/add_scaled_rows.hpp"
#include "waymark/kernels/move_block.hpp"
#include "waymark/kernels/symmetric_rows.hpp"
#include "waymark/kernels/symmetric_update.hpp"
#include "waymark/kernels/triangular_solve.hpp"

namespace waymark::ekf {
namespace {

/// Below this size of the state a second thread costs more than it brings.
constexpr std::size_t kParallelSize = 800;

}  // namespace

State::State(int dimension, int capacity, Consistency consistency, int threads, int error_pairs)
    : dimension_(dimension),
      capacity_(capacity),
      consistency_(consistency),
      head_(error_offset(error_pairs)),
      ld_(kernels::padded_stride(offset(capacity))),
      x_(ld_),
      first_(ld_),
      relative_(static_cast<std::size_t>(capacity), 0),
      P_(ld_ * ld_),
      W_(ld_ * kMaxSightings * 2),
      dx_(ld_),
      shear_d_(ld_),
      shear_e_(ld_),
      S_(2 * kMaxSightings, 2 * kMaxSightings),
      nu_(2 * kMaxSightings),
      team_(threads) {}

PoseEstimate State::pose() const {
  Eigen::Matrix3d covariance;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) covariance(static_cast<int>(i), static_cast<int>(j)) = P(i, j);
  return {{x_[0], x_[1], x_[2]}, covariance};
}

Eigen::Vector3d State::point(const Buffer& buffer, int index) const {
  const double* p = &buffer[offset(index)];
  return {p[0], p[1], dimension_ == 3 ? p[2] : 0.0};
}

Eigen::Vector3d State::landmark(int index) const { return point(x_, index); }

Eigen::Matrix3d State::landmark_covariance(int index) const {
  Eigen::Matrix3d P_landmark = Eigen::Matrix3d::Zero();
  const std::size_t first = offset(index);
  for (int a = 0; a < dimension_; ++a)
    for (int b = 0; b < dimension_; ++b)
      P_landmark(a, b) = P(first + static_cast<std::size_t>(a), first + static_cast<std::size_t>(b));
  return P_landmark;
}

Eigen::Vector2d State::errors(int pair) const {
  const std::size_t first = error_offset(pair);
  return {x_[first], x_[first + 1]};
}

Eigen::Matrix2d State::errors_covariance(int pair, int other) const {
  const std::size_t a = error_offset(pair);
  const std::size_t b = error_offset(other);
  return Eigen::Matrix2d{{P(a, b), P(a, b + 1)}, {P(a + 1, b), P(a + 1, b + 1)}};
}

Eigen::Vector2d State::error_part(const ErrorTerms& terms, const Buffer& values) {
  Eigen::Vector2d part = Eigen::Vector2d::Zero();
  for (const ErrorTerm& term : terms) {
    if (!term.takes_part()) continue;
    const double* e = &values[error_offset(term.pair)];
    part += term.J.topRows<2>() * Eigen::Vector2d(e[0], e[1]);
  }
  return part;
}

Eigen::Vector2d State::expected(const ErrorTerms& terms) const { return error_part(terms, x_); }

void State::relax_errors(int pair, double rho) {
  const std::size_t first = error_offset(pair);
  for (std::size_t row = first; row < first + 2; ++row) {
    for (std::size_t i = 0; i < row; ++i) P_[i * ld_ + row] *= rho;
    for (std::size_t j = row; j < size(); ++j) P_[row * ld_ + j] *= rho;
    P_[row * ld_ + row] = rho * P_[row * ld_ + row] + 1.0 - rho * rho;
    x_[row] *= rho;
  }
}

Pose2 State::linearization_pose() const {
  return consistency_ == Consistency::kFej ? linearization_pose_ : Pose2{x_[0], x_[1], x_[2]};
}

Eigen::Vector3d State::linearization_landmark(int index) const {
  return consistency_ == Consistency::kFej ? first_estimate(index) : landmark(index);
}

void State::set_pose(const PoseEstimate& pose) {
  assert(landmarks_ == 0);
  write_pose(pose);
}

void State::write_pose(const PoseEstimate& pose) {
  x_[0] = pose.T_world_robot.x_m;
  x_[1] = pose.T_world_robot.y_m;
  x_[2] = pose.T_world_robot.theta_rad;
  linearization_pose_ = pose.T_world_robot;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = i; j < 3; ++j)
      P_[i * ld_ + j] = pose.covariance(static_cast<int>(i), static_cast<int>(j));
}

void State::load(const Eigen::Ref<const Eigen::VectorXd>& mean, const Eigen::Ref<const Eigen::MatrixXd>& P) {
  assert(landmarks_ == 0 && mean.size() >= 3 && P.rows() == mean.size() && P.cols() == mean.size());
  landmarks_ = static_cast<int>(mean.size() - 3) / dimension_;
  assert(landmarks_ <= capacity_);
  for (std::size_t i = 3; i < head_; ++i) std::fill(&P_[i * ld_ + head_], &P_[i * ld_ + size()], 0.0);
  for (int i = 0; i < mean.size(); ++i) {
    x_[place(i)] = mean[i];
    if (i >= 3) first_[place(i)] = mean[i];
    for (int j = i; j < mean.size(); ++j) P_[place(i) * ld_ + place(j)] = P(i, j);
  }
  std::fill_n(relative_.begin(), landmarks_, char{0});
  linearization_pose_ = {mean[0], mean[1], mean[2]};
}

void State::hold_landmarks() {
  assert(consistency_ != Consistency::kInvariant && !textbook_);
  held_ = true;
}

void State::place_robot(const PoseEstimate& pose) {
  join_robot_rows();
  for (std::size_t i = 0; i < 3; ++i) std::fill(&P_[i * ld_ + 3], &P_[i * ld_ + size()], 0.0);
  write_pose(pose);
}

void State::predict(const Motion& motion, const ErrorTerms& errors) {
  const PoseEstimate before = pose();
  const Pose2 after = before.T_world_robot * motion.increment;  // Vincke (3)
  // F's heading column is J times the displacement between the points of linearisation.
  const Eigen::Vector2d phi = perpendicular(after.position() - linearization_pose().position());
  Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
  F.block<2, 1>(0, 2) = phi;
  const Eigen::Matrix3d G = compose_jacobian_right(linearization_pose());
  // Vincke (6)
  const Eigen::Matrix3d P_rr = F * before.covariance * F.transpose() + G * motion.covariance * G.transpose();
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = i; j < 3; ++j) P_[i * ld_ + j] = P_rr(static_cast<int>(i), static_cast<int>(j));
  pending_phi_ += phi;
  pending_ = true;
  linearization_pose_ = after;
  x_[0] = after.x_m;
  x_[1] = after.y_m;
  x_[2] = after.theta_rad;
  if (std::ranges::any_of(errors, &ErrorTerm::takes_part)) spread_errors(G, errors);
}

/// With A = G d(increment)/de and P_re as F leaves it: P_rm += A P_em, P_rr += A P_er + P_re A^T + A P_ee
/// A^T.
void State::spread_errors(const Eigen::Matrix3d& G, const ErrorTerms& errors) {
  join_robot_rows();
  const Touched t(Eigen::Matrix3d::Zero(), errors);
  Eigen::Matrix3d cross = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d own = cross;
  for (Eigen::Index i = 3; i < t.J.cols(); ++i) {
    const Eigen::Vector3d a = G * t.J.col(i);
    const std::size_t row = t.rows[static_cast<std::size_t>(i)];
    cross += a * Eigen::RowVector3d(P(0, row), P(1, row), P(2, row));
    for (Eigen::Index j = 3; j < t.J.cols(); ++j)
      own += P(row, t.rows[static_cast<std::size_t>(j)]) * a * (G * t.J.col(j)).transpose();
  }
  const Eigen::Matrix3d more = cross + cross.transpose() + own;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = i; j < 3; ++j) P_[i * ld_ + j] += more(static_cast<int>(i), static_cast<int>(j));
  for (std::size_t j = 3; j < size(); ++j) {
    Eigen::Vector3d column = Eigen::Vector3d::Zero();
    for (Eigen::Index i = 3; i < t.J.cols(); ++i)
      column += P(t.rows[static_cast<std::size_t>(i)], j) * t.J.col(i);
    column = (G * column).eval();
    for (std::size_t i = 0; i < 3; ++i) P_[i * ld_ + j] += column[static_cast<int>(i)];
  }
}

double State::covariance(std::size_t i, std::size_t j) const {
  const std::size_t row = std::min(i, j);
  const std::size_t column = std::max(i, j);
  return P(row, column) + (row < 2 && column >= 3 ? pending_phi_[static_cast<int>(row)] * P(2, column) : 0.0);
}

Eigen::Vector2d State::join_robot_rows() {
  if (!pending_) return Eigen::Vector2d::Zero();
  double* row_x = P_.data();
  double* row_y = &P_[ld_];
  const double* row_theta = &P_[2 * ld_];
  for (std::size_t j = 3; j < size(); ++j) {  // Vincke (6)
    row_x[j] += pending_phi_.x() * row_theta[j];
    row_y[j] += pending_phi_.y() * row_theta[j];
  }
  pending_ = false;
  return std::exchange(pending_phi_, Eigen::Vector2d::Zero());
}

Touched State::touched(const Sighting& sighting, int rows) const {
  const int points = 1 + (sighting.anchor >= 0 ? 1 : 0) + (sighting.second_anchor >= 0 ? 1 : 0);
  Touched t(sighting.H_pose.topRows(rows), sighting.errors, points * dimension_);
  int column = t.head;
  const auto touch = [&](int landmark, const Eigen::Matrix<double, 2, 3>& H) {
    if (landmark < 0) return;
    t.set_landmark(column, offset(landmark), dimension_, H);
    column += dimension_;
  };
  touch(sighting.landmark, sighting.H_landmark);
  touch(sighting.anchor, sighting.H_anchor);
  touch(sighting.second_anchor, sighting.H_second_anchor);
  return t;
}

Eigen::Matrix2d State::innovation_covariance(const Sighting& sighting) const {
  return common_covariance(sighting, sighting) + sighting.R;  // Vincke (11)
}

Eigen::Matrix2d State::common_covariance(const Sighting& a, const Sighting& b) const {
  const Touched t = touched(a, 2);
  const Touched u = touched(b, 2);
  Eigen::Matrix2d common = Eigen::Matrix2d::Zero();
  for (Eigen::Index i = 0; i < t.J.cols(); ++i) {
    const Eigen::Vector2d J_a = t.J.col(i).head<2>();
    for (Eigen::Index j = 0; j < u.J.cols(); ++j) {
      const Eigen::Vector2d part =
          covariance(t.rows[static_cast<std::size_t>(i)], u.rows[static_cast<std::size_t>(j)]) * J_a;
      common.col(0) += part * u.J(0, j);
      common.col(1) += part * u.J(1, j);
    }
  }
  return common;
}

Eigen::Matrix<double, 3, 2> State::pose_correlation(const Sighting& sighting) const {
  const Touched t = touched(sighting, 2);
  Eigen::Matrix<double, 3, 2> C = Eigen::Matrix<double, 3, 2>::Zero();
  for (int i = 0; i < 3; ++i)
    for (Eigen::Index j = 0; j < t.J.cols(); ++j)
      C.row(i) += covariance(static_cast<std::size_t>(i), t.rows[static_cast<std::size_t>(j)]) *
                  t.J.col(j).transpose();
  return C;
}

bool State::update(std::span<const Sighting> sightings) {
  if (!propose(sightings)) return false;
  if (!sightings.empty()) accept();
  return true;
}

bool State::propose(std::span<const Sighting> sightings) {
  assert(sightings.size() <= kMaxSightings);
  if (sightings.empty()) return true;
  join_robot_rows();
  if (textbook_) return propose_by_textbook(sightings);
  const std::size_t rows = rows_ = project(sightings);
  form_innovation_covariance(sightings, static_cast<int>(rows));
  if (!factorize(static_cast<int>(rows))) return false;
  kernels::triangular_solve(S_.data(), static_cast<std::size_t>(S_.cols()), rows, W_.data(), ld_, size());
  std::fill_n(dx_.data(), size(), 0.0);
  kernels::add_scaled_rows(dx_.data(), W_.data(), ld_, rows, nu_.data(), updated_rows());  // Vincke (12)
  std::fill(&dx_[updated_rows()], &dx_[size()], 0.0);  // the kernel goes on to the end of its vector
  return true;
}

void State::use_textbook_update() {
  assert(consistency_ == Consistency::kStandard);
  textbook_ = std::make_unique<TextbookUpdate>(2 * kMaxSightings, offset(capacity_));
}

bool State::propose_by_textbook(std::span<const Sighting> sightings) {
  std::size_t D = 0;
  for (const Sighting& sighting : sightings) D += static_cast<std::size_t>(sighting.rows);
  textbook_->begin(D, size());
  std::size_t row = 0;
  for (const Sighting& sighting : sightings) {
    const Touched t = touched(sighting, sighting.rows);
    for (int r = 0; r < sighting.rows; ++r, ++row) {
      for (int k = 0; k < t.J.cols(); ++k) textbook_->H(row, t.rows[static_cast<std::size_t>(k)]) = t.J(r, k);
      for (int s = 0; s < sighting.rows; ++s)
        textbook_->R(row, row + static_cast<std::size_t>(s) - static_cast<std::size_t>(r)) = sighting.R(r, s);
      textbook_->nu(row, 0) = sighting.nu[r];
    }
  }
  for (std::size_t i = 0; i < size(); ++i)
    for (std::size_t j = 0; j < size(); ++j) textbook_->P(i, j) = P(i, j);
  if (!textbook_->solve()) return false;
  for (std::size_t i = 0; i < size(); ++i) dx_[i] = textbook_->dx(i, 0);
  return true;
}

void State::correct_covariance_by_textbook() {
  textbook_->correct();
  for (std::size_t i = 0; i < size(); ++i)
    for (std::size_t j = i; j < size(); ++j) P_[i * ld_ + j] = textbook_->P(i, j);
}

void State::accept() {
  if (consistency_ == Consistency::kInvariant)
    apply_invariantly();
  else
    apply_additively();
}

/// By what the increments of ground points are turned: V(a) or nothing.
Eigen::Matrix2d State::increment_jacobian() const {
  return consistency_ == Consistency::kInvariant ? turn_jacobian(dx_[2]) : Eigen::Matrix2d::Identity();
}

Pose2 State::proposed_pose() const {
  const Eigen::Vector2d moved = increment_jacobian() * Eigen::Vector2d(dx_[0], dx_[1]);
  return {x_[0] + moved.x(), x_[1] + moved.y(), wrap_angle(x_[2] + dx_[2])};
}

Eigen::Vector3d State::proposed_landmark(int index) const {
  Eigen::Vector3d dx = point(dx_, index);
  if (relative_[static_cast<std::size_t>(index)] == 0)
    dx.head<2>() = (increment_jacobian() * dx.head<2>()).eval();
  return landmark(index) + dx;
}

Eigen::Vector2d State::proposed_expected(const ErrorTerms& terms) const {
  return expected(terms) + error_part(terms, dx_);
}

Eigen::Vector2d State::explained(const Sighting& sighting) const {
  Eigen::Vector2d sum = sighting.H_pose * Eigen::Vector3d(dx_[0], dx_[1], dx_[2]) +
                        sighting.H_landmark * point(dx_, sighting.landmark);
  if (sighting.anchor >= 0) sum += sighting.H_anchor * point(dx_, sighting.anchor);
  if (sighting.second_anchor >= 0) sum += sighting.H_second_anchor * point(dx_, sighting.second_anchor);
  return sum + error_part(sighting.errors, dx_);
}

/// In the invariant filter the heading's column is taken about where the points stood, so that H leaves
/// turning everything unseen as it did before: what the step of Gauss and Newton would be with the exact
/// derivative of the increments would, over and over, learn a heading that nobody saw.
Sighting State::moved_back(const Sighting& sighting) const {
  Sighting back = sighting;
  if (consistency_ == Consistency::kInvariant) {
    const Eigen::Matrix2d V = turn_jacobian(dx_[2]);
    const auto turned = [&](const Eigen::Matrix<double, 2, 3>& H, const Eigen::Vector2d& dx) {
      return (H.leftCols<2>() * perpendicular(V * dx)).eval();
    };
    back.H_pose.col(2) += turned(sighting.H_pose, {dx_[0], dx_[1]});
    if (relative_[static_cast<std::size_t>(sighting.landmark)] == 0)
      back.H_pose.col(2) += turned(sighting.H_landmark, point(dx_, sighting.landmark).head<2>());
    if (sighting.anchor >= 0)
      back.H_pose.col(2) += turned(sighting.H_anchor, point(dx_, sighting.anchor).head<2>());
    if (sighting.second_anchor >= 0)
      back.H_pose.col(2) += turned(sighting.H_second_anchor, point(dx_, sighting.second_anchor).head<2>());
  }
  back.nu += explained(back);
  return back;
}

/// W <- C = H P from the touched rows of P; returns the number of measurement rows.
std::size_t State::project(std::span<const Sighting> sightings) {
  std::size_t row = 0;
  for (const Sighting& sighting : sightings) {
    const Touched t = touched(sighting, sighting.rows);
    const auto rows = static_cast<std::size_t>(sighting.rows);
    kernels::project_rows(P_.data(), ld_, size(), t.rows.data(), t.size(), t.J.data(), rows, &W_[row * ld_],
                          ld_);
    nu_.segment(static_cast<int>(row), sighting.rows) = sighting.nu.head(sighting.rows);
    row += rows;
  }
  return row;
}

State::JointCovariance State::joint_innovation_covariance(std::span<const Sighting> sightings) {
  assert(sightings.size() <= kMaxSightings);
  join_robot_rows();
  const auto rows = static_cast<int>(project(sightings));
  form_innovation_covariance(sightings, rows);
  return S_.topLeftCorner(rows, rows);
}

/// The lower triangle of S = C H^T + R.
void State::form_innovation_covariance(std::span<const Sighting> sightings, int rows) {
  int column = 0;
  for (const Sighting& sighting : sightings) {
    const Touched t = touched(sighting, sighting.rows);
    for (int i = column; i < rows; ++i) {
      const double* c = &W_[static_cast<std::size_t>(i) * ld_];
      for (int r = 0; r < sighting.rows; ++r) {
        double s = i < column + sighting.rows ? sighting.R(i - column, r) : 0.0;
        // Vincke (11)
        for (int k = 0; k < t.J.cols(); ++k) s += c[t.rows[static_cast<std::size_t>(k)]] * t.J(r, k);
        S_(i, column + r) = s;
      }
    }
    column += sighting.rows;
  }
}

/// S = L L^T in place, nu <- L^-1 nu. False if S is not positive definite.
bool State::factorize(int rows) {
  for (int j = 0; j < rows; ++j) {
    const double pivot = S_(j, j) - S_.row(j).head(j).squaredNorm();
    if (!(pivot > 0.0) || !std::isfinite(pivot)) return false;
    S_(j, j) = std::sqrt(pivot);
    for (int i = j + 1; i < rows; ++i)
      S_(i, j) = (S_(i, j) - S_.row(i).head(j).dot(S_.row(j).head(j))) / S_(j, j);
    nu_[j] = (nu_[j] - S_.row(j).head(j).dot(nu_.head(j))) / S_(j, j);
  }
  return true;
}

void State::apply_additively() {
  for (std::size_t j = 0; j < size(); ++j) x_[j] += dx_[j];  // Vincke (12)
  x_[2] = wrap_angle(x_[2]);
  if (consistency_ == Consistency::kStandard) linearization_pose_ = {x_[0], x_[1], x_[2]};
  textbook_ ? correct_covariance_by_textbook() : correct_covariance(false);
}

/// The ordinary increment dq of every ground point becomes V(a) dq, with a the change of heading, and the
/// covariance is sheared along d = J V(a) dq: the right-invariant filter in ordinary coordinates.
void State::apply_invariantly() {
  const double turn = dx_[2];
  const Eigen::Matrix2d V = turn_jacobian(turn);
  std::fill_n(shear_d_.data(), size(), 0.0);
  const auto move = [&](std::size_t at) {
    const Eigen::Vector2d moved = V * Eigen::Vector2d(dx_[at], dx_[at + 1]);  // Vincke (12)
    x_[at] += moved.x();
    x_[at + 1] += moved.y();
    shear_d_[at] = -moved.y();
    shear_d_[at + 1] = moved.x();
  };
  move(0);
  x_[2] = wrap_angle(x_[2] + turn);
  for (std::size_t j = 3; j < head_; ++j) x_[j] += dx_[j];
  for (int i = 0; i < landmarks_; ++i) {
    const std::size_t at = offset(i);
    if (relative_[static_cast<std::size_t>(i)] != 0) {
      for (std::size_t k = at; k < at + 2; ++k) x_[k] += dx_[k];
    } else {
      move(at);
    }
    if (dimension_ == 3) x_[at + 2] += dx_[at + 2];
  }
  linearization_pose_ = {x_[0], x_[1], x_[2]};
  correct_covariance(true);
}

/// e = c + c_th/2 d, with c the heading column as the downdate will leave it.
void State::prepare_shear() {
  kernels::gather_rows(P_.data(), ld_, size(), 2, 1, shear_e_.data(), ld_);
  std::array<double, 2 * kMaxSightings> w_heading;
  for (std::size_t k = 0; k < rows_; ++k) w_heading[k] = -W_[k * ld_ + 2];
  kernels::add_scaled_rows(shear_e_.data(), W_.data(), ld_, rows_, w_heading.data(), size());
  const double half_c_theta = 0.5 * shear_e_[2];
  for (std::size_t j = 0; j < size(); ++j) shear_e_[j] += half_c_theta * shear_d_[j];
}

void State::correct_covariance(bool shear) {
  if (held_)  // Vincke (12)
    return kernels::symmetric_downdate(P_.data(), ld_, size(), W_.data(), ld_, rows_, {0, updated_rows()});
  if (shear) prepare_shear();
  const int bands = size() < kParallelSize ? 1 : team_.size();
  team_.run(bands, [&](int band) {  // Vincke (12)
    const auto range =
        kernels::triangle_band(size(), static_cast<std::size_t>(band), static_cast<std::size_t>(bands));
    if (shear)
      kernels::symmetric_update(P_.data(), ld_, size(), W_.data(), ld_, rows_, shear_d_.data(),
                                shear_e_.data(), range);
    else
      kernels::symmetric_downdate(P_.data(), ld_, size(), W_.data(), ld_, rows_, range);
  });
}

Gain State::gain() const {
  const bool sheared = consistency_ == Consistency::kInvariant;
  return {rows_,
          ld_,
          W_.data(),
          static_cast<std::size_t>(S_.cols()),
          S_.data(),
          nu_.data(),
          sheared ? shear_d_.data() : nullptr,
          dx_[2]};
}

int State::add(const Eigen::Vector3d& position, const Eigen::Matrix3d& G_pose, const Eigen::Matrix3d& noise,
               const ErrorTerms& errors) {
  join_robot_rows();
  const Touched t(G_pose.topRows(dimension_), errors);
  kernels::project_rows(P_.data(), ld_, size(), t.rows.data(), t.size(), t.J.data(),
                        static_cast<std::size_t>(dimension_), W_.data(), ld_);
  Eigen::Matrix3d covariance = noise;
  for (int a = 0; a < dimension_; ++a)
    for (int b = 0; b < dimension_; ++b)
      for (int k = 0; k < t.J.cols(); ++k)
        covariance(a, b) +=
            W_[static_cast<std::size_t>(a) * ld_ + t.rows[static_cast<std::size_t>(k)]] * t.J(b, k);
  return insert(position, position, W_.data(), ld_, covariance);
}

int State::insert(const Eigen::Vector3d& position, const Eigen::Vector3d& first, const double* cross,
                  std::size_t ld, const Eigen::Matrix3d& covariance) {
  assert(landmarks_ < capacity_);
  join_robot_rows();
  const std::size_t n = size();
  for (int a = 0; a < dimension_; ++a) {
    const std::size_t at = n + static_cast<std::size_t>(a);
    for (std::size_t j = 0; j < n; ++j) P_[j * ld_ + at] = cross[static_cast<std::size_t>(a) * ld + j];
    for (int b = a; b < dimension_; ++b) P_[at * ld_ + n + static_cast<std::size_t>(b)] = covariance(a, b);
    x_[at] = position[a];
    first_[at] = first[a];
  }
  relative_[static_cast<std::size_t>(landmarks_)] = 0;
  return landmarks_++;
}

int State::add_pose() {
  assert(dimension_ == 3);
  return add({x_[0], x_[1], x_[2]}, Eigen::Matrix3d::Identity(), Eigen::Matrix3d::Zero());
}

int State::add_relative(const Eigen::Vector3d& values, const Eigen::Matrix3d& noise,
                        const ErrorTerms& errors) {
  const int index = add(values, Eigen::Matrix3d::Zero(), noise, errors);
  relative_[static_cast<std::size_t>(index)] = 1;
  return index;
}

void State::make_absolute(int landmark, int anchor, const Eigen::Vector3d& position,
                          const Eigen::Matrix3d& G_anchor, const Eigen::Matrix3d& G_landmark) {
  join_robot_rows();
  Touched t(Eigen::Matrix3d::Zero(), {}, 6);
  t.set_landmark(t.head, offset(landmark), 3, G_landmark);
  t.set_landmark(t.head + 3, offset(anchor), 3, G_anchor);
  kernels::project_rows(P_.data(), ld_, size(), t.rows.data(), t.size(), t.J.data(), 3, W_.data(), ld_);
  const std::size_t at = offset(landmark);
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (int a = 0; a < 3; ++a)
    for (int k = 0; k < t.J.cols(); ++k)
      covariance.row(a) += W_[static_cast<std::size_t>(a) * ld_ + t.rows[static_cast<std::size_t>(k)]] *
                           t.J.col(k).transpose();
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t j = 0; j < size(); ++j)
      P_[std::min(at + a, j) * ld_ + std::max(at + a, j)] = W_[a * ld_ + j];
    x_[at + a] = first_[at + a] = position[static_cast<int>(a)];
  }
  for (std::size_t a = 0; a < 3; ++a)
    for (std::size_t b = a; b < 3; ++b)
      P_[(at + a) * ld_ + at + b] = covariance(static_cast<int>(a), static_cast<int>(b));
  relative_[static_cast<std::size_t>(landmark)] = 0;
}

void State::loosen(int index, const Eigen::Matrix3d& covariance) {
  const std::size_t at = offset(index);
  for (std::size_t a = 0; a < static_cast<std::size_t>(dimension_); ++a)
    for (std::size_t b = a; b < static_cast<std::size_t>(dimension_); ++b)
      P_[(at + a) * ld_ + at + b] += covariance(static_cast<int>(a), static_cast<int>(b));
}

void State::remove(int index) {
  assert(index >= 0 && index < landmarks_);
  join_robot_rows();
  const std::size_t to = offset(index);
  const std::size_t from = offset(landmarks_ - 1);
  if (to != from) {
    const auto d = static_cast<std::size_t>(dimension_);
    kernels::move_block(P_.data(), ld_, size(), from, to, d);
    std::copy_n(&x_[from], d, &x_[to]);
    std::copy_n(&first_[from], d, &first_[to]);
    relative_[static_cast<std::size_t>(index)] = relative_[static_cast<std::size_t>(landmarks_ - 1)];
  }
  --landmarks_;
}

/// Row of the i-th value of (x, y, theta, landmarks).
std::size_t State::place(int i) const { return static_cast<std::size_t>(i) + (i < 3 ? 0 : head_ - 3); }

Eigen::VectorXd State::mean() const {
  Eigen::VectorXd x(3 + dimension_ * landmarks_);  // Vincke (1)
  for (int i = 0; i < x.size(); ++i) x[i] = x_[place(i)];
  return x;
}

Eigen::MatrixXd State::covariance() const {
  const int n = 3 + dimension_ * landmarks_;
  Eigen::MatrixXd full(n, n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) full(i, j) = covariance(place(i), place(j));  // Vincke (2)
  return full;
}

}  // namespace waymark::ekf
