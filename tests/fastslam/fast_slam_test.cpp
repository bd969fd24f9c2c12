#include "waymark/fastslam/fast_slam.hpp"

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "support/allocation_counter.hpp"
#include "support/circle_world.hpp"
#include "support/matrix_near.hpp"
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

void drive(FastSlam& filter, CircleWorld& world, int steps) {
  for (int i = 0; i < steps; ++i) {
    filter.predict(world.move());
    filter.correct(world.look());
  }
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
double effective_after_drive(std::uint64_t seed, bool watching) {
  test::CircleWorld world(seed);
  FastSlamOptions options = with_particles(50);
  options.resample_below = 0.0;
  options.temper_below = 0.0;
  FastSlam filter(options, {}, world.sensor(), seed);
  const Observation first = world.sight(0);
  filter.correct({&first, 1});
  for (int i = 0; i < 100; ++i) {
    filter.predict(world.move());
    const Observation again = world.sight(0);
    if (watching || i == 99) filter.correct({&again, 1});
  }
  return fastslam::effective_particles(filter.particles().weights());
}

TEST(FastSlam, ALandmarkUnderWatchHardlyWeighsParticlesAndOneThatComesBackDoes) {
  double watching = 0.0;
  double returning = 0.0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    watching += effective_after_drive(seed, true);
    returning += effective_after_drive(seed, false);
  }
  EXPECT_GT(watching, 1.5 * returning);
}

