#include "workbench/eval/trajectory_error.hpp"

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "waymark/core/chi2.hpp"

#include "eval/eval_support.hpp"

namespace waymark::eval {
namespace {

using test::moved;
using test::random_pose;
using test::random_stream;
using test::straight_path;
using test::wavy_path;

PosePair make_pair(const Pose2& estimate, Truth truth,
                   std::optional<Eigen::Matrix3d> covariance = std::nullopt) {
  return {Stamp{}, estimate, covariance, truth};
}

TEST(PositionRmse, OfConstructedErrors) {
  const std::vector<PosePair> pairs{make_pair({3, 4, 0}, {0, 0, {}}), make_pair({1, 1, 0}, {1, 1, {}})};
  EXPECT_DOUBLE_EQ(*position_rmse_m(errors(pairs, {})), std::sqrt(25.0 / 2.0));
  EXPECT_DOUBLE_EQ(*position_rmse_m(pairs, Pose2{}), std::sqrt(25.0 / 2.0));
  EXPECT_FALSE(position_rmse_m(std::vector<PosePair>{}, Pose2{}));
}

TEST(PositionRmse, SeriesAndShortFormAgreeUnderAnyMotion) {
  RandomStream random = random_stream(11);
  std::vector<PosePair> pairs;
  for (int i = 0; i < 20; ++i)
    pairs.push_back(make_pair(random_pose(random), {random.normal(), random.normal(), {}}));
  const Pose2 T = random_pose(random);
  EXPECT_NEAR(*position_rmse_m(pairs, T), *position_rmse_m(errors(pairs, T)), 1e-12);
}

TEST(HeadingRmse, WrapsAndSkipsHeadinglessTruth) {
  const std::vector<PosePair> pairs{make_pair({0, 0, 3.1}, {0, 0, -3.1}), make_pair({0, 0, 1.0}, {0, 0, {}})};
  EXPECT_NEAR(*heading_rmse_rad(errors(pairs, {})), 2 * kPi - 6.2, 1e-12);
  EXPECT_FALSE(heading_rmse_rad(errors(std::span(pairs).last(1), {})));
}

TEST(Errors, TurnTheCovarianceWithTheFrame) {
  const Eigen::Matrix3d P = Eigen::Vector3d(0.04, 0.0001, 0.01).asDiagonal();
  const std::vector<PosePair> pairs{make_pair({1, 0, 0}, {0, 1.2, kPi / 2}, P)};
  const auto samples = errors(pairs, {0, 0, kPi / 2});  // the estimate's x is the truth's y
  ASSERT_EQ(samples.size(), 1u);
  EXPECT_NEAR(samples[0].sigma->x(), 0.01, 1e-12);
  EXPECT_NEAR(samples[0].sigma->y(), 0.2, 1e-12);
  EXPECT_NEAR(*samples[0].nees, 1.0, 1e-9) << "0.2 m along the uncertain direction";
}

TEST(Nees, OfHonestErrorsLiesInItsBand) {
  constexpr int kRuns = 2000;
  RandomStream random = random_stream(12);
  std::vector<PosePair> pairs;
  for (int i = 0; i < kRuns; ++i) {
    const Eigen::Matrix3d A = Eigen::Matrix3d::NullaryExpr([&] { return 0.1 * random.normal(); });
    const Eigen::Matrix3d P = A * A.transpose() + 1e-4 * Eigen::Matrix3d::Identity();
    const Eigen::Vector3d unit = Eigen::Vector3d::NullaryExpr([&] { return random.normal(); });
    const Eigen::Vector3d e = P.llt().matrixL() * unit;
    const Pose2 truth = random_pose(random);
    const Pose2 estimate{truth.x_m + e.x(), truth.y_m + e.y(), truth.theta_rad + e.z()};
    pairs.push_back(make_pair(estimate, {truth.x_m, truth.y_m, truth.theta_rad}, P));
  }
  const NeesSummary nees = summarise_nees(errors(pairs, {}));
  EXPECT_EQ(nees.scored, static_cast<std::size_t>(kRuns));
  EXPECT_EQ(nees.skipped, 0u);
  EXPECT_GT(*nees.mean * kRuns, chi2_quantile(0.0005, 3 * kRuns));
  EXPECT_LT(*nees.mean * kRuns, chi2_quantile(0.9995, 3 * kRuns));
  EXPECT_NEAR(*nees.median, chi2_quantile(0.5, 3), 0.2);
  EXPECT_NEAR(*nees.inside_95, 0.95, 0.02);
}

TEST(Nees, StaysTheSameWhenTheEstimateLivesInAnotherFrame) {
  const Eigen::Matrix3d P{{0.04, 0.01, 0.002}, {0.01, 0.09, 0.001}, {0.002, 0.001, 0.01}};
  const Pose2 T{5.0, -2.0, 1.2};
  const Pose2 estimate{1.0, 2.0, 0.3};
  const Truth truth{1.1, 1.8, 0.35};
  Eigen::Matrix3d G = Eigen::Matrix3d::Identity();
  G.topLeftCorner<2, 2>() = T.rotation().transpose();
  const auto plain = errors(std::vector{make_pair(estimate, truth, P)}, {});
  const auto turned = errors(std::vector{make_pair(T.inverse() * estimate, truth, G * P * G.transpose())}, T);
  EXPECT_NEAR(*plain[0].nees, *turned[0].nees, 1e-9);
}

TEST(Nees, CountsSingularCovariancesInsteadOfScoringThem) {
  const std::vector<PosePair> pairs{make_pair({0.001, 0, 0}, {0, 0, 0.0}, Eigen::Matrix3d::Zero()),
                                    make_pair({1, 0, 0}, {0, 0, 0.0}, Eigen::Matrix3d::Identity()),
                                    make_pair({1, 0, 0}, {0, 0, {}}, Eigen::Matrix3d::Identity())};
  const NeesSummary nees = summarise_nees(errors(pairs, {}));
  EXPECT_EQ(nees.scored, 1u);
  EXPECT_EQ(nees.skipped, 1u);
  EXPECT_DOUBLE_EQ(*nees.mean, 1.0);
  EXPECT_FALSE(summarise_nees({}).mean);
}

TEST(Travelled, AddsUpThePathButNotTheJitterOfAStandingRobot) {
  RandomStream random = random_stream(13);
  std::vector<PosePair> pairs;
  for (int i = 0; i < 1000; ++i)
    pairs.push_back(make_pair({}, {0.001 * random.normal(), 0.001 * random.normal(), {}}));
  for (int i = 0; i <= 100; ++i) pairs.push_back(make_pair({}, {0.1 * i, 0, {}}));
  const auto travelled = travelled_m(pairs);
  ASSERT_EQ(travelled.size(), pairs.size());
  EXPECT_LT(travelled[999], 0.03);
  EXPECT_NEAR(travelled.back(), 10.0, 0.03);
}

TEST(RelativeError, OfKnownDrift) {
  const Trajectory truth = straight_path(301, 0.1);
  Trajectory estimate = truth;
  for (TrajectoryPoint& point : estimate) point.pose.x_m *= 1.02;
  const auto pairs = associate(estimate, TruthTrack::from_trajectory(truth));
  const auto travelled = travelled_m(pairs);
  for (const double distance_m : {1.0, 5.0, 10.0}) {
    const RelativeError error = relative_error(pairs, travelled, distance_m);
    EXPECT_EQ(error.count, 301u - static_cast<std::size_t>(std::lround(10 * distance_m)));
    EXPECT_NEAR(*error.position_rmse_m, 0.02 * distance_m, 1e-6);
    EXPECT_NEAR(*error.heading_rmse_rad, 0.0, 1e-12);
  }
  EXPECT_EQ(relative_error(pairs, travelled, 31.0).count, 0u);
}

TEST(RelativeError, OfKnownHeadingDriftInAnyFrame) {
  const Trajectory truth = wavy_path(400);
  Trajectory estimate = truth;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    estimate[i].pose.theta_rad = wrap_angle(truth[i].pose.theta_rad + 0.01 * 0.1 * static_cast<double>(i));
  }
  const auto pairs = associate(moved({4, 5, 2}, estimate), TruthTrack::from_trajectory(truth));
  const RelativeError error = relative_error(pairs, travelled_m(pairs), 5.0);
  EXPECT_GT(error.count, 300u);
  EXPECT_NEAR(*error.heading_rmse_rad, 0.05, 0.0011);
}

TEST(RelativeError, LeavesOutSubPathsThatAreTooLong) {
  const Trajectory truth = straight_path(10, 0.7);
  const auto pairs = associate(truth, TruthTrack::from_trajectory(truth));
  EXPECT_EQ(relative_error(pairs, travelled_m(pairs), 1.0).count, 0u) << "the ends lie 1.4 m apart";
  EXPECT_EQ(relative_error(pairs, travelled_m(pairs), 1.4).count, 8u);
}

}  // namespace
}  // namespace waymark::eval
