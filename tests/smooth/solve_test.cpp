#include "waymark/smooth/solve.hpp"

#include <cmath>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "support/circle_world.hpp"
#include "support/matrix_near.hpp"

namespace waymark::smooth {
namespace {

/// What CircleWorld shows on its way, with the odometry's own path as the start.
struct World {
  Graph graph;
  Estimate start;
  std::vector<Pose2> truth;
  std::vector<Eigen::Vector2d> landmarks;
};

World drive(std::uint64_t seed, int steps) {
  test::CircleWorld circle(seed);
  World world;
  world.graph.T_robot_sensor = circle.mount();
  world.landmarks = circle.landmarks();
  world.start.poses.push_back(circle.truth());
  world.truth.push_back(circle.truth());
  for (int i = 1; i <= steps; ++i) {
    const Motion motion = circle.move();
    world.graph.intervals.push_back({{{motion.increment, 0.1}}, motion.covariance});
    world.start.poses.push_back(world.start.poses.back() * motion.increment);
    world.truth.push_back(circle.truth());
    for (const Observation& seen : circle.look())
      world.graph.observations.push_back({i, seen.id->number, seen.value, *seen.covariance});
  }
  for (const Eigen::Vector2d& p : world.landmarks)
    world.start.landmarks.emplace_back(p.x() + 0.3, p.y() - 0.4);
  return world;
}

double error_m(const Estimate& estimate, const World& world) {
  double sum = 0.0;
  for (std::size_t i = 0; i < world.truth.size(); ++i)
    sum += (estimate.poses[i].position() - world.truth[i].position()).squaredNorm();
  return std::sqrt(sum / static_cast<double>(world.truth.size()));
}

TEST(Solve, FindsPathAndMapAndIsAsSureAsItMayBe) {
  constexpr int kSeeds = 20;
  double nees = 0.0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const World world = drive(seed, 60);
    const Solution solution = solve(world.graph, world.start, {.robust_dof = 1e6});
    EXPECT_TRUE(solution.converged);
    EXPECT_LT(solution.cost, solution.cost_before);
    EXPECT_LT(error_m(solution.estimate, world), 0.3);
    const Eigen::Vector3d last = difference(solution.estimate.poses.back(), world.truth.back());
    nees += last.dot(solution.pose_covariances.back().llt().solve(last)) / kSeeds;
  }
  EXPECT_GT(nees, 1.5);  // 60 degrees of freedom: 99.9 % of all means are within 1.6 and 4.9
  EXPECT_LT(nees, 5.0);
}

TEST(Solve, WhatIsLeftOverAndWhatWasFollowedMakeUpTheNoise) {
  constexpr int kSeeds = 20;
  Eigen::Vector2d ratio = Eigen::Vector2d::Zero();
  double count = 0.0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const World world = drive(seed, 60);
    const Solution solution = solve(world.graph, world.start, {.robust_dof = 1e6});
    ASSERT_EQ(solution.observation_residuals.size(), world.graph.observations.size());
    for (std::size_t i = 0; i < solution.observation_residuals.size(); ++i, ++count)
      ratio += (solution.observation_residuals[i].residual.cwiseAbs2() +
                solution.observation_residuals[i].followed)
                   .cwiseQuotient(world.graph.observations[i].covariance.diagonal());
  }
  ratio /= count;
  // The mean of chi-squares of which at least half is random.
  const double sigma = std::sqrt(2.0 / count);
  EXPECT_NEAR(ratio[0], 1.0, 4.0 * sigma);
  EXPECT_NEAR(ratio[1], 1.0, 4.0 * sigma);
}

TEST(Solve, WhatIsLeftOverOfIntervalsAndWhatWasFollowedMakeUpTheirNoise) {
  constexpr int kSeeds = 20;
  Eigen::Vector3d ratio = Eigen::Vector3d::Zero();
  double count = 0.0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const World world = drive(seed, 60);
    const Solution solution = solve(world.graph, world.start, {.robust_dof = 1e6});
    ASSERT_EQ(solution.interval_residuals.size(), world.graph.intervals.size());
    for (const IntervalResidual& interval : solution.interval_residuals) {
      ratio += (interval.residual.cwiseAbs2() + interval.followed).cwiseQuotient(interval.stated);
      ++count;
    }
  }
  // The mean of chi-squares, of which a part only is random.
  for (const double each : ratio / count) EXPECT_NEAR(each, 1.0, 4.0 * std::sqrt(2.0 / count));
}