TEST(FastSlam, FollowsTheTruthWhereDeadReckoningDoesNot) {
  constexpr int kSteps = 400;
  constexpr int kRuns = 20;
  double error_m = 0.0;
  double blind_m = 0.0;
  double landmark_error_m = 0.0;
  for (std::uint64_t seed = 0; seed < kRuns; ++seed) {
    CircleWorld world(seed);
    FastSlam filter({}, {}, world.sensor(), seed);
    drive(filter, world, kSteps);
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

TEST(FastSlam, SameSeedSameBitsOnAnyNumberOfThreads) {
  const auto final_map = [](std::uint64_t seed, int threads) {
    CircleWorld world(1);
    FastSlam filter(with_particles(700), {}, world.sensor(), seed, threads);
    drive(filter, world, 60);
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

TEST(FastSlam, AddsEachLandmarkOnceAndCountsItsSightings) {
  CircleWorld world(1);
  FastSlam filter({}, {}, world.sensor(), 1);
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
  options.evidence_way_m = 0.0;
  FastSlam filter(options, {}, world.sensor(), 3);
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

TEST(FastSlam, PoseFollowsTheMotionBetweenSightings) {
  CircleWorld world(3);
  FastSlam filter({}, {}, world.sensor(), 1);
  drive(filter, world, 20);
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
  FastSlam filter(with_particles(5000), {}, {}, 1);
  for (int i = 0; i < kSteps; ++i) filter.predict(step);
  double mean_x_m = 0.0;
  for (int i = 0; i < kSteps; ++i)
    mean_x_m += 0.1 * std::exp(-0.5 * 0.0012 * i);  // E cos of a Gaussian heading
  ASSERT_LT(mean_x_m, 27.6);
  EXPECT_NEAR(filter.pose().T_world_robot.x_m, mean_x_m, 0.2);
}

TEST(FastSlam, AStandingRobotIsNeitherMovedNorResampled) {
  CircleWorld world(4);
  FastSlamOptions options;
  options.evidence_way_m = 0.0;  // every sighting counts, so that there is something to resample
  FastSlam filter(options, {}, world.sensor(), 1);
  drive(filter, world, 20);
  const auto resamplings = filter.resamplings();
  const double x_m = filter.particles().pose(7).x_m;
  for (int i = 0; i < 200; ++i) {
    filter.predict({});
    filter.correct(world.look());
  }
  EXPECT_EQ(filter.resamplings(), resamplings);
  EXPECT_EQ(filter.particles().pose(7).x_m, x_m);
  drive(filter, world, 20);
  EXPECT_GT(filter.resamplings(), resamplings);
}

TEST(FastSlam, RefusesWhatItCannotUseAndSaysWhy) {
  CircleWorld world(5);
  FastSlamOptions options;
  options.capacity = 8;
  FastSlam filter(options, {}, world.sensor(), 1);
  drive(filter, world, 10);
  std::vector<Observation> scan(7, world.sight(0));
  scan[0].value = RangeBearing{kNan, 0.0};
  scan[1].id.reset();
  scan[2].value = Pixel{1.0, 1.0};
  scan[3].covariance.reset();
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
  FastSlam filter({}, {}, {}, 1);
  filter.predict({{1.0, 0.0, 0.0}, 1e-4 * Eigen::Matrix3d::Identity()});
  filter.predict({{kNan, 0.0, 0.0}, Eigen::Matrix3d::Identity()});
  filter.predict({{0.0, 0.0, 0.0}, kNan * Eigen::Matrix3d::Identity()});
  EXPECT_EQ(filter.pose().T_world_robot, (Pose2{1.0, 0.0, 0.0}));
}

TEST(FastSlam, AMisreadIdentityIsGatedAndChangesNothing) {
  CircleWorld world(6);
  FastSlam filter({}, {}, world.sensor(), 1);
  drive(filter, world, 50);
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

TEST(FastSlam, GatesASightingInTheOppositeDirection) {
  CircleWorld world(6);
  FastSlam filter({}, {}, world.sensor(), 1);
  drive(filter, world, 50);
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
    FastSlam filter({}, {}, world.sensor(), seed);
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
  FastSlam filter({}, {}, world.sensor(), 1);
  drive(filter, world, 50);
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
  FastSlam filter({}, {.probability = 1.0}, world.sensor(), 1);
  drive(filter, world, 20);
  Observation absurd = world.sight(0);
  absurd.value = RangeBearing{1e200, 0.0};
  EXPECT_EQ(filter.correct({&absurd, 1}).innovations[0].outcome, Outcome::kUnusable);
  absurd.value = RangeBearing{1e6, 0.0};
  EXPECT_EQ(filter.correct({&absurd, 1}).innovations[0].outcome, Outcome::kMatched);
  drive(filter, world, 5);
  EXPECT_TRUE(filter.pose().covariance.allFinite());
  double total = 0.0;
  for (const double weight : filter.particles().weights()) total += weight;
  EXPECT_NEAR(total, 1.0, 1e-9);
}

TEST(FastSlam, StartsFromTheGivenBelief) {
  const PoseEstimate start{{3.0, -2.0, 1.0}, Eigen::Vector3d(0.04, 0.01, 0.01).asDiagonal()};
  const FastSlam filter(with_particles(20'000), {}, {}, 1, 1, start);
  EXPECT_EQ(filter.pose().T_world_robot, start.T_world_robot);
  fastslam::ParticleBlocks blocks(20'000);
  const PoseEstimate cloud = fastslam::estimate(filter.particles(), blocks);
  EXPECT_TRUE(
      matrix_near(difference(cloud.T_world_robot, start.T_world_robot), Eigen::Vector3d::Zero(), 0.007));
  EXPECT_TRUE(matrix_near(cloud.covariance, start.covariance, 0.002));
}

TEST(FastSlam, SnapshotAndSaveAreTheMomentsOfTheMixture) {
  CircleWorld world(10);
  FastSlamOptions options = with_particles(60);
  options.resample_below = 0.0;  // so that weights differ, and pose() is of these very particles
  FastSlam filter(options, {}, world.sensor(), 1);
  drive(filter, world, 10);
  const Snapshot snapshot = filter.snapshot();
  const MapState map = filter.save();
  ASSERT_EQ(map.ids.size(), 8U);
  ASSERT_TRUE(is_covariance(map.covariance));
  EXPECT_TRUE(matrix_near(map.covariance.topLeftCorner<3, 3>(), filter.pose().covariance, 1e-12));
  for (int k = 0; k < 8; ++k) {
    const auto& landmark = snapshot.landmarks[static_cast<std::size_t>(k)];
    EXPECT_TRUE(matrix_near(map.landmarks.segment<2>(2 * k), landmark.position_m.head<2>(), 1e-12));
    EXPECT_TRUE(matrix_near(map.covariance.block<2, 2>(3 + 2 * k, 3 + 2 * k),
                            landmark.covariance.topLeftCorner<2, 2>(), 1e-12));
  }
  // Landmarks move with the pose that they were seen from: the cross terms are not nothing.
  EXPECT_GT(map.covariance.topRightCorner(3, 16).cwiseAbs().maxCoeff(), 1e-6);
}

TEST(FastSlam, SaveFollowsAMotionThatNoParticleHasMade) {
  CircleWorld world(11);
  FastSlamOptions options;
  options.resample_below = 0.0;
  FastSlam filter(options, {}, world.sensor(), 1);
  drive(filter, world, 10);
  const Eigen::MatrixXd before = filter.save().covariance;
  filter.predict({{1.0, 0.0, 0.3}, 1e-6 * Eigen::Matrix3d::Identity()});
  const MapState map = filter.save();
  EXPECT_TRUE(matrix_near(map.covariance.topLeftCorner<3, 3>(), filter.pose().covariance, 1e-12));
  EXPECT_TRUE(matrix_near(map.covariance.bottomRightCorner(16, 16), before.bottomRightCorner(16, 16), 0.0));
  EXPECT_TRUE(matrix_near(map.covariance.block(2, 3, 1, 16), before.block(2, 3, 1, 16), 0.0));
  EXPECT_EQ(map.T_world_robot, filter.pose().T_world_robot);
}

TEST(FastSlam, ASteadyStateStepAllocatesNothing) {
  CircleWorld world(12);
  FastSlam filter(with_particles(600), {}, world.sensor(), 1, 2);
  drive(filter, world, 5);
  std::vector<std::pair<Motion, std::vector<Observation>>> steps;
  for (int i = 0; i < 50; ++i) {
    const Motion motion = world.move();
    steps.emplace_back(motion, world.look());
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

TEST(FastSlam, OptionsAreDescribedWithTheirDefaults) {
  FastSlamOptions options;
  Schema schema;
  describe(schema, options);
  EXPECT_TRUE(schema.set("fastslam.particles", "400", "--set").ok());
  EXPECT_EQ(options.particles, 400);
  EXPECT_FALSE(schema.set("fastslam.particles", "0", "--set").ok());
  EXPECT_FALSE(schema.set("fastslam.resample_below", "1.5", "--set").ok());
}

}  // namespace
}  // namespace waymark
