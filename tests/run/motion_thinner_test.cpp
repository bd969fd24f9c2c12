#include "workbench/run/motion_thinner.hpp"

#include <gtest/gtest.h>

namespace waymark {
namespace {

Motion step() { return {{0.1, 0.0, 0.01}, 1e-4 * Eigen::Matrix3d::Identity(), 0.1}; }

TEST(MotionThinner, PutsTheMotionsBetweenTogether) {
  MotionThinner thinner;
  Pose2 all, kept;
  int points = 0;
  for (int i = 0; i < 1000; ++i) {
    if (i == 100 || i == 300) thinner.double_stride();
    all = all * step().increment;
    if (const auto motion = thinner.add(step())) {
      kept = kept * motion->increment;
      ++points;
      ASSERT_LT(difference(all, kept).norm(), 1e-9);
    }
  }
  EXPECT_EQ(points, 100 + 100 + 175);
}

}  // namespace
}  // namespace waymark