TEST(Solve, FindsWhereTheSensorSits) {
  World world = drive(3, 200);
  const Pose2 mount = world.graph.T_robot_sensor;
  world.graph.T_robot_sensor = {mount.x_m - 0.1, mount.y_m + 0.15, mount.theta_rad + 0.05};
  world.graph.calibration_sigmas[kMountX] = world.graph.calibration_sigmas[kMountY] = 0.5;
  world.graph.calibration_sigmas[kBearingOffset] = 0.3;
  const Solution solution = solve(world.graph, world.start);
  const Calibration& c = solution.estimate.calibration;
  const Calibration& sigma = solution.calibration_sigmas;
  EXPECT_NEAR(c[kMountX], 0.1, 4.0 * sigma[kMountX]);
  EXPECT_NEAR(c[kMountY], -0.15, 4.0 * sigma[kMountY]);
  EXPECT_NEAR(c[kBearingOffset], 0.05, 4.0 * sigma[kBearingOffset]);
  EXPECT_LT(sigma[kMountX], 0.25);
}

TEST(Solve, OutliersDoNotDrawIt) {
  World world = drive(1, 60);
  const double clean_m = error_m(solve(world.graph, world.start).estimate, world);
  for (std::size_t i = 5; i < world.graph.observations.size(); i += 10)
    std::get<RangeBearing>(world.graph.observations[i].value).range_m += 3.0;
  EXPECT_LT(error_m(solve(world.graph, world.start).estimate, world), clean_m + 0.05);
  EXPECT_GT(error_m(solve(world.graph, world.start, {.robust_dof = 1e6}).estimate, world), clean_m + 0.05);
}

TEST(Solve, TakesRangesOrBearingsAlone) {
  for (const bool ranges : {true, false}) {
    World world = drive(2, 60);
    for (ObservationEdge& observation : world.graph.observations) {
      const auto z = std::get<RangeBearing>(observation.value);
      if (ranges) observation.value = Range{z.range_m};
      if (!ranges) observation.value = Bearing{z.bearing_rad};
      if (!ranges) observation.covariance(0, 0) = observation.covariance(1, 1);
    }
    const Solution solution = solve(world.graph, world.start);
    EXPECT_LT(error_m(solution.estimate, world), 0.25) << (ranges ? "ranges" : "bearings");
  }
}

TEST(Solve, FindsWhatTheOdometryWasLike) {
  World world = drive(3, 200);
  Calibration wrong = Calibration::Zero();
  wrong[kSpeedScale] = -0.1;
  wrong[kTurnScale] = 0.2;
  for (KeyframeInterval& interval : world.graph.intervals)
    interval.steps[0].increment = calibrate(interval.steps[0].increment, 0.1, wrong).increment;
  world.graph.calibration_sigmas.head<6>() << 0.2, 0.2, 0.0, 0.0, 0.0, 0.0;
  const Solution solution = solve(world.graph, world.start);
  const Calibration& c = solution.estimate.calibration;
  const Calibration& sigma = solution.calibration_sigmas;
  EXPECT_NEAR(1.0 + c[kSpeedScale], 1.0 / 0.9, 4.0 * sigma[kSpeedScale]);
  EXPECT_NEAR(1.0 + c[kTurnScale], 1.0 / 1.2, 4.0 * sigma[kTurnScale]);
  EXPECT_LT(sigma[kSpeedScale], 0.05);
  EXPECT_EQ(c[kTurnBias], 0.0);
  EXPECT_EQ(sigma[kTurnBias], 0.0);
}

TEST(Solve, FindsWhatTheSensorWasLike) {
  World world = drive(3, 200);
  for (ObservationEdge& observation : world.graph.observations) {
    auto& z = std::get<RangeBearing>(observation.value);
    z = {1.05 * z.range_m + 0.2, z.bearing_rad + 0.03};
  }
  world.graph.calibration_sigmas.head<6>() << 0.0, 0.0, 0.0, 0.2, 1.0, 0.1;
  const Solution solution = solve(world.graph, world.start);
  const Calibration& c = solution.estimate.calibration;
  const Calibration& sigma = solution.calibration_sigmas;
  EXPECT_NEAR(c[kRangeScale], 0.05, 4.0 * sigma[kRangeScale]);
  EXPECT_NEAR(c[kRangeOffset], 0.2, 4.0 * sigma[kRangeOffset]);
  EXPECT_NEAR(c[kBearingOffset], 0.03, 4.0 * sigma[kBearingOffset]);
  EXPECT_LT(sigma[kRangeScale], 0.05);
}

TEST(Solve, CovariancesThatTakeTooLongAreLeftOut) {
  const World world = drive(4, 20);
  const Solution solution = solve(world.graph, world.start, {.max_covariance_work = 10.0});
  EXPECT_TRUE(solution.pose_covariances.empty());
  EXPECT_LT(error_m(solution.estimate, world), 0.2);
}

TEST(Solve, APoseAloneStaysWhereItIs) {
  const Estimate start{{Pose2{1.0, 2.0, 3.0}}, {}};
  EXPECT_EQ(solve({}, start).estimate.poses[0], start.poses[0]);
}

}  // namespace
}  // namespace waymark::smooth
