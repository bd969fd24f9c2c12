#include "workbench/calibrate/drift.hpp"

#include <gtest/gtest.h>

#include "waymark/core/angle.hpp"

namespace waymark::calibrate {
namespace {

/// 10 m along a line that bends by so much at its middle.
Trajectory line(double bend_rad, const Pose2& start) {
  Trajectory path;
  for (int i = 0; i <= 100; ++i) {
    const Pose2 bent =
        i <= 50 ? Pose2{0.1 * i, 0.0, 0.0} : Pose2{5.0, 0.0, bend_rad} * Pose2{0.1 * (i - 50), 0.0, 0.0};
    path.push_back({Stamp{} + duration_from_seconds(0.1 * i), start * bent, std::nullopt});
  }
  return path;
}

TEST(DriftOf, IsCountedFromACommonStart) {
  const auto reference = eval::TruthTrack::from_trajectory(line(0.0, {3.0, -2.0, 1.0}));
  const auto drift = drift_of(line(0.2, {}), reference);
  ASSERT_TRUE(drift.has_value());
  EXPECT_NEAR(drift->path_m, 10.0, 1e-9);
  EXPECT_NEAR(drift->final_m, 2.0 * 5.0 * std::sin(0.1), 1e-9);
  EXPECT_NEAR(drift->final_heading_deg, to_degrees(0.2), 1e-9);
  EXPECT_NEAR(drift->percent(), 10.0 * drift->final_m, 1e-9);
  EXPECT_LT(drift->rmse_aligned_m, drift->rmse_m);
  EXPECT_GT(drift->rmse_aligned_m, 0.05);
}

TEST(DriftOf, IsNoneOnTheReferenceAndNothingWithoutOne) {
  const auto path = line(0.2, {});
  EXPECT_NEAR(drift_of(path, eval::TruthTrack::from_trajectory(path))->final_m, 0.0, 1e-12);
  EXPECT_FALSE(drift_of(path, {}).has_value());
}

}  // namespace
}  // namespace waymark::calibrate
