#include "plain_ekf.hpp"

#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "waymark/core/angle.hpp"
#include "waymark/models/observation_models.hpp"

namespace waymark::app {

/// One observation, linearised.
struct PlainEkf::Row {
  Eigen::Index at;  ///< where its landmark stands in the state
  Eigen::Vector2d nu;
  Eigen::Matrix<double, 2, 3> H_pose;
  Eigen::Matrix2d H_landmark;
};

PlainEkf::PlainEkf(Form form, const Motion& start, std::span<const Observation> all_landmarks) : form_(form) {
  P_ = start.covariance;
  const auto n = 3 + 2 * static_cast<Eigen::Index>(all_landmarks.size());
  x_.conservativeResizeLike(Vector::Zero(n));
  P_.conservativeResizeLike(Matrix::Zero(n, n));
  for (const Observation& observation : all_landmarks) add(observation);
}

void PlainEkf::add(const Observation& observation) {
  const Eigen::Index at = 3 + 2 * observation.id->number;
  const auto found = RangeBearingModel::locate(pose(), Pose2{}, std::get<RangeBearing>(observation.value));
  x_.segment<2>(at) = found.p_world;
  const Matrix P_landmark_before = found.G_pose * P_.topLeftCorner(3, at);
  P_.block(at, 0, 2, at) = P_landmark_before;
  P_.block(0, at, at, 2) = P_landmark_before.transpose();
  P_.block<2, 2>(at, at) = found.G_pose * P_.topLeftCorner<3, 3>() * found.G_pose.transpose() +
                           found.G_measurement * *observation.covariance * found.G_measurement.transpose();
}

void PlainEkf::step(const Motion& motion, std::span<const Observation> observations) {
  predict(motion);
  form_ == Form::kTextbook ? update_textbook(observations) : update_by_rank(observations);
}

/// On the lower triangle and, for the textbook form, on the upper one too.
void PlainEkf::predict(const Motion& motion) {
  const Eigen::Index rest = x_.size() - 3;
  const Eigen::Matrix3d P_robot = P_.topLeftCorner<3, 3>().selfadjointView<Eigen::Lower>();
  const auto moved = propagate({pose(), P_robot}, motion);  // Vincke (3)
  const Eigen::Matrix3d F = compose_jacobian_left(pose(), motion.increment);
  P_.topLeftCorner<3, 3>() = moved.covariance;
  // Vincke (6)
  for (Eigen::Index i = 0; i < 2; ++i) P_.col(i).tail(rest) += F(i, 2) * P_.col(2).tail(rest);
  if (form_ == Form::kTextbook) P_.topRightCorner(2, rest) = P_.bottomLeftCorner(rest, 2).transpose();
  x_.head<3>() << moved.T_world_robot.x_m, moved.T_world_robot.y_m, moved.T_world_robot.theta_rad;
}

PlainEkf::Row PlainEkf::linearize(const Observation& observation) const {
  const Eigen::Index at = 3 + 2 * observation.id->number;
  const auto linear = RangeBearingModel::linearize(pose(), Pose2{}, x_.segment<2>(at));
  // Vincke (10)
  const auto nu = RangeBearingModel::innovation(std::get<RangeBearing>(observation.value), linear.predicted);
  return {at, nu, linear.H_pose, linear.H_landmark};
}

void PlainEkf::update_textbook(std::span<const Observation> observations) {
  const auto D = 2 * static_cast<Eigen::Index>(observations.size());
  Matrix H = Matrix::Zero(D, x_.size());
  Matrix R = Matrix::Zero(D, D);
  Vector nu(D);
  for (Eigen::Index i = 0; i < D; i += 2) {
    const Observation& observation = observations[static_cast<std::size_t>(i / 2)];
    const Row row = linearize(observation);
    H.block<2, 3>(i, 0) = row.H_pose;
    H.block<2, 2>(i, row.at) = row.H_landmark;
    R.block<2, 2>(i, i) = *observation.covariance;
    nu.segment<2>(i) = row.nu;
  }
  const Matrix S = H * P_ * H.transpose() + R;                 // Vincke (11)
  const Matrix K = P_ * H.transpose() * S.inverse();           // Vincke (12)
  move(K * nu);                                                // Vincke (12)
  P_ = (Matrix::Identity(x_.size(), x_.size()) - K * H) * P_;  // Vincke (12)
}

/// Column j of the whole covariance from its lower triangle.
PlainEkf::Vector PlainEkf::column(Eigen::Index j) const {
  Vector whole(x_.size());
  whole.head(j) = P_.row(j).head(j).transpose();
  whole.tail(x_.size() - j) = P_.col(j).tail(x_.size() - j);
  return whole;
}

void PlainEkf::update_by_rank(std::span<const Observation> observations) {
  const auto D = 2 * static_cast<Eigen::Index>(observations.size());
  Matrix PHt(x_.size(), D);
  Matrix S(D, D);
  Vector nu(D);
  std::vector<Row> rows;
  const Vector x = column(0);
  const Vector y = column(1);
  const Vector theta = column(2);
  for (Eigen::Index i = 0; i < D; i += 2) {
    const Row& row = rows.emplace_back(linearize(observations[static_cast<std::size_t>(i / 2)]));
    const Vector a = column(row.at);
    const Vector b = column(row.at + 1);
    for (Eigen::Index r = 0; r < 2; ++r)
      PHt.col(i + r) = x * row.H_pose(r, 0) + y * row.H_pose(r, 1) + theta * row.H_pose(r, 2) +
                       a * row.H_landmark(r, 0) + b * row.H_landmark(r, 1);
    nu.segment<2>(i) = row.nu;
  }
  for (Eigen::Index i = 0; i < D; i += 2) {
    const Row& row = rows[static_cast<std::size_t>(i / 2)];
    S.middleRows<2>(i) = row.H_pose * PHt.topRows<3>() + row.H_landmark * PHt.middleRows<2>(row.at);
    S.block<2, 2>(i, i) += *observations[static_cast<std::size_t>(i / 2)].covariance;  // Vincke (11)
  }
  const Eigen::LLT<Matrix> llt(S);
  move(PHt * llt.solve(nu));  // Vincke (12)
  llt.matrixU().solveInPlace<Eigen::OnTheRight>(PHt);
  P_.selfadjointView<Eigen::Lower>().rankUpdate(PHt, -1.0);  // Vincke (12)
}

void PlainEkf::move(const Vector& dx) {
  x_ += dx;
  x_[2] = wrap_angle(x_[2]);
}

}  // namespace waymark::app
