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
  two_threads.push_back("threads=2");
  const auto one = record_study(settings);
  const auto two = record_study(two_threads);
  ASSERT_TRUE(one.ok() && two.ok());
  ASSERT_EQ(one->trajectory.size(), two->trajectory.size());
  for (std::size_t i = 0; i < one->trajectory.size(); ++i) {
    ASSERT_EQ(one->trajectory[i].pose, two->trajectory[i].pose);
    ASSERT_EQ(one->trajectory[i].covariance, two->trajectory[i].covariance);
  }
}

TEST_P(BothFilters, FollowTheStudyFarBetterThanTheWheelsAlone) {
  const auto run = record_study({"filter=" + GetParam(), "seed=11"});
  ASSERT_TRUE(run.ok());
  EXPECT_FALSE(run->error.has_value());
  EXPECT_GT(run->innovations.size(), 1000U);
  const Pose2 T_world_start = {run->truth.front().second.x_m, run->truth.front().second.y_m, *run->truth.front().second.theta_rad};
  const auto& truth = run->truth.back().second;
  const auto miss = [&](const Pose2& T_start_end) {
    return ((T_world_start * T_start_end).position() - Eigen::Vector2d(truth.x_m, truth.y_m)).norm();
  };
  EXPECT_LT(miss(run->trajectory.back().pose), 0.5 * miss(run->dead_reckoning.back().pose));
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

TEST(MakeFilter, RefusesAModeThatTheFilterDoesNotHave) {
  const auto run = record_study({"observe=bearing"});
  ASSERT_FALSE(run.ok());
  EXPECT_NE(run.error().message.find("observe"), std::string::npos);
}

}  // namespace
}  // namespace waymark
