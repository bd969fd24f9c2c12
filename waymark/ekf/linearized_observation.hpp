#pragma once

#include <Eigen/Core>

#include "waymark/ekf/sparse_jacobian.hpp"

namespace waymark::ekf {

/// One linearised observation of landmark `landmark`: nu = z - h, H_pose and H_landmark its Jacobians, R its
/// noise. Only the first `rows` rows and, of H_landmark, the first `dimension()` columns count. `errors` says
/// which biases of the sensor are in z. Where the landmark is relative to another one, `anchor` names
/// that and H_anchor is the Jacobian to it; `second_anchor` likewise, where there is one more.
struct LinearizedObservation {
  int landmark = 0;
  int anchor = -1;
  int second_anchor = -1;
  int rows = 2;
  Eigen::Vector2d nu = Eigen::Vector2d::Zero();
  Eigen::Matrix<double, 2, 3> H_pose = Eigen::Matrix<double, 2, 3>::Zero();
  Eigen::Matrix<double, 2, 3> H_landmark = Eigen::Matrix<double, 2, 3>::Zero();
  Eigen::Matrix<double, 2, 3> H_anchor = Eigen::Matrix<double, 2, 3>::Zero();
  Eigen::Matrix<double, 2, 3> H_second_anchor = Eigen::Matrix<double, 2, 3>::Zero();
  Eigen::Matrix2d R = Eigen::Matrix2d::Identity();
  BiasTerms errors = {};
};

}  // namespace waymark::ekf
