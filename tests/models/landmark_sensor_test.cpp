#include "waymark/models/landmark_sensor.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "support/matrix_near.hpp"

namespace waymark {
namespace {

using test::matrix_near;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

LandmarkSensor example_sensor() {
  LandmarkSensor sensor;
  sensor.range_sigma_m = 0.1;
  sensor.range_sigma_ratio = 0.02;
  sensor.bearing_sigma_deg = 2.0;
  sensor.min_range_m = 0.5;
  sensor.max_range_m = 8.0;
  return sensor;
}

TEST(LandmarkSensor, SitsWhereItsMountSays) {
  LandmarkSensor sensor;
  sensor.x_m = 0.2;
  sensor.y_m = -0.1;
  sensor.yaw_deg = 90.0;
  EXPECT_EQ(sensor.T_robot_sensor(), (Pose2{0.2, -0.1, 0.5 * kPi}));
}

TEST(LandmarkSensor, ScaleAndOffsetGiveTheDistanceBack) {
  LandmarkSensor sensor;
  sensor.range_scale = 1.07;
  sensor.range_offset_m = 0.2;
  const auto range = std::get<Range>(rectify(sensor, Range{1.07 * 5.0 + 0.2}));
  EXPECT_NEAR(range.range_m, 5.0, 1e-12);
  const auto both = std::get<RangeBearing>(rectify(sensor, RangeBearing{1.07 * 3.0 + 0.2, 0.5}));
  EXPECT_NEAR(both.range_m, 3.0, 1e-12);
  EXPECT_EQ(both.bearing_rad, 0.5);
  EXPECT_EQ(std::get<Bearing>(rectify(sensor, Bearing{0.5})).bearing_rad, 0.5);
}

TEST(NoiseCovariance, GrowsWithRangeAndFollowsTheLayoutOfObservations) {
  const LandmarkSensor sensor = example_sensor();
  const double range_var = 0.2 * 0.2;  // 0.1 + 0.02 * 5
  const double bearing_var = to_radians(2.0) * to_radians(2.0);
  EXPECT_TRUE(matrix_near(noise_covariance(sensor, RangeBearing{5.0, 1.0}),
                          Eigen::Matrix2d{{range_var, 0.0}, {0.0, bearing_var}}, 1e-15));
  EXPECT_TRUE(matrix_near(noise_covariance(sensor, Range{5.0}), Eigen::Matrix2d{{range_var, 0.0}, {0.0, 0.0}},
                          1e-15));
  EXPECT_TRUE(matrix_near(noise_covariance(sensor, Bearing{1.0}),
                          Eigen::Matrix2d{{bearing_var, 0.0}, {0.0, 0.0}}, 1e-15));
  EXPECT_TRUE(matrix_near(noise_covariance(sensor, Pixel{1.0, 2.0}), Eigen::Matrix2d::Zero(), 0.0));
}

TEST(Rectify, LeavesWhatAPlainSensorReports) {
  const auto z = std::get<RangeBearing>(rectify(LandmarkSensor{}, RangeBearing{3.0, 0.5}));
  EXPECT_EQ(z.range_m, 3.0);
  EXPECT_EQ(z.bearing_rad, 0.5);
  EXPECT_EQ(std::get<Bearing>(rectify(LandmarkSensor{}, Bearing{0.5})).bearing_rad, 0.5);
}

TEST(Rectify, TakesOffsetAndScaleOutOfRanges) {
  LandmarkSensor sensor;
  sensor.range_scale = 1.05;
  sensor.range_offset_m = 0.3;
  EXPECT_NEAR(std::get<Range>(rectify(sensor, Range{1.05 * 4.0 + 0.3})).range_m, 4.0, 1e-12);
  EXPECT_NEAR(std::get<RangeBearing>(rectify(sensor, RangeBearing{4.5, 1.0})).range_m, 4.0, 1e-12);
}

TEST(Rectify, MakesADepthARange) {
  LandmarkSensor sensor;
  sensor.range_is_depth = true;
  const Eigen::Vector2d landmark(3.0, -1.5);
  const double bearing_rad = std::atan2(landmark.y(), landmark.x());
  const auto z = std::get<RangeBearing>(rectify(sensor, RangeBearing{landmark.x(), bearing_rad}));
  EXPECT_NEAR(z.range_m, landmark.norm(), 1e-12);
  EXPECT_EQ(z.bearing_rad, bearing_rad);
}

TEST(Rectify, RefusesADepthWithoutADirectionOrBesideTheSensor) {
  LandmarkSensor sensor;
  sensor.range_is_depth = true;
  EXPECT_FALSE(is_usable(sensor, rectify(sensor, Range{3.0})));
  EXPECT_FALSE(is_usable(sensor, rectify(sensor, RangeBearing{3.0, 0.5 * kPi + 0.01})));
}

TEST(WithWhiteErrors, CoversWhatLastsByNoise) {
  LandmarkSensor sensor;
  sensor.range_sigma_ratio = 0.03;
  sensor.errors.bias_range_sigma_ratio = 0.04;
  sensor.bearing_sigma_deg = 3.0;
  sensor.errors.shared_bearing_sigma_deg = 4.0;
  const LandmarkSensor white = with_white_errors(sensor);
  EXPECT_NEAR(white.range_sigma_ratio, 0.05, 1e-15);
  EXPECT_NEAR(white.bearing_sigma_deg, 5.0, 1e-15);
  EXPECT_FALSE(white.errors.lasts());
  EXPECT_FALSE(white.errors.shares());
}

Eigen::Vector2d at(double range_m, double bearing_deg) {
  return range_m * Eigen::Vector2d(std::cos(to_radians(bearing_deg)), std::sin(to_radians(bearing_deg)));
}

TEST(IsInView, TakesInWhatIsWithinTheLimits) {
  LandmarkSensor sensor = example_sensor();
  sensor.field_of_view_deg = 60.0;
  for (const Eigen::Vector2d& inside : {at(0.51, 0.0), at(7.99, 0.0), at(4.0, 29.9), at(4.0, -29.9)})
    EXPECT_TRUE(is_in_view(sensor, inside)) << inside;
  for (const Eigen::Vector2d& outside :
       {at(0.49, 0.0), at(8.01, 0.0), at(4.0, 30.1), at(4.0, -30.1), at(4.0, 180.0)})
    EXPECT_FALSE(is_in_view(sensor, outside)) << outside;
}

TEST(IsInView, AMarginKeepsClearOfEachLimit) {
  LandmarkSensor sensor = example_sensor();
  sensor.field_of_view_deg = 60.0;
  const ViewMargin margin{0.2, to_radians(2.0)};
  for (const Eigen::Vector2d& inside : {at(0.71, 0.0), at(7.79, 0.0), at(4.0, 27.9), at(4.0, -27.9)})
    EXPECT_TRUE(is_in_view(sensor, inside, margin)) << inside;
  for (const Eigen::Vector2d& near : {at(0.69, 0.0), at(7.81, 0.0), at(4.0, 28.1), at(4.0, -28.1)})
    EXPECT_FALSE(is_in_view(sensor, near, margin)) << near;
}

TEST(IsInView, AllRoundThereIsNoEdgeToKeepClearOf) {
  const ViewMargin margin{0.2, to_radians(20.0)};
  EXPECT_TRUE(is_in_view(example_sensor(), at(4.0, 180.0), margin));
  EXPECT_FALSE(is_in_view(example_sensor(), at(7.9, 180.0), margin));
}

TEST(IsUsable, TakesRangesUpToTheLimitsThemselves) {
  const LandmarkSensor sensor = example_sensor();
  for (const double range_m : {0.5, 3.0, 8.0}) {
    EXPECT_TRUE(is_usable(sensor, Range{range_m})) << range_m;
    EXPECT_TRUE(is_usable(sensor, RangeBearing{range_m, -3.0})) << range_m;
  }
  for (const double range_m : {0.499, 8.001, 0.0, -1.0, kNaN, kInfinity}) {
    EXPECT_FALSE(is_usable(sensor, Range{range_m})) << range_m;
    EXPECT_FALSE(is_usable(sensor, RangeBearing{range_m, 0.0})) << range_m;
  }
}

TEST(IsUsable, RefusesBearingsThatAreNotFinite) {
  const LandmarkSensor sensor = example_sensor();
  EXPECT_TRUE(is_usable(sensor, Bearing{0.3}));
  for (const double bearing_rad : {kNaN, kInfinity, -kInfinity}) {
    EXPECT_FALSE(is_usable(sensor, Bearing{bearing_rad}));
    EXPECT_FALSE(is_usable(sensor, RangeBearing{3.0, bearing_rad}));
  }
}

TEST(IsUsable, RefusesARangeOfZeroAndWhatItCannotMeasure) {
  EXPECT_FALSE(is_usable(LandmarkSensor{}, Range{0.0}));
  EXPECT_FALSE(is_usable(LandmarkSensor{}, Pixel{10.0, 10.0}));
}

}  // namespace
}  // namespace waymark
