#include "workbench/study/tune_log.hpp"

#include <gmock/gmock.h>

#include "support/io_support.hpp"

#include "study_support.hpp"
#include "workbench/study/observation_score.hpp"

namespace waymark::study {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using waymark::test::TempFolder;

const UserSettings kQuickUser = test::quick_plan({}).user;

TuneSums total(const std::vector<TuneSums>& blocks) {
  TuneSums sums;
  for (const TuneSums& block : blocks) sums += block;
  return sums;
}

TEST(TuneInput, MayHaveSettingsOfItsOwn) {
  EXPECT_EQ(parse_tune_input("a/b@2x").path, "a/b@2x");
  EXPECT_THAT(parse_tune_input("a/b@2x").assignments, IsEmpty());
  const TuneInput input = parse_tune_input("a@b/MRCLAM@input.robot=3,seed=2");
  EXPECT_EQ(input.path, "a@b/MRCLAM");
  EXPECT_THAT(input.assignments, ElementsAre("input.robot=3", "seed=2"));
}

TEST(TuneLog, EveryObservationOfARunIsATermOfItsScore) {
  const auto log = TuneLog::open("sim:square", kQuickUser);
  ASSERT_TRUE(log.ok()) << log.error().message;
  EXPECT_EQ(log->odometry(), OdometryKind::kWheels);
  UserSettings user = kQuickUser;
  user.assignments.emplace_back("sensor.range_sigma_m=0.2");
  user.assignments.emplace_back("smooth.run=true");  // keeps the observations
  const auto run = run_and_score("sim:square", user);
  ASSERT_TRUE(run.ok());
  double longest_m = 0.0;
  for (const auto& landmark_observation : run->recording.observations)
    longest_m = std::max(longest_m, std::get<RangeBearing>(landmark_observation.observation.value).range_m);
  double expected = 0.0;
  for (const auto& [stamp, innovation] : run->recording.innovations)
    expected += log_likelihood(innovation, log_field_density(run->config, longest_m));
  const auto blocks = log->sums({"sensor.range_sigma_m=0.2"}, {});
  ASSERT_TRUE(blocks.has_value());
  EXPECT_EQ(blocks->size(), kTuneBlocks);
  EXPECT_NEAR(total(*blocks).log_likelihood, expected, 1e-9 * std::abs(expected));
  EXPECT_EQ(static_cast<std::size_t>(total(*blocks).observations), run->recording.innovations.size());
}

TEST(TuneLog, ItsErrorIsThatOfTheAlignedPath) {
  const auto log = TuneLog::open("sim:square", kQuickUser).value();
  const TuneSums sums = total(log.sums({}, {}).value());
  const auto run = log.run({}, {});
  ASSERT_TRUE(run.ok());
  ASSERT_TRUE(run->evaluation.has_value());
  EXPECT_NEAR(std::sqrt(sums.squared_error_m2 / sums.truths), *run->evaluation->path.position_rmse_aligned_m,
              1e-12);
}

TEST(TuneLog, GivesNothingWhenStopped) {
  const auto log = TuneLog::open("sim:square", kQuickUser).value();
  EXPECT_FALSE(log.sums({}, [] { return false; }).has_value());
}

TEST(TuneLog, SettingsThatDropObservationsGainNothing) {
  const auto log = TuneLog::open("sim:square", kQuickUser).value();
  const TuneSums as_it_is = total(log.sums({}, {}).value());
  const TuneSums blind = total(log.sums({"sensor.max_range_m=1"}, {}).value());
  EXPECT_EQ(blind.observations, as_it_is.observations);
  EXPECT_LT(blind.log_likelihood, as_it_is.log_likelihood);
}

TEST(TuneLog, RefusesWhatHasNothingToTuneBy) {
  EXPECT_FALSE(TuneLog::open("nowhere", {}).ok());
  const TempFolder folder;
  folder.write("log.yaml", "waymark_log: 1\nname: blind\n");
  folder.write("velocity.csv", "stamp_s,v_mps,w_radps\n0,1,0\n1,1,0\n");
  const auto blind = TuneLog::open(folder.path().string(), {});
  ASSERT_FALSE(blind.ok());
  EXPECT_THAT(blind.error().message, HasSubstr("no observations"));
}

}  // namespace
}  // namespace waymark::study
