#include "waymark/ekf/state_layout.hpp"

namespace waymark::ekf {

Touched StateLayout::touched(const Sighting& sighting, int rows) const {
  const int points = 1 + (sighting.anchor >= 0 ? 1 : 0) + (sighting.second_anchor >= 0 ? 1 : 0);
  Touched t(sighting.H_pose.topRows(rows), sighting.errors, points * dimension);
  int column = t.head;
  const auto touch = [&](int index, const Eigen::Matrix<double, 2, 3>& H) {
    if (index < 0) return;
    t.set_landmark(column, offset(index), dimension, H);
    column += dimension;
  };
  touch(sighting.landmark, sighting.H_landmark);
  touch(sighting.anchor, sighting.H_anchor);
  touch(sighting.second_anchor, sighting.H_second_anchor);
  return t;
}

Eigen::Vector2d error_pair(const double* values, int pair) {
  const double* e = values + error_offset(pair);
  return {e[0], e[1]};
}

Eigen::Vector2d error_part(const double* values, const ErrorTerms& terms) {
  Eigen::Vector2d part = Eigen::Vector2d::Zero();
  for (const ErrorTerm& term : terms)
    if (term.takes_part()) part += term.J.topRows<2>() * error_pair(values, term.pair);
  return part;
}

}  // namespace waymark::ekf
