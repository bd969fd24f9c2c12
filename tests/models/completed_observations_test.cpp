#include "waymark/models/completed_observations.hpp"

#include <gtest/gtest.h>

#include "support/allocation_counter.hpp"
#include "support/matrix_near.hpp"

namespace waymark {
namespace {

const LandmarkSensor kSensor{.range_sigma_m = 0.1, .range_sigma_ratio = 0.01, .bearing_sigma_deg = 2.0};

TEST(CompletedObservations, AreTheOnesGivenWhereNothingIsMissing) {
  CompletedObservations completed(kSensor);
  const Observations given{{{}, Range{2.0}, Eigen::Matrix2d(0.3 * Eigen::Matrix2d::Identity())}};
  EXPECT_EQ(completed.of(given).data(), given.data());
  EXPECT_TRUE(completed.of({}).empty());
}

TEST(CompletedObservations, HaveTheNoiseOfTheSensorWhereTheyCameWithout) {
  CompletedObservations completed(kSensor);
  const Eigen::Matrix2d own = 0.3 * Eigen::Matrix2d::Identity();
  const Observations given{{{}, RangeBearing{2.0, 0.1}, own}, {{}, RangeBearing{3.0, -0.1}, {}}};
  const auto all = completed.of(given);
  ASSERT_EQ(all.size(), 2U);
  EXPECT_TRUE(test::matrix_near(*all[0].covariance, own, 0.0));
  EXPECT_TRUE(test::matrix_near(*all[1].covariance, noise_covariance(kSensor, RangeBearing{3.0, -0.1}), 0.0));
  EXPECT_FALSE(given[1].covariance) << "what was given stays";
}

TEST(CompletedObservations, TakeNoMemoryOfTheirOwnLater) {
  CompletedObservations completed(kSensor, 8);
  const Observations given(8, Observation{{}, Bearing{0.5}, {}});
  const test::AllocationCount count;
  for (int i = 0; i < 10; ++i) EXPECT_EQ(completed.of(given).size(), 8U);
  EXPECT_EQ(count.allocations(), 0);
}

}  // namespace
}  // namespace waymark
