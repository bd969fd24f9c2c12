#include "waymark/ekf/ekf_slam.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "support/allocation_counter.hpp"
#include "support/circle_world.hpp"
#include "support/matrix_near.hpp"
#include "support/missing_covariances.hpp"
#include "waymark/core/chi2.hpp"
#include "waymark/core/gaussian.hpp"
#include "waymark/core/random.hpp"

namespace waymark {
namespace {

using test::CircleWorld;

EkfSlam make(const CircleWorld& world, int capacity = 20) {
  return EkfSlam({ekf::Consistency::kInvariant, capacity}, world.sensor());
}

void drive(EkfSlam& filter, CircleWorld& world, int steps) {
  for (int i = 0; i < steps; ++i) {
    filter.predict(world.move());
    filter.correct(world.look());
  }
}

TEST(EkfSlam, FollowsTheTruthWithinItsOwnUncertainty) {
  const double nees = test::mean_pose_nees([](CircleWorld& world) {
    EkfSlam filter = make(world);
    drive(filter, world, 200);
    return filter.pose();
  });
  EXPECT_GT(nees, test::kMinMeanNees);
  EXPECT_LT(nees, test::kMaxMeanNees);
}

TEST(EkfSlam, AddsEachLandmarkOnceAndCountsItsObservations) {
  CircleWorld world(1);
  EkfSlam filter = make(world);
  EXPECT_EQ(filter.correct(world.look()).count(Outcome::kAdded), 8);
  EXPECT_EQ(filter.correct(world.look()).count(Outcome::kMatched), 8);
  const auto landmarks = filter.snapshot().landmarks;
  ASSERT_EQ(landmarks.size(), 8U);
  for (const auto& landmark : landmarks) EXPECT_EQ(landmark.observations, 2);
}

TEST(EkfSlam, AMisreadIdentityIsGatedAndChangesNothing) {
  CircleWorld world(2);
  EkfSlam filter = make(world);
  drive(filter, world, 50);
  const auto before = filter.pose();
  Observation misread = world.sight(0);
  misread.id->number = 4;
  const auto& correction = filter.correct({&misread, 1});
  EXPECT_EQ(correction.innovations[0].outcome, Outcome::kGated);
  EXPECT_GT(correction.innovations[0].nis, correction.innovations[0].gate);
  EXPECT_EQ(filter.pose().T_world_robot, before.T_world_robot);
}

/// Whatever is measured, from the whole belief with plain matrices.
template <class Model>
double plain_log_density(const EkfSlam& filter, const Pose2& mount, int landmark, const Observation& seen,
                         const typename Model::Value& z) {
  const MapState map = filter.save();
  const auto h = Model::linearize(map.T_world_robot, mount, map.landmarks.segment<2>(2 * landmark));
  Eigen::Matrix<double, Model::kDim, Eigen::Dynamic> H =
      Eigen::MatrixXd::Zero(Model::kDim, map.covariance.cols());
  H.leftCols(3) = h.H_pose;
  H.middleCols(3 + 2 * landmark, 2) = h.H_landmark;
  const Eigen::Matrix<double, Model::kDim, Model::kDim> S =
      H * map.covariance * H.transpose() +
      seen.covariance.value().template topLeftCorner<Model::kDim, Model::kDim>();
  const Eigen::Matrix<double, Model::kDim, 1> nu = Model::innovation(z, h.predicted);
  return -0.5 * (nu.dot(S.inverse() * nu) + std::log((2.0 * kPi * S).determinant()));
}

TEST(EkfSlam, TellsHowLikelyAnObservationWas) {
  CircleWorld world(4);
  EkfSlam filter({ekf::Consistency::kStandard, 20}, world.sensor());
  drive(filter, world, 30);
  for (const int sighted : {0, 3}) {  // the landmark that it says it is of, and another: gated
    Observation seen = world.sight(sighted);
    seen.id->number = 0;
    const auto z = std::get<RangeBearing>(seen.value);
    const double both = plain_log_density<RangeBearingModel>(filter, world.mount(), 0, seen, z);
    EXPECT_NEAR(filter.correct({&seen, 1}).innovations[0].log_density, both, 1e-6 * std::abs(both));
    seen.value = Range{z.range_m};
    const double range = plain_log_density<RangeModel>(filter, world.mount(), 0, seen, {z.range_m});
    EXPECT_NEAR(filter.correct({&seen, 1}).innovations[0].log_density, range, 1e-6 * std::abs(range));
  }
}

TEST(EkfSlam, RefusesWhatItCannotUseAndSaysWhy) {
  CircleWorld world(3);
  EkfSlam filter = make(world, 8);
  drive(filter, world, 10);
  std::vector<Observation> scan(5, world.sight(0));
  scan[0].value = RangeBearing{std::numeric_limits<double>::quiet_NaN(), 0.0};
  scan[1].id.reset();
  scan[2].value = Pixel{1.0, 2.0};
  scan[3].covariance = Eigen::Matrix2d::Constant(std::numeric_limits<double>::quiet_NaN());
  scan.push_back(world.sight(0));
  const auto& correction = filter.correct(scan);
  const std::vector<Outcome> expected{Outcome::kUnusable, Outcome::kUnidentified, Outcome::kUnusable,
                                      Outcome::kUnusable, Outcome::kMatched,      Outcome::kDuplicate};
  for (std::size_t i = 0; i < expected.size(); ++i)
    EXPECT_EQ(correction.innovations[i].outcome, expected[i]) << i;
  EXPECT_TRUE(filter.pose().covariance.allFinite());
}

TEST(EkfSlam, AScanLargerThanABlockIsUsedWhole) {
  EkfSlam filter({ekf::Consistency::kInvariant, 100}, {});
  std::vector<Observation> scan;
  for (int i = 0; i < 80; ++i)
    scan.push_back({LandmarkId{LandmarkId::Family::kMarker, i}, RangeBearing{2.0 + 0.1 * i, 0.05 * i},
                    Eigen::Matrix2d(1e-4 * Eigen::Matrix2d::Identity())});
  EXPECT_EQ(filter.correct(scan).count(Outcome::kAdded), 80);
  filter.predict({{0.01, 0.0, 0.0}, 1e-4 * Eigen::Matrix3d::Identity()});
  EXPECT_EQ(filter.correct(scan).count(Outcome::kMatched), 80);
}

TEST(EkfSlam, AFullMapGivesItsLeastUsefulLandmarkForANewOne) {
  CircleWorld world(6);
  EkfSlam filter = make(world, 8);
  drive(filter, world, 20);
  Observation unseen = world.sight(3);
  unseen.id->number = 99;
  const auto& correction = filter.correct({&unseen, 1});
  EXPECT_EQ(correction.innovations[0].outcome, Outcome::kAdded);
  ASSERT_EQ(correction.removed.size(), 1U);
  const auto evicted = correction.removed[0];
  EXPECT_NE(evicted, *unseen.id);
  EXPECT_EQ(filter.state().landmarks(), 8);
  for (const auto& landmark : filter.snapshot().landmarks) EXPECT_NE(landmark.id, evicted);
  EXPECT_TRUE(filter.correct({}).removed.empty());
  // What is left still belongs together: all but the evicted one are found where they are.
  filter.predict(world.move());
  const auto scan = world.look();
  EXPECT_GE(filter.correct(scan).count(Outcome::kMatched), 6);
}

TEST(EkfSlam, AScanOfMoreNewLandmarksThanFitKeepsTheFirstOfThem) {
  CircleWorld world(7);
  EkfSlam filter = make(world, 3);
  const auto& correction = filter.correct(world.look());
  EXPECT_EQ(correction.count(Outcome::kAdded), 3);
  EXPECT_EQ(correction.count(Outcome::kMapFull), 5);
  EXPECT_TRUE(correction.removed.empty());
}

TEST(EkfSlam, CompressedItEstimatesTheSame) {
  EkfSlam whole({.consistency = ekf::Consistency::kFej, .capacity = 150, .compressed = Compress::kNever}, {});
  EkfSlam compressed(
      {.consistency = ekf::Consistency::kFej, .capacity = 150, .compressed = Compress::kAlways, .submap = 48},
      {});
  const auto observe = [](int landmark, double range_m) {
    return Observation{LandmarkId{LandmarkId::Family::kMarker, landmark},
                       RangeBearing{range_m, 0.04 * landmark},
                       Eigen::Matrix2d(1e-3 * Eigen::Matrix2d::Identity())};
  };
  RandomStream random(6, StreamPurpose::kSimulation);
  for (int step = 0; step < 200; ++step) {  // sweeps over 150 landmarks on a spiral, ten at a time
    std::vector<Observation> scan;
    for (int i = 0; i < 10; ++i) {
      const int landmark = (4 * step + i) % 150;
      scan.push_back(observe(landmark, 3.0 + 0.1 * landmark + 0.03 * random.normal()));
    }
    for (EkfSlam* filter : {&whole, &compressed}) {
      filter->predict({{0.0, 0.0, 0.0}, 1e-4 * Eigen::Matrix3d::Identity()});
      const auto& correction = filter->correct(scan);
      EXPECT_EQ(correction.count(Outcome::kMatched) + correction.count(Outcome::kAdded), 10) << step;
    }
  }
  EXPECT_GT(compressed.state().closed_submaps(), 5);
  const MapState a = whole.save();
  const MapState b = compressed.save();
  EXPECT_EQ(a.ids, b.ids);
  EXPECT_TRUE(test::matrix_near(a.landmarks, b.landmarks, 1e-9));
  EXPECT_TRUE(test::matrix_near(a.covariance, b.covariance, 1e-9));
}

TEST(EkfSlam, ASteadyStateStepAllocatesNothing) {
  CircleWorld world(4);
  EkfSlam filter = make(world);
  drive(filter, world, 5);
  std::vector<std::pair<Motion, Observations>> steps;
  for (int i = 0; i < 10; ++i) {
    const Motion motion = world.move();
    steps.emplace_back(motion, world.look());
  }
  const test::AllocationCount count;
  for (const auto& [motion, scan] : steps) {
    filter.predict(motion);
    filter.correct(scan);
    (void)filter.pose();
  }
  EXPECT_EQ(count.allocations(), 0);
}

TEST(EkfSlam, SavesTheWholeBelief) {
  CircleWorld world(5);
  EkfSlam filter = make(world);
  drive(filter, world, 20);
  const MapState map = filter.save();
  ASSERT_EQ(map.ids.size(), 8U);
  EXPECT_EQ(map.landmarks.size(), 16);
  EXPECT_EQ(map.covariance, filter.state().covariance());
  EXPECT_TRUE(is_covariance(map.covariance));
}

/// A filter that knows where three landmarks are, and then loses most of its sense of where it is itself.
class LargeInnovation : public testing::Test {
 protected:
  static constexpr int kLandmarks = 3;

