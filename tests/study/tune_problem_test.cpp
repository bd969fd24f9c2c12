#include "workbench/study/tune_problem.hpp"

#include <gmock/gmock.h>

#include "support/io_support.hpp"

#include "study_support.hpp"

namespace waymark::study {
namespace {

using testing::HasSubstr;
using waymark::test::TempFolder;

TuneRequest request(std::vector<std::string> logs, std::vector<std::string> keys = {"sensor.range_sigma_m"}) {
  return {.logs = std::move(logs), .user = test::quick_plan({}).user, .keys = std::move(keys)};
}

std::string problem_of(const TuneRequest& request) {
  const auto problem = TuneProblem::open(request);
  return problem ? "accepted" : problem.error().message;
}

TEST(TuneProblem, RefusesLogsOfDifferentSensors) {
  EXPECT_THAT(problem_of(request({"sim:square", "sim:square@sim.odometry=velocity"})),
              HasSubstr("sim:square has wheel angles, but sim:square@sim.odometry=velocity has velocities"));
  EXPECT_THAT(problem_of(request({"sim:square", "sim:square@observe=range,filter=fastslam"})),
              HasSubstr("observes range-bearing"));
  EXPECT_THAT(problem_of(request({"sim:square", "sim:square@sensor.range_sigma_m=3"})),
              HasSubstr("--set sensor.range_sigma_m="));
}

TEST(TuneProblem, RefusesKeysThatMakeNoDifferenceOnlyWhereTheyWereChosen) {
  EXPECT_THAT(problem_of(request({"sim:square"}, {"fastslam.information_distance_m"})),
              HasSubstr("has no effect"));
  EXPECT_THAT(problem_of(request({"sim:square"}, {"motion.steer_var_rad2_m"})), HasSubstr("has no effect"));
  const auto defaults = TuneProblem::open(request({"sim:square"}, {}));
  ASSERT_TRUE(defaults.ok()) << defaults.error().message;
  EXPECT_GE(defaults->keys().size(), 3U);
}

TEST(TuneProblem, RefusesFewerObservationsThanKeys) {
  const TempFolder folder;
  folder.write("log.yaml", "waymark_log: 1\nname: short\n");
  folder.write("velocity.csv", "stamp_s,v_mps,w_radps\n0,1,0\n1,1,0\n");
  folder.write("observations.csv", "stamp_s,id,range_m,bearing_rad\n0,1,3,0.1\n0.5,1,2.5,0.1\n");
  EXPECT_THAT(problem_of({.logs = {folder.path().string()}}),
              HasSubstr("2 observations are too few to tune 5 keys"));
}

TEST(TuneProblem, FoldsAreStretchesOfALogOrLogs) {
  const auto one = TuneProblem::open(request({"sim:square"})).value();
  ASSERT_EQ(one.folds(), 4U);
  ThreadPool alone(1);
  const auto score = one.score(one.start(), {}, {}, alone).value();
  const TuneSums all = one.total(score);
  double observations = 0.0;
  for (std::size_t fold = 0; fold < 4; ++fold) {
    const TuneSums inside = one.total_of(score, fold);
    EXPECT_NEAR(inside.observations, all.observations / 4.0, 0.05 * all.observations) << one.fold_name(fold);
    EXPECT_NEAR(inside.log_likelihood + one.total_without(score, fold).log_likelihood, all.log_likelihood,
                1e-6);
    observations += inside.observations;
  }
  EXPECT_EQ(observations, all.observations);
  EXPECT_EQ(
      TuneProblem::open(request({"sim:square@seed=1", "sim:square@seed=2", "sim:square@seed=3"}))->folds(),
      3U);
}

TEST(TuneProblem, ALogThatIsLeftOutIsNotRun) {
  const auto two = TuneProblem::open(request({"sim:square@seed=1", "sim:square@seed=2"})).value();
  ThreadPool alone(1);
  const auto score = two.score(two.start(), 1, {}, alone).value();
  EXPECT_EQ(score[0].size(), kTuneBlocks);
  EXPECT_TRUE(score[1].empty());
}

TEST(TuneProblem, ByRmseAUnitIsAPercent) {
  TuneRequest by_rmse = request({"sim:square"});
  by_rmse.by = TuneBy::kRmse;
  const auto problem = TuneProblem::open(by_rmse).value();
  const TuneSums good{.squared_error_m2 = 4.0, .truths = 4.0};
  const TuneSums worse{.squared_error_m2 = 4.0 * 1.01 * 1.01, .truths = 4.0};
  EXPECT_DOUBLE_EQ(problem.figure(good), 1.0);
  EXPECT_NEAR(problem.value(good) - problem.value(worse), 1.0, 0.01);
}

}  // namespace
}  // namespace waymark::study
