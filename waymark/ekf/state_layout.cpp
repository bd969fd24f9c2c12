#include "waymark/ekf/state_layout.hpp"

namespace waymark::ekf {

SparseJacobian StateLayout::jacobian(const LinearizedObservation& linearization, int rows) const {
  const int points = 1 + (linearization.anchor >= 0 ? 1 : 0) + (linearization.second_anchor >= 0 ? 1 : 0);
  SparseJacobian t(linearization.H_pose.topRows(rows), linearization.errors, points * dimension);
  int column = t.head;
  const auto touch = [&](int index, const Eigen::Matrix<double, 2, 3>& H) {
    if (index < 0) return;
    t.set_landmark(column, offset(index), dimension, H);
    column += dimension;
  };
  touch(linearization.landmark, linearization.H_landmark);
  touch(linearization.anchor, linearization.H_anchor);
  touch(linearization.second_anchor, linearization.H_second_anchor);
  return t;
}

Eigen::Vector2d bias_pair(const double* values, int pair) {
  const double* e = values + bias_offset(pair);
  return {e[0], e[1]};
}

Eigen::Vector2d bias_part(const double* values, const BiasTerms& terms) {
  Eigen::Vector2d part = Eigen::Vector2d::Zero();
  for (const BiasTerm& term : terms)
    if (term.takes_part()) part += term.J.topRows<2>() * bias_pair(values, term.pair);
  return part;
}

}  // namespace waymark::ekf
