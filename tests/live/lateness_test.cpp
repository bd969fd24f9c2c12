#include "workbench/live/lateness.hpp"

#include <gtest/gtest.h>

#include "support/stamps.hpp"

namespace waymark::live {
namespace {

using test::at;

TEST(Lateness, ExpectsNothingThatWouldBeLaterThanUsual) {
  Lateness lateness(std::chrono::milliseconds(5));
  lateness.add(at(10.0), at(10.04));
  EXPECT_EQ(lateness.all_until(at(10.04)), at(10.04 - 0.06 - 0.005));
}

TEST(Lateness, ForgetsAStallSlowly) {
  Lateness lateness(std::chrono::milliseconds(5));
  lateness.add(at(10.0), at(10.2));
  for (int i = 1; i <= 1000; ++i) lateness.add(at(10.0 + 0.1 * i), at(10.02 + 0.1 * i));
  EXPECT_GT(lateness.all_until(at(111.0)), at(111.0 - 0.05));
}

TEST(Lateness, HasABound) {
  Lateness lateness(std::chrono::milliseconds(5));
  lateness.add(at(0.0), at(500.0));
  EXPECT_EQ(lateness.all_until(at(500.0)), at(499.0));
}

}  // namespace
}  // namespace waymark::live
