#include "waymark/fastslam/fast_slam.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "support/allocation_counter.hpp"
#include "support/circle_world.hpp"
#include "support/matrix_near.hpp"
#include "support/missing_covariances.hpp"
#include "waymark/core/gaussian.hpp"
#include "waymark/fastslam/resampling.hpp"

namespace waymark {
namespace {

using test::CircleWorld;
using test::matrix_near;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

FastSlamOptions with_particles(int particles) {
  FastSlamOptions options;
  options.particles = particles;
  return options;
}

FastSlamOptions seeded(FastSlamOptions options, std::uint64_t seed) {
  options.seed = seed;
  return options;
}

void drive_named(FastSlam& filter, CircleWorld& world, int steps) {
  for (int i = 0; i < steps; ++i) {
    filter.predict(world.move());
    filter.correct(world.look());
  }
}

/// What is left of an observation by range and bearing.
enum class Seen { kRangeAndBearing, kRange, kBearing };

Observation keep(Seen seen, Observation observation) {
  const auto z = std::get<RangeBearing>(observation.value);
  if (seen == Seen::kRangeAndBearing) return observation;
  const Eigen::Vector2d variances = observation.covariance.value_or(Eigen::Matrix2d::Zero()).diagonal();
  const Eigen::Vector2d kept(seen == Seen::kRange ? variances[0] : variances[1], 0.0);
  const Measurement value = seen == Seen::kRange ? Measurement(Range{z.range_m}) : Bearing{z.bearing_rad};
  return {observation.id, value, Eigen::Matrix2d(kept.asDiagonal())};
}

std::vector<Observation> keep(Seen seen, std::vector<Observation> scan) {
  for (Observation& observation : scan) observation = keep(seen, observation);
  return scan;
}

void drive_named(FastSlam& filter, CircleWorld& world, int steps, Seen seen) {
  for (int i = 0; i < steps; ++i) {
    filter.predict(world.move());
    filter.correct(keep(seen, world.look()));
  }
}

std::vector<Pose2> poses_of(const FastSlam& filter) {
  std::vector<Pose2> poses;
  for (int i = 0; i < filter.particles().count(); ++i) poses.push_back(filter.particles().pose(i));
  return poses;
}

double position_error_m(const Filter& filter, const CircleWorld& world) {
  return (filter.pose().T_world_robot.position() - world.truth().position()).norm();
}

/// The estimate without any landmark.
double dead_reckoning_error_m(std::uint64_t seed, int steps) {
  CircleWorld world(seed);
  Pose2 estimate;
  for (int i = 0; i < steps; ++i) estimate = estimate * world.move().increment;
  return (estimate.position() - world.truth().position()).norm();
}

/// N_eff after a drive in which one landmark is seen at the start and at the end, or all the time.
double effective_after_drive(std::uint64_t seed, bool watching, int steps, double information_distance_m) {
  test::CircleWorld world(seed);
  FastSlamOptions options = with_particles(50);
  options.resample_below = 0.0;
  options.temper_below = 0.0;
  options.enkf_above = 1e9;
  options.information_distance_m = information_distance_m;
  options.proposal = ProposalKind::kMotion;
  FastSlam filter(seeded(options, seed), world.sensor());
  const Observation first = world.sight(0);
  filter.correct({&first, 1});
  for (int i = 0; i < steps; ++i) {
    filter.predict(world.move());
    const Observation again = world.sight(0);
    if (watching || i == steps - 1) filter.correct({&again, 1});
  }
  return fastslam::effective_particles(filter.particles().weights());
}

double mean_effective_after_drive(bool watching, int steps, double information_distance_m) {
  constexpr int kRuns = 20;
  double mean = 0.0;
  for (std::uint64_t seed = 0; seed < kRuns; ++seed)
    mean += effective_after_drive(seed, watching, steps, information_distance_m) / kRuns;
  return mean;
}

/// Weights fall with the distance travelled, not with the number of frames: 20 steps are 2 m.
TEST(FastSlam, ALandmarkUnderWatchWeighsParticlesByDistanceTravelledNotByEachFrame) {
  EXPECT_GT(mean_effective_after_drive(true, 20, 1.0), 5.0 * mean_effective_after_drive(true, 20, 0.0));
}

TEST(FastSlam, ALandmarkThatComesBackAfterALongDistanceWeighsParticlesInFull) {
  const double in_full = mean_effective_after_drive(false, 100, 0.0);
  EXPECT_LT(in_full, 25.0);  // of 50
  EXPECT_NEAR(mean_effective_after_drive(false, 100, 1.0), in_full, 0.01 * in_full);
}

TEST(FastSlam, FollowsTheTruthWhereDeadReckoningDoesNot) {
  constexpr int kSteps = 400;
  constexpr int kRuns = 20;
  double error_m = 0.0;
  double blind_m = 0.0;
  double landmark_error_m = 0.0;
  for (std::uint64_t seed = 0; seed < kRuns; ++seed) {
    CircleWorld world(seed);
    FastSlam filter({.seed = seed}, world.sensor());
    drive_named(filter, world, kSteps);
    error_m += position_error_m(filter, world) / kRuns;
    blind_m += dead_reckoning_error_m(seed, kSteps) / kRuns;
    for (const auto& landmark : filter.snapshot().landmarks) {
      const auto& truth = world.landmarks()[static_cast<std::size_t>(landmark.id.number)];
      landmark_error_m += (landmark.position_m.head<2>() - truth).norm() / (8 * kRuns);
    }
  }
  EXPECT_LT(error_m, 0.15);
  EXPECT_LT(landmark_error_m, 0.15);
  EXPECT_GT(blind_m, 3.0 * error_m);
}

TEST(FastSlam, AddsEachLandmarkOnceAndCountsItsObservations) {
  CircleWorld world(1);
  FastSlam filter({}, world.sensor());
  EXPECT_EQ(filter.correct(world.look()).count(Outcome::kAdded), 8);
  EXPECT_EQ(filter.correct(world.look()).count(Outcome::kMatched), 8);
  const auto landmarks = filter.snapshot().landmarks;
  ASSERT_EQ(landmarks.size(), 8U);
  for (const auto& landmark : landmarks) EXPECT_EQ(landmark.observations, 2);
}

TEST(FastSlam, WeightsAreTheLikelihoodsOfTheScan) {
  CircleWorld world(2);
  FastSlamOptions options = with_particles(50);
  options.resample_below = 0.0;
  options.temper_below = 0.0;
  options.noise_inflation = 1.0;
  options.proposal = ProposalKind::kMotion;
  options.information_distance_m = 0.0;
  FastSlam filter(seeded(options, 3), world.sensor());
  filter.correct(std::vector<Observation>{world.sight(0), world.sight(1)});
  const auto landmarks =
      filter.snapshot().landmarks;  // the same for all particles, which are all at the origin
  filter.predict(world.move());
  const std::vector<Observation> scan{world.sight(0), world.sight(1)};
  ASSERT_EQ(filter.correct(scan).count(Outcome::kMatched), 2);

  std::vector<double> expected;
  double total = 0.0;
  for (int i = 0; i < 50; ++i) {
    double likelihood = 1.0;
    for (std::size_t k = 0; k < 2; ++k) {
      const auto h = RangeBearingModel::linearize(filter.particles().pose(i), world.mount(),
                                                  landmarks[k].position_m.head<2>());
      const Eigen::Vector2d nu =
          RangeBearingModel::innovation(std::get<RangeBearing>(scan[k].value), h.predicted);
      const Eigen::Matrix2d Sigma = landmarks[k].covariance.topLeftCorner<2, 2>();
      const Eigen::Matrix2d Z = h.H_landmark * Sigma * h.H_landmark.transpose() + *scan[k].covariance;
      likelihood *= std::exp(-0.5 * *mahalanobis_squared<2>(nu, Z)) / std::sqrt(Z.determinant());
    }
    expected.push_back(likelihood);
    total += likelihood;
  }
  for (std::size_t i = 0; i < 50; ++i)
    EXPECT_NEAR(filter.particles().weights()[i], expected[i] / total, 1e-5);
}

TEST(FastSlam, PoseFollowsTheMotionBetweenObservations) {
  CircleWorld world(3);
  FastSlam filter({}, world.sensor());
  drive_named(filter, world, 20);
  const PoseEstimate before = filter.pose();
  const Motion motion = world.move();
  filter.predict(motion);
  const PoseEstimate expected = propagate(before, motion);
  EXPECT_TRUE(matrix_near(difference(filter.pose().T_world_robot, expected.T_world_robot),
                          Eigen::Vector3d::Zero(), 1e-12));
  EXPECT_TRUE(matrix_near(filter.pose().covariance, expected.covariance, 1e-12));
}

TEST(FastSlam, ALongBlindDriveBendsTheCloudAsManySmallStepsDo) {
  // A heading error grown to 0.6 rad over 30 m makes a banana whose mean falls short of the end of the
  // straight line; one Gaussian for the whole drive would not.
  constexpr int kSteps = 300;
  const Motion step{{0.1, 0.0, 0.0}, Eigen::Vector3d(0.0, 0.0, 0.0012).asDiagonal()};
  FastSlam filter(with_particles(5000), {});
  for (int i = 0; i < kSteps; ++i) filter.predict(step);
  double mean_x_m = 0.0;
  for (int i = 0; i < kSteps; ++i)
    mean_x_m += 0.1 * std::exp(-0.5 * 0.0012 * i);  // E cos of a Gaussian heading
  ASSERT_LT(mean_x_m, 27.6);
  EXPECT_NEAR(filter.pose().T_world_robot.x_m, mean_x_m, 0.2);
}

TEST(FastSlam, RefusesWhatItCannotUseAndSaysWhy) {
  CircleWorld world(5);
  FastSlamOptions options;
  options.capacity = 8;
  FastSlam filter(options, world.sensor());
  drive_named(filter, world, 10);
  std::vector<Observation> scan(7, world.sight(0));
  scan[0].value = RangeBearing{kNan, 0.0};
  scan[1].id.reset();
  scan[2].value = Pixel{1.0, 1.0};
  scan[3].covariance = Eigen::Matrix2d::Constant(std::numeric_limits<double>::quiet_NaN());
  scan[4].covariance = Eigen::Matrix2d::Zero();
  scan[6].id = LandmarkId{LandmarkId::Family::kMarker, 99};
  scan.push_back(world.sight(0));
  const auto& correction = filter.correct(scan);
  const std::vector<Outcome> expected{Outcome::kUnusable, Outcome::kUnidentified, Outcome::kUnusable,
                                      Outcome::kUnusable, Outcome::kUnusable,     Outcome::kMatched,
                                      Outcome::kMapFull,  Outcome::kDuplicate};
  ASSERT_EQ(correction.innovations.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i)
    EXPECT_EQ(correction.innovations[i].outcome, expected[i]) << i;
  EXPECT_TRUE(filter.pose().covariance.allFinite());
}

TEST(FastSlam, IgnoresAMotionThatIsNotFinite) {
  FastSlam filter({}, {});
  filter.predict({{1.0, 0.0, 0.0}, 1e-4 * Eigen::Matrix3d::Identity()});
  filter.predict({{kNan, 0.0, 0.0}, Eigen::Matrix3d::Identity()});
  filter.predict({{0.0, 0.0, 0.0}, kNan * Eigen::Matrix3d::Identity()});
  EXPECT_EQ(filter.pose().T_world_robot, (Pose2{1.0, 0.0, 0.0}));
}

TEST(FastSlam, AMisreadIdentityIsGatedAndChangesNothing) {
  CircleWorld world(6);
  FastSlam filter({}, world.sensor());
  drive_named(filter, world, 50);
  const PoseEstimate before = filter.pose();
  const auto landmark_before = filter.snapshot().landmarks[4];
  Observation misread = world.sight(0);
  misread.id->number = 4;
  const auto& correction = filter.correct({&misread, 1});
  EXPECT_EQ(correction.innovations[0].outcome, Outcome::kGated);
  EXPECT_GT(correction.innovations[0].nis, correction.innovations[0].gate);
  EXPECT_EQ(correction.innovations[0].dof, 2);
  EXPECT_EQ(filter.pose().T_world_robot, before.T_world_robot);
  EXPECT_EQ(filter.pose().covariance, before.covariance);
  EXPECT_EQ(filter.snapshot().landmarks[4].observations, landmark_before.observations);
}

TEST(FastSlam, GatesAnObservationInTheOppositeDirection) {
  CircleWorld world(6);
  FastSlam filter({}, world.sensor());
  drive_named(filter, world, 50);
  // For some particles the innovation is just below pi, for others just above -pi: they must not cancel.
  for (int landmark = 0; landmark < 4; ++landmark) {
    Observation reversed = world.sight(landmark);
    auto& z = std::get<RangeBearing>(reversed.value);
    z.bearing_rad = wrap_angle(z.bearing_rad + kPi);
    EXPECT_EQ(filter.correct({&reversed, 1}).innovations[0].outcome, Outcome::kGated);
  }
}

TEST(FastSlam, MisreadIdentitiesDoNotRuinARun) {
  constexpr int kSteps = 300;
  constexpr int kRuns = 20;
  double error_m = 0.0;
  for (std::uint64_t seed = 0; seed < kRuns; ++seed) {
    CircleWorld world(seed);
    RandomStream misreads(seed, StreamPurpose::kWorld);
    FastSlam filter({.seed = seed}, world.sensor());
    for (int i = 0; i < kSteps; ++i) {
      filter.predict(world.move());
      auto scan = world.look();
      if (i > 5 && misreads.uniform() < 0.2) std::swap(scan[1].id, scan[6].id);
      filter.correct(scan);
    }
    error_m += position_error_m(filter, world) / kRuns;
  }
  EXPECT_LT(error_m, 0.15);
}

TEST(FastSlam, ALostSetAcceptsAgainInsteadOfGatingForEver) {
  CircleWorld world(7);
  FastSlam filter({}, world.sensor());
  drive_named(filter, world, 50);
  filter.predict({{2.0, 1.0, 0.5}, 1e-6 * Eigen::Matrix3d::Identity()});  // pushed, and sure of it
  filter.correct(world.look());
  int matched = 0;
  for (int i = 0; i < 50; ++i) {
    filter.predict(world.move());
    matched = filter.correct(world.look()).count(Outcome::kMatched);
  }
  EXPECT_GT(matched, 0);
  EXPECT_TRUE(filter.pose().covariance.allFinite());
}

TEST(FastSlam, AnAbsurdObservationThatIsNotGatedLeavesTheSetAlive) {
  CircleWorld world(8);
  FastSlam filter({.gate = {.probability = 1.0}}, world.sensor());
  drive_named(filter, world, 20);
  Observation absurd = world.sight(0);
  absurd.value = RangeBearing{1e200, 0.0};
  EXPECT_EQ(filter.correct({&absurd, 1}).innovations[0].outcome, Outcome::kUnusable);
  absurd.value = RangeBearing{1e6, 0.0};
  EXPECT_EQ(filter.correct({&absurd, 1}).innovations[0].outcome, Outcome::kMatched);
  drive_named(filter, world, 5);
  EXPECT_TRUE(filter.pose().covariance.allFinite());
  double total = 0.0;
  for (const double weight : filter.particles().weights()) total += weight;
  EXPECT_NEAR(total, 1.0, 1e-9);
}

/// Where the gate lets all pass: what no float can tell is not used, what one can just tell does no harm.
TEST(FastSlam, RecoversFromLikelihoodsThatNoParticleCanHave) {
  for (const ProposalKind proposal : {ProposalKind::kMotion, ProposalKind::kObservations})
    for (const double range_m : {1e10, 1e20, 1e38}) {
      CircleWorld world(9);
      FastSlamOptions options;
      options.proposal = proposal;
      options.information_distance_m = 0.0;
      options.gate = {.probability = 1.0};
      FastSlam filter(options, world.sensor());
      drive_named(filter, world, 20);
      filter.predict(world.move());
      Observation absurd = world.sight(0);
      absurd.value = RangeBearing{range_m, 0.0};
      const Outcome outcome = filter.correct({&absurd, 1}).innovations[0].outcome;
      EXPECT_EQ(outcome, range_m < 1e30 ? Outcome::kMatched : Outcome::kUnusable);
      drive_named(filter, world, 50);
      EXPECT_TRUE(filter.pose().covariance.allFinite());
      EXPECT_LT(position_error_m(filter, world), 0.5) << range_m;
      double total = 0.0;
      for (const double weight : filter.particles().weights()) total += weight;
      EXPECT_NEAR(total, 1.0, 1e-9);
    }
}

TEST(FastSlam, StartsFromTheGivenBelief) {
  const PoseEstimate start{{3.0, -2.0, 1.0}, Eigen::Vector3d(0.04, 0.01, 0.01).asDiagonal()};
  FastSlamOptions options = with_particles(20'000);
  options.initial = start;
  const FastSlam filter(options, {});
  EXPECT_EQ(filter.pose().T_world_robot, start.T_world_robot);
  fastslam::ParticleBlocks blocks(20'000);
  const PoseEstimate cloud = fastslam::estimate(filter.particles(), blocks);
  EXPECT_TRUE(
      matrix_near(difference(cloud.T_world_robot, start.T_world_robot), Eigen::Vector3d::Zero(), 0.007));
  EXPECT_TRUE(matrix_near(cloud.covariance, start.covariance, 0.002));
}

TEST(FastSlam, TellsHowLikelyAnObservationWas) {
  CircleWorld world(4);
  FastSlam filter(with_particles(1), world.sensor());
  const Observation first = world.sight(0);
  filter.correct({&first, 1});
  Observation seen = world.sight(0);
  const auto landmark = filter.snapshot().landmarks[0];
  const auto h = RangeBearingModel::linearize({}, world.mount(), landmark.position_m.head<2>());
  const Eigen::Matrix2d S =
      h.H_landmark * landmark.covariance.topLeftCorner<2, 2>() * h.H_landmark.transpose() + *seen.covariance;
  const auto& z = std::get<RangeBearing>(seen.value);
  const Eigen::Vector2d nu = RangeBearingModel::innovation(z, h.predicted);
  const double plain = -0.5 * (nu.dot(S.inverse() * nu) + std::log((2.0 * kPi * S).determinant()));
  const Innovation told = filter.correct({&seen, 1}).innovations[0];
  EXPECT_EQ(told.outcome, Outcome::kMatched);
  EXPECT_NEAR(told.log_density, plain, 1e-3);  // particles are single precision
}

/// However landmarks are seen.
class FastSlamSeeing : public testing::TestWithParam<Seen> {};

std::string name_of(const testing::TestParamInfo<Seen>& each) {
  if (each.param == Seen::kRangeAndBearing) return "RangeAndBearing";
  return each.param == Seen::kRange ? "Range" : "Bearing";
}

INSTANTIATE_TEST_SUITE_P(Each, FastSlamSeeing,
                         testing::Values(Seen::kRangeAndBearing, Seen::kRange, Seen::kBearing), name_of);

TEST_P(FastSlamSeeing, SameSeedSameBitsOnAnyNumberOfThreads) {
  const auto final_map = [](std::uint64_t seed, int threads) {
    CircleWorld world(1);
    FastSlam filter(seeded(with_particles(700), seed), world.sensor(), threads);
    drive_named(filter, world, 60, GetParam());
    EXPECT_GT(filter.resamplings(), 0);
    return filter.save();
  };
  const MapState one = final_map(5, 1);
  const MapState two = final_map(5, 2);
  const MapState other_seed = final_map(6, 1);
  EXPECT_EQ(one.T_world_robot, two.T_world_robot);
  EXPECT_EQ(one.landmarks, two.landmarks);
  EXPECT_EQ(one.covariance, two.covariance);
  EXPECT_NE(one.T_world_robot, other_seed.T_world_robot);
}

/// Whether what it sees brings no information, or all counts in full so that there is something to resample.
TEST_P(FastSlamSeeing, AStandingRobotIsNeitherMovedNorResampled) {
  for (const double information_distance_m : {1.0, 0.0}) {
    CircleWorld world(4);
    FastSlamOptions options;
    options.information_distance_m = information_distance_m;
    FastSlam filter(options, world.sensor());
    drive_named(filter, world, 20, GetParam());
    const auto resamplings = filter.resamplings();
    const std::vector<Pose2> poses = poses_of(filter);
    for (int i = 0; i < 200; ++i) {
      filter.predict({});
      filter.correct(keep(GetParam(), world.look()));
    }
    EXPECT_EQ(filter.resamplings(), resamplings);
    EXPECT_TRUE(poses_of(filter) == poses);
    drive_named(filter, world, 100, GetParam());
    EXPECT_GT(filter.resamplings(), resamplings);
  }
}

TEST_P(FastSlamSeeing, ASteadyStateStepAllocatesNothing) {
  CircleWorld world(12);
  FastSlam filter(with_particles(600), world.sensor(), 2);
  drive_named(filter, world, 5, GetParam());
  std::vector<std::pair<Motion, std::vector<Observation>>> steps;
  for (int i = 0; i < 100; ++i) {
    const Motion motion = world.move();
    steps.emplace_back(motion, keep(GetParam(), world.look()));
  }
  const auto resamplings = filter.resamplings();
  const test::AllocationCount count;
  for (const auto& [motion, scan] : steps) {
    filter.predict(motion);
    filter.correct(scan);
    (void)filter.pose();
  }
  EXPECT_EQ(count.allocations(), 0);
  EXPECT_GT(filter.resamplings(), resamplings);
}

/// Errors of landmarks that a sensor with a field of view sees by their range alone, if it is told how often
/// it reports what is there.
std::vector<double> errors_m_knowing(double detection_probability, std::uint64_t seed) {
  CircleWorld world(seed);
  RandomStream misses(seed, StreamPurpose::kWorld);
  LandmarkSensor sensor = world.sensor();
  sensor.max_range_m = 7.0;
  sensor.field_of_view_deg = 90.0;
  sensor.detection_probability = detection_probability;
  FastSlam filter(seeded(with_particles(100), seed), sensor);
  for (int i = 0; i < 120; ++i) {
    filter.predict(world.move());
    std::vector<Observation> scan;
    for (const Observation& observation : world.look()) {
      const auto& p_world = world.landmarks()[static_cast<std::size_t>(observation.id->number)];
      const Pose2 T_world_sensor = world.truth() * world.mount();
      if (is_in_view(sensor, T_world_sensor.inverse() * p_world) && misses.uniform() < 0.95)
        scan.push_back(keep(Seen::kRange, observation));
    }
    filter.correct(scan);
  }
  std::vector<double> errors_m;
  for (const auto& landmark : filter.snapshot().landmarks) {
    const auto& truth = world.landmarks()[static_cast<std::size_t>(landmark.id.number)];
    errors_m.push_back((landmark.position_m.head<2>() - truth).norm());
  }
  return errors_m;
}

TEST(FastSlam, WhatASensorDoesNotReportTellsWhereLandmarksAre) {
  constexpr std::uint64_t kRuns = 12;
  const auto mean_error_m = [](double detection_probability) {
    std::vector<double> errors_m;
    for (std::uint64_t seed = 0; seed < kRuns; ++seed)
      std::ranges::copy(errors_m_knowing(detection_probability, seed), std::back_inserter(errors_m));
    return std::accumulate(errors_m.begin(), errors_m.end(), 0.0) / static_cast<double>(errors_m.size());
  };
  EXPECT_LT(mean_error_m(0.95), 0.85 * mean_error_m(0.0));
}

TEST(FastSlam, FindsOutWhatAllRangesHaveInCommon) {
  constexpr std::uint64_t kRuns = 5;
  constexpr double kScale = 1.08;
  double error = 0.0;
  for (std::uint64_t seed = 0; seed < kRuns; ++seed) {
    CircleWorld world(seed);
    LandmarkSensor sensor = world.sensor();
    sensor.errors.shared_range_sigma_ratio = 0.1;
    FastSlam filter(seeded(with_particles(200), seed), sensor);
    for (int i = 0; i < 200; ++i) {
      filter.predict(world.move());
      std::vector<Observation> scan = world.look();
      for (Observation& observation : scan) std::get<RangeBearing>(observation.value).range_m *= kScale;
      filter.correct(scan);
    }
    const auto scale = filter.range_calibration().scale(filter.particles().weights());
    error += std::abs(scale.mean - kScale) / kRuns;
    EXPECT_LT(scale.sigma, 0.03) << seed;
  }
  // A quarter of what it was before anything was seen.
  EXPECT_LT(error, 0.25 * (kScale - 1.0));
}

/// Mean error of a landmark on a ring after twelve steps, if it is missed at some of them.
double error_m_when_missing(std::initializer_list<int> missed) {
  constexpr std::uint64_t kRuns = 20;
  double error_m = 0.0;
  for (std::uint64_t seed = 0; seed < kRuns; ++seed) {
    CircleWorld world(seed);
    LandmarkSensor sensor = world.sensor();
    sensor.field_of_view_deg = 350.0;
    sensor.detection_probability = 0.95;  // gone after three scans
    FastSlam filter(seeded(with_particles(100), seed), sensor);
    for (int i = 0; i < 12; ++i) {
      filter.predict(world.move());
      auto scan = keep(Seen::kRange, world.look());
      if (std::ranges::count(missed, i) > 0) scan.erase(scan.begin());
      filter.correct(scan);
    }
    for (const auto& landmark : filter.snapshot().landmarks)
      if (landmark.id.number == 0)
        error_m += (landmark.position_m.head<2>() - world.landmarks()[0]).norm() / kRuns;
  }
  return error_m;
}

/// Seen again at the very scan at which it would have gone, it has not gone by an edge.
TEST(FastSlam, ALandmarkThatComesBackInTimeHasNotLeftTheView) {
  const double seen_m = error_m_when_missing({});
  const double missed_m = error_m_when_missing({9, 10});
  EXPECT_LT(missed_m, 1.2 * seen_m);
}

TEST(FastSlam, ObservationsWithoutCovarianceHaveTheNoiseOfTheSensor) {
  CircleWorld world(23);
  const LandmarkSensor sensor = world.sensor();
  FastSlam told({}, sensor), silent({}, sensor);
  test::expect_the_noise_of_the_sensor(told, silent, world, sensor);
}

}  // namespace
}  // namespace waymark
