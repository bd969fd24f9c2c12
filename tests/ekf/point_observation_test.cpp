#include "waymark/ekf/point_observation.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "support/matrix_near.hpp"
#include "waymark/core/angle.hpp"
#include "waymark/models/observation_models.hpp"

namespace waymark::ekf {
namespace {

const Pose2 kMount{0.2, -0.1, 0.3};
const LinearizationPoint kView{{1.0, 2.0, 0.4}, {4.0, -1.0}};

/// What is measured without noise from a view, as the plain formula has it.
RangeBearing measure(const LinearizationPoint& view) {
  const Eigen::Vector2d p = (view.T_world_robot * kMount).inverse() * view.p_world;
  return {p.norm(), std::atan2(p.y(), p.x())};
}

Observation observe(const Measurement& z) {
  return {{}, z, Eigen::Matrix2d(1e-4 * Eigen::Matrix2d::Identity())};
}

TEST(Linearize, TheInnovationIsWhatWasMeasuredLessWhatIsExpected) {
  const RangeBearing h = measure(kView);
  const auto both = linearize(RangeBearing{h.range_m + 0.5, h.bearing_rad - 0.1}, kView, kView, kMount);
  ASSERT_TRUE(both);
  EXPECT_EQ(both->rows, 2);
  EXPECT_NEAR(both->nu[0], 0.5, 1e-12);
  EXPECT_NEAR(both->nu[1], -0.1, 1e-12);
  const auto range = linearize(Range{h.range_m + 0.5}, kView, kView, kMount);
  EXPECT_EQ(range->rows, 1);
  EXPECT_NEAR(range->nu[0], 0.5, 1e-12);
  const auto bearing = linearize(Bearing{h.bearing_rad - 0.1}, kView, kView, kMount);
  EXPECT_EQ(bearing->rows, 1);
  EXPECT_NEAR(bearing->nu[0], -0.1, 1e-12);
}

TEST(Linearize, JacobiansAreThoseOfTheOtherView) {
  LinearizationPoint at = kView;
  at.T_world_robot.theta_rad += 0.2;
  at.p_world.x() += 0.3;
  const RangeBearing h = measure(kView);
  const auto mixed = linearize(h, kView, at, kMount);
  const auto there = linearize(h, at, at, kMount);
  EXPECT_NEAR(mixed->nu.norm(), 0.0, 1e-12);
  EXPECT_EQ(mixed->H_pose, there->H_pose);
  EXPECT_EQ(mixed->H_landmark, there->H_landmark);
  constexpr double kStep = 1e-6;
  for (int k = 0; k < 2; ++k) {
    LinearizationPoint plus = at, minus = at;
    plus.p_world[k] += kStep;
    minus.p_world[k] -= kStep;
    EXPECT_NEAR(there->H_landmark(0, k), (measure(plus).range_m - measure(minus).range_m) / (2.0 * kStep),
                1e-8);
    EXPECT_NEAR(there->H_landmark(1, k),
                (measure(plus).bearing_rad - measure(minus).bearing_rad) / (2.0 * kStep), 1e-8);
  }
}

TEST(Linearize, APointAtTheSensorIsNotObserved) {
  const LinearizationPoint inside{kView.T_world_robot, (kView.T_world_robot * kMount).position()};
  EXPECT_FALSE(linearize(Range{1.0}, inside, inside, kMount));
  EXPECT_FALSE(linearize(Range{1.0}, kView, inside, kMount));
}

TEST(IsUsable, RefusesWhatIsNotFiniteOrOfAnotherKind) {
  EXPECT_TRUE(is_usable(observe(RangeBearing{1.0, 0.0})));
  EXPECT_TRUE(is_usable(observe(Range{1.0})));
  EXPECT_TRUE(is_usable(observe(Bearing{0.0})));
  EXPECT_FALSE(is_usable(observe(Range{0.0})));
  EXPECT_FALSE(is_usable(observe(Bearing{std::numeric_limits<double>::quiet_NaN()})));
  EXPECT_FALSE(is_usable(observe(Pixel{1.0, 2.0})));
  Observation observation = observe(Range{1.0});
  observation.covariance.reset();
  EXPECT_FALSE(is_usable(observation));
  observation.covariance = Eigen::Matrix2d::Constant(std::numeric_limits<double>::infinity());
  EXPECT_FALSE(is_usable(observation));
}

class ObservedPoint : public testing::Test {
 protected:
  ObservedPoint() { errors_.start(state_); }

