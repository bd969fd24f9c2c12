#include "workshop/figures/consistency_study.hpp"

#include <gtest/gtest.h>

namespace waymark::study {
namespace {

ConsistencyOptions poor_odometry() {
  ConsistencyOptions options;
  options.runs = 40;
  options.odometry_sigma_m = 0.04;
  options.odometry_sigma_rad = to_radians(3.0);
  return options;
}

// The NEES of successive steps hang together, so that the part inside its 99 % band scatters from one set of
// runs to the next; a filter that fools itself about its heading is outside most of the time.
TEST(Consistency, WithPoorOdometryOnlyTheInvariantFilterIsHonest) {
  const auto invariant = study_consistency(ekf::Consistency::kInvariant, poor_odometry(), 2);
  const auto standard = study_consistency(ekf::Consistency::kStandard, poor_odometry(), 2);
  EXPECT_GT(invariant.part_inside, 0.75);
  EXPECT_GT(invariant.nees_mean, invariant.low);
  EXPECT_LT(invariant.nees_mean, invariant.high);
  EXPECT_LT(standard.part_inside, 0.5);
  EXPECT_GT(standard.nees_mean, standard.high);
  EXPECT_LT(invariant.position_rmse_m, standard.position_rmse_m);
}

TEST(Consistency, DoesNotDependOnThreads) {
  ConsistencyOptions options;
  options.runs = 3;
  options.steps = 40;
  const auto one = study_consistency(ekf::Consistency::kFej, options, 1);
  const auto two = study_consistency(ekf::Consistency::kFej, options, 2);
  EXPECT_EQ(one.nees, two.nees);
  EXPECT_EQ(one.position_rmse_m, two.position_rmse_m);
}

TEST(Consistency, ComparesModesOverTheSameWorlds) {
  ConsistencyOptions options;
  options.runs = 2;
  options.steps = 30;
  const auto comparison = compare_modes(options, 2);
  ASSERT_EQ(comparison.modes.size(), 3U);
  EXPECT_EQ(comparison.modes[0].name, "invariant");
  EXPECT_EQ(comparison.modes[2].name, "standard");
  EXPECT_EQ(comparison.modes[2].result.nees, study_consistency(ekf::Consistency::kStandard, options, 1).nees);
  EXPECT_NE(comparison.modes[0].result.nees, comparison.modes[2].result.nees);
}

}  // namespace
}  // namespace waymark::study
