#include "waymark/core/angle.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace waymark {
namespace {

TEST(WrapAngle, KeepsTheDirectionOverFiveTurnsEitherWay) {
  for (int degrees = -1800; degrees <= 1800; ++degrees) {
    const double angle = to_radians(degrees);
    const double wrapped = wrap_angle(angle);
    EXPECT_GT(wrapped, -kPi) << degrees;
    EXPECT_LE(wrapped, kPi) << degrees;
    EXPECT_NEAR(std::cos(wrapped), std::cos(angle), 1e-13) << degrees;
    EXPECT_NEAR(std::sin(wrapped), std::sin(angle), 1e-13) << degrees;
  }
}

TEST(WrapAngle, LeavesAnglesInRangeUntouched) {
  for (const double angle : {0.0, -0.0, 1e-300, -3.0, 3.0, kPi, std::nextafter(-kPi, 0.0)})
    EXPECT_EQ(wrap_angle(angle), angle);
}

TEST(WrapAngle, HalfTurnIsAlwaysPlusPi) {
  EXPECT_EQ(wrap_angle(kPi), kPi);
  EXPECT_EQ(wrap_angle(-kPi), kPi);
  EXPECT_NEAR(std::abs(wrap_angle(3.0 * kPi)), kPi, 1e-14);
  EXPECT_GT(wrap_angle(-3.0 * kPi), -kPi);
}

TEST(WrapAngle, HugeAnglesStayInRange) {
  for (double angle = 10.0; angle < 1e300; angle *= 7.3) {
    EXPECT_LE(std::abs(wrap_angle(angle)), kPi);
    EXPECT_GT(wrap_angle(-angle), -kPi);
  }
}

TEST(WrapAngle, WhatIsNotFiniteBecomesNaN) {
  EXPECT_TRUE(std::isnan(wrap_angle(std::numeric_limits<double>::quiet_NaN())));
  EXPECT_TRUE(std::isnan(wrap_angle(std::numeric_limits<double>::infinity())));
}

TEST(Degrees, AreTheInverseOfRadians) {
  EXPECT_DOUBLE_EQ(to_radians(180.0), kPi);
  for (double degrees = -400.0; degrees <= 400.0; degrees += 12.7)
    EXPECT_NEAR(to_degrees(to_radians(degrees)), degrees, 1e-12);
}

}  // namespace
}  // namespace waymark
