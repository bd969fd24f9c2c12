#include "workbench/live/stream_state.hpp"

#include <gtest/gtest.h>

#include "support/stamps.hpp"

namespace waymark::live {
namespace {

using test::at;

TEST(StreamState, TellsRateAndAge) {
  StreamState state("wheels");
  for (int i = 0; i < 300; ++i) state.count_arrival(at(i / 30.0), at(i / 30.0 + 0.02));
  const StreamSummary summary = state.summary(at(12.0));
  EXPECT_EQ(summary.name, "wheels");
  EXPECT_EQ(summary.received, 300);
  EXPECT_NEAR(summary.rate_hz, 30.0, 0.01);
  EXPECT_NEAR(summary.age_p50_s, 0.02, 0.2 * 0.02);
  EXPECT_NEAR(*summary.silent_s, 12.0 - 299.0 / 30.0 - 0.02, 1e-6);
}

TEST(StreamState, ForgetsAFaultWhenItBringsSomething) {
  StreamState state("camera");
  state.fail("no such device");
  EXPECT_EQ(state.summary(at(0.0)).fault, "no such device");
  EXPECT_FALSE(state.summary(at(0.0)).silent_s);
  state.connect();
  state.count_arrival(at(1.0), at(1.0));
  EXPECT_EQ(state.summary(at(1.0)).fault, "");
  state.connect();
  EXPECT_EQ(state.summary(at(1.0)).reconnects, 1);
}

}  // namespace
}  // namespace waymark::live
