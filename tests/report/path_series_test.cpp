#include "workbench/report/path_series.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace waymark {
namespace {

TEST(PathSeries, IsMovedAndCountsFromItsStart) {
  const Stamp start = Stamp{} + duration_from_seconds(100.0);
  const Pose2 T{1.0, 2.0, 0.5 * kPi};
  const Trajectory path{{start + duration_from_seconds(2.5), {3.0, 0.0, 0.25}, std::nullopt}};
  const PathSeries moved = path_series(path, T, start);
  ASSERT_EQ(moved.t_s.size(), 1U);
  EXPECT_DOUBLE_EQ(moved.t_s[0], 2.5);
  EXPECT_NEAR(moved.x_m[0], 1.0, 1e-12);
  EXPECT_NEAR(moved.y_m[0], 5.0, 1e-12);
  EXPECT_NEAR(moved.theta_rad[0], 0.5 * kPi + 0.25, 1e-12);
  const PathSeries truth = path_series(eval::TruthTrack({{start, {3.0, 0.0, std::nullopt}}}), T, start);
  EXPECT_NEAR(truth.y_m[0], 5.0, 1e-12);
  EXPECT_TRUE(std::isnan(truth.theta_rad[0]));
}

}  // namespace
}  // namespace waymark
