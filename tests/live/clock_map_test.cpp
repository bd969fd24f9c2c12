#include "workbench/live/clock_map.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "support/stamps.hpp"

namespace waymark::live {
namespace {

using test::at;

using std::chrono::milliseconds;
using std::chrono::seconds;

TEST(ClockMap, TakesTheLeastDelayAsTheDifferenceOfTheClocks) {
  ClockMap clocks;
  std::mt19937 random(1);
  std::exponential_distribution<double> late_s(200.0);
  double worst_s = 0.0;
  for (int i = 0; i < 2000; ++i) {
    const double happened_s = 100.0 + 0.033 * i;
    const Stamp arrived = at(happened_s + 0.001 + late_s(random));
    const Stamp stamp = clocks.map(milliseconds(33 * i), arrived);
    EXPECT_LE(stamp, arrived);
    if (i > 100) worst_s = std::max(worst_s, std::abs(to_seconds(stamp) - happened_s - 0.001));
  }
  EXPECT_LT(worst_s, 1e-3);
  EXPECT_EQ(clocks.steps(), 0);
}

TEST(ClockMap, KeepsTheSpacingOfABurst) {
  ClockMap clocks;
  for (int i = 0; i < 100; ++i) static_cast<void>(clocks.map(milliseconds(20 * i), at(50.0 + 0.02 * i)));
  for (int i = 100; i < 130; ++i) {  // all of 0.6 s at once
    const Stamp stamp = clocks.map(milliseconds(20 * i), at(52.6));
    EXPECT_NEAR(to_seconds(stamp), 50.0 + 0.02 * i, 1e-9);
  }
  EXPECT_EQ(clocks.steps(), 0);
}

TEST(ClockMap, FollowsAClockThatDrifts) {
  ClockMap clocks;
  double last_error_s = 0.0;
  for (int i = 0; i < 60'000; ++i) {  // 20 minutes, 100 parts in a million slow
    const double t_s = 0.02 * i;
    const Stamp stamp = clocks.map(duration_from_seconds((1.0 - 1e-4) * t_s), at(10.0 + t_s));
    last_error_s = to_seconds(stamp) - 10.0 - t_s;
  }
  EXPECT_GT(last_error_s, -0.0021);  // what it loses in 20 s
  EXPECT_LE(last_error_s, 0.0);
}

TEST(ClockMap, SharesAClockThatIsTheSame) {
  ClockMap clocks;
  for (int i = 0; i < 10; ++i)
    EXPECT_EQ(clocks.map(at(1e9 + i).since_epoch, at(1e9 + i + 0.08)), at(1e9 + i));
}

TEST(ClockMap, BeginsAnewWhereAClockSteps) {
  for (const double step_s : {-3600.0, 3600.0}) {
    ClockMap clocks;
    double error_s = 0.0;
    for (int i = 0; i < 600; ++i) {
      const double t_s = 0.05 * i;
      const double device_s = 5000.0 + t_s + (i >= 300 ? step_s : 0.0);
      const Stamp stamp = clocks.map(duration_from_seconds(device_s), at(100.0 + t_s));
      if (i > 330) error_s = std::max(error_s, std::abs(to_seconds(stamp) - 100.0 - t_s));
    }
    EXPECT_EQ(clocks.steps(), 1) << step_s;
    EXPECT_LT(error_s, 1e-6) << step_s;
  }
}

TEST(ClockMap, NeverGoesBackOrAhead) {
  ClockMap clocks;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any_s(-50.0, 50.0);
  Stamp last = at(0.0);
  for (int i = 0; i < 5000; ++i) {
    const Stamp arrived = at(1000.0 + 0.01 * i);
    const Stamp stamp = clocks.map(duration_from_seconds(200.0 + 0.01 * i + any_s(random)), arrived);
    ASSERT_GE(stamp, last);
    ASSERT_LE(stamp, arrived);
    last = stamp;
  }
}

}  // namespace
}  // namespace waymark::live