  [[nodiscard]] static SensorErrors errors() {
    return {.shared_range_sigma_m = 0.1, .shared_bearing_sigma_deg = 1.0, .bias_bearing_sigma_deg = 1.0};
  }

  SensorBiasStates errors_{errors()};
  CompressedState state_{2, 8, Consistency::kInvariant, {8, 8}, 1, errors_.pairs()};
  PointObservation observation_{state_, errors_, kMount};
};

TEST_F(ObservedPoint, IsLocatedWhereItIsObservedAgain) {
  state_.place_robot({kView.T_world_robot, Eigen::Matrix3d::Zero()});
  errors_.begin_scan();
  errors_.assign(state_, {});
  const Observation observation = observe(measure(kView));
  const LocatedPoint located = observation_.locate({}, observation);
  EXPECT_TRUE(test::matrix_near(located.p_world, kView.p_world, 1e-12));
  Eigen::Matrix3d noise = Eigen::Matrix3d::Zero();
  noise.topLeftCorner<2, 2>() = located.noise;
  const int index = state_.add({located.p_world.x(), located.p_world.y(), 0.0}, Eigen::Matrix3d::Zero(),
                               noise, located.errors);
  const auto again = observation_.linearize(index, {}, observation);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->landmark, index);
  EXPECT_NEAR(again->nu.norm(), 0.0, 1e-12);
  // What lasts is in both, so that only twice the white noise is in the innovation.
  EXPECT_TRUE(test::matrix_near(state_.innovation_covariance(*again), 2.0 * *observation.covariance, 1e-9));
}

TEST_F(ObservedPoint, OfOneRowHasTheErrorsOfThatRow) {
  errors_.begin_scan();
  errors_.assign(state_, {});
  const ObservationBias both = observation_.error_of({}, 5.0, RangeBearing{});
  const ObservationBias range = observation_.error_of({}, 5.0, Range{});
  const ObservationBias bearing = observation_.error_of({}, 5.0, Bearing{});
  for (std::size_t k = 0; k < both.terms.size(); ++k) {
    EXPECT_EQ(range.terms[k].J.row(0), both.terms[k].J.row(0));
    EXPECT_EQ(bearing.terms[k].J.row(0), both.terms[k].J.row(1));
    EXPECT_TRUE(range.terms[k].J.row(1).isZero(0.0));
    EXPECT_TRUE(bearing.terms[k].J.row(1).isZero(0.0));
  }
}

TEST_F(ObservedPoint, AtTheProposalTheInnovationIsWhatIsLeft) {
  state_.place_robot({kView.T_world_robot, 1e-2 * Eigen::Matrix3d::Identity()});
  errors_.begin_scan();
  errors_.assign(state_, {});
  Observation observation = observe(measure(kView));
  const LocatedPoint located = observation_.locate({}, observation);
  Eigen::Matrix3d noise = 1e-6 * Eigen::Matrix3d::Identity();
  const int index =
      state_.add({located.p_world.x(), located.p_world.y(), 0.0}, Eigen::Matrix3d::Zero(), noise);
  std::get<RangeBearing>(observation.value).range_m += 0.1;
  const auto linearization = observation_.linearize(index, {}, observation);
  ASSERT_TRUE(linearization);
  EXPECT_NEAR(linearization->nu[0], 0.1, 1e-9);
  ASSERT_TRUE(state_.propose({&*linearization, 1}));
  const auto there = observation_.linearize_at_proposal(*linearization, observation.value);
  ASSERT_TRUE(there);
  EXPECT_LT(std::abs(there->nu[0]), 0.02);
  EXPECT_EQ(there->R, linearization->R);
}

}  // namespace
}  // namespace waymark::ekf
