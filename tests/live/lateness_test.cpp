#include "workbench/live/lateness.hpp"

#include <gtest/gtest.h>

namespace waymark::live {
namespace {

Stamp at_s(double s) { return stamp_from_seconds(s); }

TEST(Lateness, ExpectsNothingThatWouldBeLaterThanUsual) {
  Lateness lateness(std::chrono::milliseconds(5));
  lateness.add(at_s(10.0), at_s(10.04));
  EXPECT_EQ(lateness.all_until(at_s(10.04)), at_s(10.04 - 0.06 - 0.005));
}

TEST(Lateness, ForgetsAStallSlowly) {
  Lateness lateness(std::chrono::milliseconds(5));
  lateness.add(at_s(10.0), at_s(10.2));
  for (int i = 1; i <= 1000; ++i) lateness.add(at_s(10.0 + 0.1 * i), at_s(10.02 + 0.1 * i));
  EXPECT_GT(lateness.all_until(at_s(111.0)), at_s(111.0 - 0.05));
}

TEST(Lateness, HasABound) {
  Lateness lateness(std::chrono::milliseconds(5));
  lateness.add(at_s(0.0), at_s(500.0));
  EXPECT_EQ(lateness.all_until(at_s(500.0)), at_s(499.0));
}

}  // namespace
}  // namespace waymark::live
