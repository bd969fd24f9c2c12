#include "waymark/ekf/state.hpp"

#include <algorithm>
#include <cassert>

#include "waymark/ekf/prediction.hpp"

namespace waymark::ekf {

State::State(int dimension, int capacity, Consistency consistency, int threads, int bias_pairs)
    : Belief({dimension, bias_offset(bias_pairs)}, capacity, consistency),
      update_(offset(capacity), threads),
      shear_(offset(capacity)) {}

void State::write_pose(const Pose2& pose) {
  for (double* values : {x_.data(), first_.data()}) {
    values[0] = pose.x_m;
    values[1] = pose.y_m;
    values[2] = pose.theta_rad;
  }
}

void State::load(const Eigen::Ref<const Eigen::VectorXd>& mean, const Eigen::Ref<const Eigen::MatrixXd>& P) {
  assert(landmarks() == 0 && mean.size() >= 3 && P.rows() == mean.size() && P.cols() == mean.size());
  layout_.landmarks = static_cast<int>(mean.size() - 3) / dimension();
  assert(landmarks() <= capacity());
  P_.resize(size());
  for (std::size_t i = 3; i < layout_.head; ++i) std::fill(P_.row(i) + layout_.head, P_.row(i) + size(), 0.0);
  for (int i = 0; i < mean.size(); ++i) {
    x_[layout_.row(i)] = first_[layout_.row(i)] = mean[i];
    for (int j = i; j < mean.size(); ++j) P_.row(layout_.row(i))[layout_.row(j)] = P(i, j);
  }
  std::fill_n(relative_.begin(), landmarks(), char{0});
}

void State::place_robot(const PoseEstimate& pose) {
  propagate_cross_covariance();
  write_pose(pose.T_world_robot);
  for (std::size_t i = 0; i < 3; ++i) {
    std::fill(P_.row(i) + 3, P_.row(i) + size(), 0.0);
    for (std::size_t j = i; j < 3; ++j)
      P_.row(i)[j] = pose.covariance(static_cast<int>(i), static_cast<int>(j));
  }
}

void State::predict(const Motion& motion, const BiasTerms& errors) {
  const Prediction prediction(StateLayout::pose(x_.data()), linearization_pose(), motion.increment);
  write_pose(prediction.pose());
  prediction.apply(P_, motion.covariance);
  if (std::ranges::any_of(errors, &BiasTerm::takes_part)) prediction.spread(P_, errors);
}

void State::propagate_bias(int pair, double rho) {
  const std::size_t first = bias_offset(pair);
  for (std::size_t e = first; e < first + 2; ++e) {
    for (std::size_t i = 0; i < e; ++i) P_.row(i)[e] *= rho;
    for (std::size_t j = e; j < size(); ++j) P_.row(e)[j] *= rho;
    P_.row(e)[e] = rho * P_.row(e)[e] + 1.0 - rho * rho;
    x_[e] *= rho;
  }
}

bool State::update(std::span<const LinearizedObservation> linearizations) {
  if (!propose(linearizations)) return false;
  if (!linearizations.empty()) accept();
  return true;
}

bool State::propose(std::span<const LinearizedObservation> linearizations) {
  if (linearizations.empty()) return true;
  propagate_cross_covariance();
  return update_.propose(P_, layout_, linearizations);
}

void State::accept() {
  double* dx = update_.dx();
  const bool turns = turns_the_ground(consistency());
  if (turns) shear_.turn(dx, layout_, relative_);
  for (std::size_t j = 0; j < size(); ++j) x_[j] += dx[j];  // Vincke (12)
  x_[2] = wrap_angle(x_[2]);
  update_.correct(P_, turns ? &shear_ : nullptr);
}

Gain State::gain() const {
  Gain gain = update_.gain();
  if (turns_the_ground(consistency())) gain.shear = shear_.d();
  return gain;
}

void State::use_textbook_update() {
  assert(consistency() == Consistency::kStandard);
  update_.use_textbook();
}

void State::hold_landmarks() {
  assert(!turns_the_ground(consistency()) && !update_.is_textbook());
  update_.consider_all_from(layout_.head);
}

JointCovariance State::joint_innovation_covariance(std::span<const LinearizedObservation> linearizations) {
  propagate_cross_covariance();
  return update_.joint_innovation_covariance(P_, layout_, linearizations);
}

int State::add(const Eigen::Vector3d& position, const Eigen::Matrix3d& G_pose, const Eigen::Matrix3d& noise,
               const BiasTerms& errors) {
  propagate_cross_covariance();
  return insert(position, position, P_.derive(SparseJacobian(G_pose.topRows(dimension()), errors), noise));
}

int State::insert(const Eigen::Vector3d& position, const Eigen::Vector3d& first, const NewRows& rows) {
  assert(landmarks() < capacity());
  propagate_cross_covariance();
  const int index = layout_.landmarks++;
  std::copy_n(position.data(), dimension(), &x_[offset(index)]);
  std::copy_n(first.data(), dimension(), &first_[offset(index)]);
  relative_[static_cast<std::size_t>(index)] = 0;
  P_.append(rows);
  return index;
}

int State::add_pose() {
  assert(dimension() == 3);
  return add({x_[0], x_[1], x_[2]}, Eigen::Matrix3d::Identity(), Eigen::Matrix3d::Zero());
}

int State::add_relative(const Eigen::Vector3d& values, const Eigen::Matrix3d& noise) {
  const int index = add(values, Eigen::Matrix3d::Zero(), noise);
  relative_[static_cast<std::size_t>(index)] = 1;
  return index;
}

void State::make_absolute(int landmark, int anchor, const Eigen::Vector3d& position,
                          const Eigen::Matrix3d& G_anchor, const Eigen::Matrix3d& G_landmark) {
  propagate_cross_covariance();
  SparseJacobian G(Eigen::Matrix3d::Zero(), {}, 6);
  G.set_landmark(G.head, offset(landmark), 3, G_landmark);
  G.set_landmark(G.head + 3, offset(anchor), 3, G_anchor);
  P_.replace(offset(landmark), P_.derive(G, Eigen::Matrix3d::Zero()));
  std::copy_n(position.data(), 3, &x_[offset(landmark)]);
  std::copy_n(position.data(), 3, &first_[offset(landmark)]);
  relative_[static_cast<std::size_t>(landmark)] = 0;
}

void State::inflate(int index, const Eigen::Matrix3d& covariance) {
  const std::size_t at = offset(index);
  for (std::size_t a = 0; a < static_cast<std::size_t>(dimension()); ++a)
    for (std::size_t b = a; b < static_cast<std::size_t>(dimension()); ++b)
      P_.row(at + a)[at + b] += covariance(static_cast<int>(a), static_cast<int>(b));
}

void State::remove(int index) {
  assert(index >= 0 && index < landmarks());
  propagate_cross_covariance();
  const auto d = static_cast<std::size_t>(dimension());
  const int last = layout_.landmarks - 1;
  P_.remove(offset(index), d);
  if (index != last) {
    std::copy_n(&x_[offset(last)], d, &x_[offset(index)]);
    std::copy_n(&first_[offset(last)], d, &first_[offset(index)]);
    relative_[static_cast<std::size_t>(index)] = relative_[static_cast<std::size_t>(last)];
  }
  --layout_.landmarks;
}

}  // namespace waymark::ekf
