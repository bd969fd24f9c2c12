#include "workbench/datasets/reflectors.hpp"

#include <gtest/gtest.h>

#include "waymark/core/angle.hpp"

namespace waymark {
namespace {

constexpr Eigen::Index kBeams = 361;

/// A scan in which beam, range and intensity are set.
struct Scan {
  Eigen::VectorXd ranges_m = Eigen::VectorXd::Constant(kBeams, 81.9);
  Eigen::VectorXd intensities = Eigen::VectorXd::Zero(kBeams);

  Scan& set(Eigen::Index beam, double range_m, double intensity = 16384.0) {
    ranges_m(beam) = range_m;
    intensities(beam) = intensity;
    return *this;
  }
  [[nodiscard]] std::vector<RangeBearing> reflectors() const {
    return find_reflectors(ranges_m, intensities);
  }
};

TEST(Reflectors, AreAtTheMedianRangeInTheMiddleOfARun) {
  const auto found = Scan().set(180, 10.0).set(181, 10.2).set(183, 55.0).reflectors();
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].range_m, 10.2);
  EXPECT_NEAR(found[0].bearing_rad, to_radians((181.0 + 1.0 / 3.0) / 2.0 - 90.0), 1e-12);
  EXPECT_NEAR(Scan().set(0, 3.0).set(1, 4.0).reflectors()[0].range_m, 3.5, 1e-12);
  EXPECT_NEAR(Scan().set(0, 3.0).reflectors()[0].bearing_rad, -kPi / 2.0, 1e-12) << "the first beam is right";
}

TEST(Reflectors, EndWhereBrightBeamsLieApart) {
  EXPECT_EQ(Scan().set(100, 5.0).set(102, 5.0).reflectors().size(), 1U);
  EXPECT_EQ(Scan().set(100, 5.0).set(103, 5.0).reflectors().size(), 2U);
}

TEST(Reflectors, PlainEchoesAndRangesOutOfReachAreNone) {
  EXPECT_TRUE(Scan().set(10, 5.0, 0.0).set(20, 0.4).set(30, 75.0).reflectors().empty());
}

}  // namespace
}  // namespace waymark
