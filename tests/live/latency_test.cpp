#include "workbench/live/latency.hpp"

#include <gtest/gtest.h>

#include "support/stamps.hpp"

namespace waymark::live {
namespace {

using test::at;

TEST(LatencyHistogram, TellsQuantilesToTwoPercent) {
  LatencyHistogram times;
  for (int i = 1; i <= 1000; ++i) times.add(1e-5 * i);
  EXPECT_NEAR(times.quantile_s(0.5), 5e-3, 0.03 * 5e-3);
  EXPECT_NEAR(times.quantile_s(0.99), 9.9e-3, 0.03 * 9.9e-3);
  EXPECT_EQ(times.quantile_s(1.0), 1e-2);
  EXPECT_EQ(times.max_s(), 1e-2);
  EXPECT_NEAR(static_cast<double>(times.count_above(5e-3)), 500.0, 15.0);
}

TEST(LatencyHistogram, IsZeroWhereThereIsNothing) {
  EXPECT_EQ(LatencyHistogram().quantile_s(0.5), 0.0);
  EXPECT_EQ(LatencyHistogram().max_s(), 0.0);
}

TEST(CorrectionLatency, CountsWaitingForOdometryApart) {
  CorrectionLatency times;
  times.observation_arrived(at(1.0), at(1.01));
  times.odometry_arrived(at(0.99), at(0.995));
  times.odometry_arrived(at(1.02), at(1.03));
  times.corrected(at(1.0), at(1.034));
  EXPECT_NEAR(times.waits().max_s(), 0.02, 1e-9);
  EXPECT_NEAR(times.latencies().max_s(), 0.004, 1e-9);
}

TEST(CorrectionLatency, PassesOverWhatItWasNotTold) {
  CorrectionLatency times;
  times.corrected(at(1.0), at(2.0));
  EXPECT_EQ(times.latencies().count(), 0);
}

}  // namespace
}  // namespace waymark::live
