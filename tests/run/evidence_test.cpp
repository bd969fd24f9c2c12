#include "workbench/run/evidence.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "waymark/ekf/ekf_slam.hpp"

#include "workbench/run/verdict.hpp"

namespace waymark {
namespace {

constexpr double kStep_m = 0.125;
const Eigen::Matrix3d kStepNoise = Eigen::Vector3d(1e-4, 1e-4, 1e-6).asDiagonal();

/// A run straight ahead whose path is odometry times `scale`, as sure at its end as at its start:
/// observations take what odometry adds.
Recording straight_run(int steps, double scale) {
  Recording recording;
  recording.filter = std::make_unique<EkfSlam>(EkfOptions{}, LandmarkSensor{});
  for (int i = 0; i <= steps; ++i) {
    const Pose2 pose{scale * kStep_m * i, 0.0, 0.0};
    recording.trajectory.push_back(
        {stamp_from_seconds(i), pose, Eigen::Matrix3d(Eigen::Vector3d(1e-2, 1e-2, 1e-12).asDiagonal())});
    recording.motions.push_back(i == 0 ? Motion{} : Motion{{kStep_m, 0.0, 0.0}, kStepNoise, 1.0});
  }
  return recording;
}

Innovation compared(int number, double nis, const Eigen::Vector2d& standardised = {1.0, -1.0}) {
  Innovation innovation{
      .landmark = {LandmarkId::Family::kMarker, number}, .outcome = Outcome::kMatched, .dof = 2};
  innovation.nis = nis;
  innovation.standardised = standardised;
  return innovation;
}

void observe(Recording& recording, int second, const Innovation& innovation) {
  recording.innovations.push_back({stamp_from_seconds(second), innovation});
}

/// Of unknown identity.
Innovation unidentified(Outcome outcome) { return {.landmark = {}, .outcome = outcome, .dof = 2}; }

TEST(Evidence, TheMedianNisIsComparedWithThatOfChiSquare) {
  Recording recording = straight_run(10, 1.0);
  for (const double factor : {0.1, 4.0, 1e3})
    observe(recording, 1, compared(1, factor * 2.0 * std::log(2.0)));
  const Evidence evidence = gather_evidence(recording);
  EXPECT_NEAR(evidence.innovations.value, 4.0, 1e-9);
  EXPECT_EQ(evidence.innovations.dof, 3.0);
  EXPECT_EQ(evidence.matched, 3U);
}

TEST(Evidence, AnErrorThatStaysTheSameAddsUpInABlock) {
  Recording same = straight_run(10, 1.0);
  Recording alternating = straight_run(10, 1.0);
  for (int i = 0; i < kInnovationBlock; ++i) {
    observe(same, 1, compared(1, 2.0, {1.0, 1.0}));
    observe(alternating, 1,
            compared(1, 2.0, i % 2 == 0 ? Eigen::Vector2d(1.0, 1.0) : Eigen::Vector2d(-1.0, -1.0)));
  }
  EXPECT_NEAR(gather_evidence(same).blocks.value, kInnovationBlock, 1e-9);
  EXPECT_EQ(gather_evidence(same).blocks.dof, 2.0);
  EXPECT_NEAR(gather_evidence(alternating).blocks.value, 0.0, 1e-9);
}

TEST(Evidence, BlocksAreOfOneLandmark) {
  Recording recording = straight_run(10, 1.0);
  for (int i = 0; i < kInnovationBlock; ++i) observe(recording, 1, compared(i % 2, 2.0));
  EXPECT_EQ(gather_evidence(recording).blocks.dof, 0.0);
}

TEST(Evidence, TheDepartureIsThatOfTheScaleOverTheNoiseOfOdometry) {
  EXPECT_NEAR(gather_evidence(straight_run(80, 1.0)).departure.value, 0.0, 1e-9);
  // In a metre 0.1 m, of which C = Q has the variance 8e-4 m^2: e' (2 Q)^-1 e = 6.25 where 1.5 is right.
  const VarianceRatio departure = gather_evidence(straight_run(80, 1.1)).departure;
  EXPECT_NEAR(departure.value, 6.25 / 1.5, 0.05);
  EXPECT_NEAR(departure.dof, 30.0, 0.5);
}

TEST(Evidence, AStretchWithoutLandmarksIsDrivenByOdometryAlone) {
  Recording recording = straight_run(100, 1.0);
  for (const int second : {5, 12, 60}) observe(recording, second, compared(1, 1.0));
  const Evidence evidence = gather_evidence(recording);
  EXPECT_NEAR(evidence.travelled_m, 12.5, 1e-9);
  EXPECT_NEAR(evidence.unaided_m, 6.0 + 5.0, 1e-9);
}

TEST(Evidence, AScanThatFitsNothingIsNoChance) {
  Recording recording = straight_run(10, 1.0);
  for (int i = 0; i < 10; ++i) observe(recording, 1, unidentified(Outcome::kAdded));
  for (int i = 0; i < 10; ++i)
    observe(recording, 2, unidentified(i == 0 ? Outcome::kAdded : Outcome::kMatched));
  EXPECT_EQ(gather_evidence(recording).misfit.unmatched, 0);
  for (int i = 0; i < 10; ++i)
    observe(recording, 3, unidentified(i == 0 ? Outcome::kMatched : Outcome::kAdded));
  const Misfit misfit = gather_evidence(recording).misfit;
  EXPECT_EQ(misfit.observations, 10);
  EXPECT_EQ(misfit.unmatched, 9);
  EXPECT_EQ(misfit.since_start_s, 3.0);
  // 2 scans, D(0.9 || 0.1) = 0.8 log 9
  EXPECT_NEAR(misfit.log_probability, std::log(2.0) - 10.0 * 0.8 * std::log(9.0), 1e-9);
}

TEST(Evidence, NewNamesAreNoMisfit) {
  Recording recording = straight_run(10, 1.0);
  observe(recording, 1, compared(1, 1.0));
  for (int i = 2; i < 20; ++i)
    observe(recording, 2, {.landmark = {LandmarkId::Family::kMarker, i}, .outcome = Outcome::kAdded});
  EXPECT_EQ(gather_evidence(recording).misfit.observations, 0);
}

Trust trust_in_square(std::vector<std::string> settings) {
  settings.emplace_back("seed=2");
  auto opened = open_input("sim:square", {{}, std::move(settings)});
  if (!opened) return Trust::kDoNotTrust;
  const auto recording = record(*opened->source, opened->config);
  return recording ? judge(gather_evidence(*recording)).level : Trust::kDoNotTrust;
}

TEST(Evidence, IsGoodOfARunWhoseModelsAreRightAndOnlyOfThat) {
  EXPECT_EQ(trust_in_square({}), Trust::kGood);
  EXPECT_NE(trust_in_square({"wheels.left_radius_m=0.107", "wheels.right_radius_m=0.107"}), Trust::kGood);
  EXPECT_NE(trust_in_square({"sensor.delay_s=0.3"}), Trust::kGood);
  EXPECT_NE(trust_in_square({"sensor.range_sigma_m=0.005", "sensor.bearing_sigma_deg=0.15"}), Trust::kGood);
}

}  // namespace
}  // namespace waymark
