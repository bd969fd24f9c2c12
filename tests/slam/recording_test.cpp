#include "waymark/slam/recording.hpp"

#include <gtest/gtest.h>

#include "waymark/slam/make_filter.hpp"

namespace waymark {
namespace {

Result<Recording> record_study(std::vector<std::string> settings, const TimeSpan& span = {},
                               const std::function<bool(double)>& keep_going = {}) {
  auto opened = open_input("sim:study", {{}, std::move(settings)});
  if (!opened) return opened.error();
  return record(*opened->source, opened->config, span, keep_going);
}

class BothFilters : public testing::TestWithParam<std::string> {};

TEST_P(BothFilters, GiveTheSameBitsForOneAndTwoThreads) {
  const std::vector<std::string> settings{"filter=" + GetParam(), "sim.laps=1", "fastslam.particles=600"};
  auto two_threads = settings;
  two_threads.emplace_back("threads=2");
  const auto one = record_study(settings);
  const auto two = record_study(two_threads);
  ASSERT_TRUE(one.ok() && two.ok());
  ASSERT_EQ(one->trajectory.size(), two->trajectory.size());
  for (std::size_t i = 0; i < one->trajectory.size(); ++i) {
    ASSERT_EQ(one->trajectory[i].pose, two->trajectory[i].pose);
    ASSERT_EQ(one->trajectory[i].covariance, two->trajectory[i].covariance);
  }
}

/// How far from the truth the robot believes to be at the end.
double final_miss_m(const Recording& run, const Trajectory& estimate) {
  const Truth& start = run.truth.front().second;
  const Truth& end = run.truth.back().second;
  const Pose2 T_world_start{start.x_m, start.y_m, *start.theta_rad};
  return ((T_world_start * estimate.back().pose).position() - Eigen::Vector2d(end.x_m, end.y_m)).norm();
}

TEST_P(BothFilters, FollowTheStudyBetterThanTheWheelsAlone) {
  double filter_m = 0.0;
  double wheels_m = 0.0;
  for (int seed = 1; seed <= 8; ++seed) {
    const auto run = record_study({"filter=" + GetParam(), "seed=" + std::to_string(seed)});
    ASSERT_TRUE(run.ok());
    EXPECT_FALSE(run->error.has_value());
    EXPECT_GT(run->innovations.size(), 1000U);
    filter_m += final_miss_m(*run, run->trajectory);
    wheels_m += final_miss_m(*run, run->dead_reckoning);
  }
  EXPECT_LT(filter_m, 0.5 * wheels_m);
}

INSTANTIATE_TEST_SUITE_P(Filters, BothFilters, testing::Values("ekf", "fastslam"));

TEST(Recording, KeepsWhatWasDoneWhenStopped) {
  const auto run = record_study({}, {}, [](double fraction) { return fraction < 0.3; });
  ASSERT_TRUE(run.ok());
  ASSERT_TRUE(run->error.has_value());
  EXPECT_EQ(run->error->kind, Error::Kind::kFailed);
  EXPECT_GT(run->trajectory.size(), 100U);
}

TEST(Recording, UsesThePartOfTheLogThatIsAskedFor) {
  const auto run = record_study({}, {.from_s = 10.0, .to_s = 20.0});
  ASSERT_TRUE(run.ok());
  EXPECT_NEAR(to_seconds(run->trajectory.front().stamp), 10.0, 0.1);
  EXPECT_NEAR(to_seconds(run->trajectory.back().stamp), 20.0, 0.1);
}

TEST(Recording, WheelsOfUnknownSizeEndTheRunAndNameTheKey) {
  const auto run = record_study({"wheels.track_m=0"});
  ASSERT_TRUE(run.ok());
  ASSERT_TRUE(run->error.has_value());
  EXPECT_NE(run->error->message.find("wheels.track_m"), std::string::npos);
}

TEST(MakeFilter, RefusesAnAssociationThatDoesNotFit) {
  const auto ekf = record_study({"associate=ml"});
  ASSERT_FALSE(ekf.ok());
  EXPECT_NE(ekf.error().message.find("filter=fastslam"), std::string::npos) << ekf.error().message;
  const auto range = record_study({"associate=ml", "filter=fastslam", "observe=range"});
  ASSERT_FALSE(range.ok());
  EXPECT_NE(range.error().message.find("associate=known"), std::string::npos) << range.error().message;
}

TEST(MakeFilter, SaysThatParticlesTakeNoPixels) {
  const auto run = record_study({"observe=pixel", "filter=fastslam"});
  ASSERT_FALSE(run.ok());
  EXPECT_NE(run.error().message.find("filter=ekf"), std::string::npos) << run.error().message;
}

TEST(Recording, PixelsThatALogDoesNotHaveEndTheRun) {
  const auto run = record_study({"observe=pixel"});
  ASSERT_TRUE(run.ok());
  ASSERT_TRUE(run->error.has_value());
  EXPECT_NE(run->error->message.find("observe"), std::string::npos);
}

TEST(MakeFilter, RefusesAModeThatTheFilterDoesNotHave) {
  const auto run = record_study({"observe=bearing"});
  ASSERT_FALSE(run.ok());
  EXPECT_NE(run.error().message.find("observe"), std::string::npos);
}

}  // namespace
}  // namespace waymark