  [[nodiscard]] static Pose2 surprised(EkfOptions options) {
    options.gate = {1.0};
    EkfSlam filter(options, {});
    std::vector<Observation> first;
    for (int i = 0; i < kLandmarks; ++i) first.push_back(observe(i, {}, 1e-4));
    filter.correct(first);
    filter.predict({{}, prior().asDiagonal()});
    std::vector<Observation> then;
    for (int i = 0; i < kLandmarks; ++i) then.push_back(observe(i, truth(), kSigma));
    filter.correct(then);
    return filter.pose().T_world_robot;
  }

  /// Minus twice the log posterior of a pose; the landmarks are as good as known.
  [[nodiscard]] static double cost(const Pose2& pose) {
    const Eigen::Vector3d e = difference(pose, Pose2{});
    double cost = e.dot(e.cwiseQuotient(prior()));
    for (int i = 0; i < kLandmarks; ++i) {
      const auto z = std::get<RangeBearing>(observe(i, truth(), kSigma).value);
      const auto h = std::get<RangeBearing>(observe(i, pose, kSigma).value);
      cost += (std::pow(z.range_m - h.range_m, 2) + std::pow(wrap_angle(z.bearing_rad - h.bearing_rad), 2)) /
              (kSigma * kSigma);
    }
    return cost;
  }

