#include "waymark/ekf/state_layout.hpp"

#include <array>

#include <gtest/gtest.h>

#include "waymark/core/random.hpp"

#include "random_observations.hpp"

namespace waymark::ekf {
namespace {

TEST(StateLayout, HasRobotThenErrorsThenLandmarks) {
  const StateLayout layout{2, bias_offset(2), 3};
  EXPECT_EQ(layout.offset(0), 7);
  EXPECT_EQ(layout.offset(2), 11);
  EXPECT_EQ(layout.size(), 13);
  EXPECT_EQ(layout.row(2), 2);  // theta
  EXPECT_EQ(layout.row(3), 7);  // the first landmark: errors are left out
  std::array<double, 13> values;
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<double>(i);
  EXPECT_EQ(StateLayout::pose(values.data()), (Pose2{0.0, 1.0, 2.0}));
  EXPECT_EQ(layout.landmark(values.data(), 1), Eigen::Vector3d(9.0, 10.0, 0.0));
  EXPECT_EQ(bias_pair(values.data(), 1), Eigen::Vector2d(5.0, 6.0));
}

TEST(StateLayout, AnObservationTouchesTheRobotItsErrorsAndItsPoints) {
  RandomStream random(1, StreamPurpose::kWorld);
  const StateLayout layout{3, bias_offset(2), 4};
  LinearizedObservation s = test::random_observation(random, 1, 3);
  s.anchor = 3;
  s.errors = {};
  s.errors[2].pair = 1;
  s.errors[2].J.setConstant(0.5);
  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(2, static_cast<Eigen::Index>(layout.size()));
  expected.leftCols<3>() = s.H_pose;
  expected.middleCols<2>(5) = s.errors[2].J.topRows<2>();
  expected.middleCols<3>(10) = s.H_landmark;
  expected.middleCols<3>(16) = s.H_anchor;
  EXPECT_EQ(test::dense(layout.jacobian(s, 2), layout.size()), expected);
}

TEST(StateLayout, ErrorsAddUp) {
  BiasTerms terms;
  terms[0] = {1, Eigen::Matrix<double, 3, 2>::Constant(2.0)};
  terms[2] = {0, Eigen::Matrix<double, 3, 2>::Constant(10.0)};
  const std::array values{0.0, 0.0, 0.0, 1.0, 2.0, 3.0, 4.0};
  EXPECT_EQ(bias_part(values.data(), terms), Eigen::Vector2d(44.0, 44.0));
}

}  // namespace
}  // namespace waymark::ekf
