#include "waymark/fastslam/innovation_gate.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "waymark/core/angle.hpp"

#include "known_map.hpp"

namespace waymark::fastslam {
namespace {

/// Particles at the origin that know a landmark 4 m ahead, and one observation of it.
class InnovationGateTest : public testing::Test {
 protected:
  InnovationGateTest() { test::add_point(belief_, {4.0, 0.0}); }

  Innovation judged(const Observation& observation) {
    observations_.assign(1, observation);
    scan_.begin(observations_);
    scan_.match(0, 0, belief_.landmarks);
    belief_.load_sample();
    gate_.judge(0, scan_, belief_);
    return scan_.innovations[0];
  }

  Belief belief_{{.particles = 50}, {}, 1};
  Scan scan_;
  std::vector<Observation> observations_;
  InnovationGate gate_{{.probability = 0.99}, SensorModel({}, 1.0)};
};

TEST_F(InnovationGateTest, TheNisIsThatOfTheInnovationByItsWholeCovariance) {
  const Innovation told = judged(test::range_bearing(4.2, 0.0));
  const double S_rr = 0.01 + 1e-4;
  const double S_bb = 0.0004 + 1e-4 / 16.0;
  EXPECT_EQ(told.outcome, Outcome::kMatched);
  EXPECT_EQ(told.dof, 2);
  EXPECT_NEAR(told.nis, 0.2 * 0.2 / S_rr, 1e-2);
  EXPECT_NEAR(told.log_density, -0.5 * (told.nis + std::log(4.0 * kPi * kPi * S_rr * S_bb)), 1e-3);
  EXPECT_NEAR(told.standardised[0], 0.2 / std::sqrt(S_rr), 1e-2);
  EXPECT_NEAR(told.standardised[1], 0.0, 1e-2);
}

TEST_F(InnovationGateTest, WhatTheSetDoesNotExpectIsGated) {
  const Innovation told = judged(test::range_bearing(4.5, 0.0));
  EXPECT_EQ(told.outcome, Outcome::kGated);
  EXPECT_GT(told.nis, told.gate);
  EXPECT_NEAR(told.gate, 9.21, 0.01);
}

TEST_F(InnovationGateTest, ARangeAloneHasOneDegreeOfFreedom) {
  const Innovation told = judged(test::range_alone(4.2));
  EXPECT_EQ(told.dof, 1);
  EXPECT_NEAR(told.gate, 6.63, 0.01);
  EXPECT_NEAR(told.standardised[0] * told.standardised[0], told.nis, 1e-9);
  EXPECT_EQ(told.standardised[1], 0.0);
}

TEST_F(InnovationGateTest, APendingMotionThatIsUnsureLetsMorePass) {
  belief_.predict({{0.0, 0.0, 0.0}, Eigen::Vector3d(0.04, 0.04, 0.01).asDiagonal()});
  EXPECT_EQ(judged(test::range_bearing(4.5, 0.0)).outcome, Outcome::kMatched);
}

TEST_F(InnovationGateTest, AWiderExpectationLeavesTheDensityOfTheFirst) {
  const double density = judged(test::range_bearing(4.5, 0.0)).log_density;
  belief_.predict({{0.0, 0.0, 0.0}, Eigen::Vector3d(0.04, 0.04, 0.01).asDiagonal()});
  gate_.judge(0, scan_, belief_);
  EXPECT_EQ(scan_.innovations[0].log_density, density);
  EXPECT_EQ(scan_.innovations[0].outcome, Outcome::kMatched);
}

}  // namespace
}  // namespace waymark::fastslam