  [[nodiscard]] static Observation observe(int number, const Pose2& pose, double sigma) {
    const Eigen::Vector2d places[kLandmarks] = {{3.0, 1.0}, {2.0, -2.0}, {-1.0, 3.0}};
    const Eigen::Vector2d p = pose.inverse() * places[number];
    Observation observation{LandmarkId{LandmarkId::Family::kMarker, number},
                            RangeBearing{p.norm(), std::atan2(p.y(), p.x())},
                            {}};
    observation.covariance = sigma * sigma * Eigen::Matrix2d::Identity();
    return observation;
  }

  static Pose2 truth() { return {0.6, -0.5, 0.7}; }
  static Eigen::Vector3d prior() { return {0.25, 0.25, 0.25}; }
  static constexpr double kSigma = 0.02;
};

TEST_F(LargeInnovation, IsFollowedToTheMostProbablePose) {
  const Pose2 plain = surprised({.consistency = ekf::Consistency::kStandard, .iterations = 0});
  const Pose2 iterated = surprised({.consistency = ekf::Consistency::kStandard, .iterations = 20});
  const double best = cost(iterated);
  EXPECT_GT(cost(plain), best + 10.0) << "a linear step falls short";
  constexpr double kStep = 0.02;  // a noise's standard deviation
  for (const Pose2& aside : {Pose2{kStep, 0.0, 0.0}, Pose2{-kStep, 0.0, 0.0}, Pose2{0.0, kStep, 0.0},
                             Pose2{0.0, -kStep, 0.0}, Pose2{0.0, 0.0, kStep}, Pose2{0.0, 0.0, -kStep}})
    EXPECT_GT(cost(iterated * aside), best);
}

TEST_F(LargeInnovation, IsFollowedInTheInvariantFilterToo) {
  const Pose2 pose = surprised({.iterations = 20});
  EXPECT_LT(difference(pose, truth()).norm(), 0.03);
}

TEST(EkfSlam, IteratedUpdatesSeeNoHeadingThatNobodySaw) {
  // Nothing but the start says which way the world lies: that doubt must stay.
  constexpr double kStartVariance = 0.01;
  RandomStream random(21, StreamPurpose::kWorld);
  EkfSlam filter({.iterations = 20, .gate = {1.0}}, {});
  filter.predict({{}, Eigen::Vector3d(0.0, 0.0, kStartVariance).asDiagonal()});
  for (int step = 0; step < 300; ++step) {
    filter.predict({{0.5, 0.0, 0.1}, Eigen::Vector3d(0.04, 0.04, 0.04).asDiagonal()});
    std::vector<Observation> observations;
    for (int i = 0; i < 3; ++i) {
      Observation z{LandmarkId{LandmarkId::Family::kMarker, i},
                    RangeBearing{3.0 + 0.5 * random.normal(), 0.8 * i + 0.3 * random.normal()},
                    {}};
      z.covariance = Eigen::Vector2d(0.01, 0.01).asDiagonal();
      observations.push_back(z);
    }
    filter.correct(observations);
    ASSERT_GT(filter.pose().covariance(2, 2), 0.999 * kStartVariance) << "at step " << step;
  }
}

TEST(EkfSlam, HeavyTailsTakeAnOutlierForWhatItIs) {
  const auto shift = [](ekf::Likelihood likelihood) {
    CircleWorld world(6);
    EkfSlam filter({.likelihood = likelihood, .gate = {1.0}}, world.sensor());
    drive(filter, world, 100);
    auto scan = world.look();
    const Pose2 before = filter.pose().T_world_robot;
    auto& z = std::get<RangeBearing>(scan[0].value);
    z.range_m += 12.0 * std::sqrt((*scan[0].covariance)(0, 0));
    filter.correct(scan);
    return difference(filter.pose().T_world_robot, before).head<2>().norm();
  };
  EXPECT_LT(shift(ekf::Likelihood::kStudent), 0.5 * shift(ekf::Likelihood::kGaussian));
}

TEST(EkfSlam, FindsItselfAgainAfterASlipThatItsOdometryDidNotSee) {
  CircleWorld world(5);
  EkfSlam filter = make(world);
  drive(filter, world, 100);
  world.move();  // of which the filter is not observable
  for (int i = 0; i < 20; ++i) world.move();
  drive(filter, world, 30);
  EXPECT_GT(filter.faults().recoveries(), 0);
  const auto pose = filter.pose();
  EXPECT_LT(*mahalanobis_squared<3>(difference(world.truth(), pose.T_world_robot), pose.covariance),
            chi2_quantile(0.9999, 3));
}

TEST(EkfSlam, KnowsRepeatedObservationsWithABiasForWhatTheyAre) {
  // One landmark, watched from the same place: its error stays, so that after a hundred observations it is as
  // unsure as after one, while the innovations show how alike they are.
  const SensorErrors errors{.bias_range_sigma_ratio = 0.02, .bias_bearing_sigma_deg = 1.0};
  RandomStream random(11, StreamPurpose::kWorld);
  EkfSlam filter({}, {.errors = errors});
  double nis = 0.0;
  constexpr int kObservations = 100;
  Observation observation{LandmarkId{LandmarkId::Family::kMarker, 1}, RangeBearing{}, {}};
  observation.covariance = Eigen::Vector2d(0.03 * 0.03, 0.005 * 0.005).asDiagonal();
  for (int i = 0; i < kObservations; ++i) {
    observation.value = RangeBearing{5.0 + 0.03 * random.normal(), 0.5 + 0.005 * random.normal()};
    nis += filter.correct({&observation, 1}).innovations[0].nis / (2.0 * kObservations);
  }
  const Eigen::Matrix3d P = filter.snapshot().landmarks[0].covariance;
  const double variance = 0.1 * 0.1 + std::pow(5.0 * to_radians(1.0), 2);
  EXPECT_NEAR(P.trace(), variance, 0.05 * variance);
  EXPECT_NEAR(nis, 1.0, 0.33) << "beyond the 99.9 % band of a mean of 200 chi-square variables";
}

TEST(EkfSlam, GoesOnFromASavedMapAsIfItHadNeverStopped) {
  CircleWorld world(11);
  EkfSlam filter = make(world);
  drive(filter, world, 60);
  const MapState saved = filter.save();
  EkfSlam again({.capacity = 20, .loaded = 8}, world.sensor());
  ASSERT_TRUE(again.load(saved));
  EXPECT_EQ(again.save().landmarks, saved.landmarks);
  EXPECT_EQ(again.save().covariance, saved.covariance);
  EXPECT_EQ(again.save().observations, saved.observations);
  for (int i = 0; i < 40; ++i) {
    const Motion motion = world.move();
    const auto scan = world.look();
    for (EkfSlam* each : {&filter, &again}) {
      each->predict(motion);
      each->correct(scan);
    }
  }
  EXPECT_EQ(again.pose().T_world_robot, filter.pose().T_world_robot);
  EXPECT_EQ(again.save().covariance, filter.save().covariance);
}

TEST(EkfSlam, ALoadedMapIsTheFirstSubmapHoweverSmallSubmapsAre) {
  MapState map;
  constexpr int kCount = 300;
  for (int i = 0; i < kCount; ++i) map.ids.push_back({LandmarkId::Family::kMarker, i});
  map.observations.assign(kCount, 2);
  map.landmarks = Eigen::VectorXd::LinSpaced(2 * kCount, -30.0, 30.0);
  map.covariance = 0.01 * Eigen::MatrixXd::Identity(3 + 2 * kCount, 3 + 2 * kCount);
  map.covariance.array() += 0.002;
  EkfSlam filter({.capacity = 1000, .compressed = Compress::kAlways, .submap = 48, .loaded = kCount}, {});
  ASSERT_TRUE(filter.load(map));
  EXPECT_EQ(filter.save().covariance, map.covariance);
  const Observation unknown{LandmarkId{LandmarkId::Family::kMarker, 999}, RangeBearing{2.0, 0.1},
                            Eigen::Matrix2d(0.01 * Eigen::Matrix2d::Identity())};
  EXPECT_EQ(filter.correct({&unknown, 1}).count(Outcome::kAdded), 1);
  EXPECT_GE(filter.state().closed_submaps(), 1);
  const Eigen::MatrixXd known = filter.save().covariance.topLeftCorner(3 + 2 * kCount, 3 + 2 * kCount);
  EXPECT_LT((known - map.covariance).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(EkfSlam, AHeldMapStaysAsItIsAndTakesNothingIn) {
  CircleWorld world(12);
  EkfSlam mapping = make(world);
  drive(mapping, world, 60);
  const MapState saved = mapping.save();
  EkfSlam filter({.consistency = ekf::Consistency::kStandard, .capacity = 8, .loaded = 8}, world.sensor());
  ASSERT_TRUE(filter.load(saved));
  filter.hold_landmarks();
  drive(filter, world, 100);
  Observation unknown = world.sight(0);
  unknown.id->number = 99;
  EXPECT_EQ(filter.correct({&unknown, 1}).count(Outcome::kNotInMap), 1);
  const MapState after = filter.save();
  EXPECT_EQ(after.landmarks, saved.landmarks);
  EXPECT_EQ(after.covariance.bottomRightCorner(16, 16), saved.covariance.bottomRightCorner(16, 16));
  EXPECT_TRUE(is_covariance(after.covariance));
  EXPECT_LT((filter.pose().T_world_robot.position() - world.truth().position()).norm(), 0.3);
}

TEST(EkfSlam, ObservationsWithoutCovarianceHaveTheNoiseOfTheSensor) {
  CircleWorld world(21);
  LandmarkSensor sensor = world.sensor();
  sensor.range_sigma_m = 0.05;
  sensor.bearing_sigma_deg = to_degrees(0.02);
  EkfSlam told({.capacity = 20}, sensor), silent({.capacity = 20}, sensor);
  test::expect_the_noise_of_the_sensor(told, silent, world, sensor);
}

TEST(EkfSlam, AMapThatDoesNotFitChangesNothing) {
  CircleWorld world(22);
  EkfSlam filter = make(world);
  drive(filter, world, 20);
  const MapState saved = filter.save();
  EkfSlam small({.capacity = 3}, world.sensor());
  ASSERT_FALSE(small.load(saved));
  EXPECT_NE(small.load(saved).error().message.find("8 landmarks are more than"), std::string::npos);
  EXPECT_TRUE(small.snapshot().landmarks.empty());
  EXPECT_FALSE(filter.load(saved)) << "it has a map already";
  MapState large;
  large.ids.resize(500);
  large.observations.resize(500);
  large.landmarks = Eigen::VectorXd::Zero(1000);
  large.covariance = Eigen::MatrixXd::Identity(1003, 1003);
  EkfSlam unprepared({.capacity = 1000}, {});
  ASSERT_FALSE(unprepared.load(large));
  EXPECT_NE(unprepared.load(large).error().message.find("EkfOptions::loaded is 0"), std::string::npos);
  EXPECT_TRUE(EkfSlam({.capacity = 1000, .loaded = 500}, {}).load(large));
}

}  // namespace
}  // namespace waymark
