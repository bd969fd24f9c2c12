#include "workbench/run/log_sample.hpp"

#include <gtest/gtest.h>

namespace waymark {
namespace {

TEST(LogSample, TakesOdometryOfTheFirstStreamOnly) {
  LogSample sample;
  sample.add(Event(Stamp{}, Image{}), {});
  sample.add(Event(Stamp{}, StreamId{0, 1}, Velocity{}), {});
  sample.add(Event(Stamp{}, StreamId{0, 2}, Velocity{}), {});
  sample.add(Event(Stamp{}, StreamId{0, 1}, OdometryPose{}), {});
  EXPECT_EQ(sample.odometry.size(), 1U);
}

TEST(LogSample, KeepsTheGyroApart) {
  LogSample sample;
  sample.add(Event(Stamp{}, Velocity{}), {});
  sample.add(Event(Stamp{}, YawRate{}), {});
  EXPECT_EQ(sample.odometry.size(), 1U);
  EXPECT_EQ(sample.yaw_rates.size(), 1U);
}

TEST(LogSample, FreesObservationsFromKnownErrors) {
  LandmarkSensor sensor;
  sensor.range_scale = 2.0;
  LogSample sample;
  sample.add(Event(Stamp{}, Observations{{std::nullopt, RangeBearing{4.0, 0.1}, {}}}), sensor);
  ASSERT_EQ(sample.observations.size(), 1U);
  EXPECT_EQ(std::get<RangeBearing>(sample.observations[0].value).range_m, 2.0);
}

TEST(LogSample, EndsWhereThereIsNoMoreRoom) {
  LogSample sample;
  for (std::size_t i = 0; i < LogSample::kMost + 10; ++i) sample.add(Event(Stamp{}, Velocity{}), {});
  EXPECT_EQ(sample.odometry.size(), LogSample::kMost);
}

}  // namespace
}  // namespace waymark
