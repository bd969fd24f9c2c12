#include "workbench/study/sweep_plan.hpp"

#include <gmock/gmock.h>

namespace waymark::study {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

SweepPlan two_blocks() {
  return {
      .input = "sim:square",
      .user = {.files = {}, .assignments = {"sim.laps=2"}},
      .blocks = {{{"fastslam.particles", {"10", "20"}}, {"seed", {"1", "10", "2"}}, {"filter", {"fastslam"}}},
                 {{"filter", {"ekf"}}, {"seed", {"1", "2"}}}}};
}

TEST(SweepPlan, EveryCombinationOnceSeedsSlowestAndInOrder) {
  const SweepPlan plan = two_blocks();
  EXPECT_THAT(columns(plan), ElementsAre("seed", "fastslam.particles", "filter"));
  using P = SweepPoint;
  EXPECT_THAT(points(plan), ElementsAre(P{"1", "10", "fastslam"}, P{"1", "20", "fastslam"}, P{"1", "", "ekf"},
                                        P{"2", "10", "fastslam"}, P{"2", "20", "fastslam"}, P{"2", "", "ekf"},
                                        P{"10", "10", "fastslam"}, P{"10", "20", "fastslam"}));
}

TEST(SweepPlan, WithoutSeedsKeepsTheOrderOfTheAxes) {
  const SweepPlan plan{"x", {}, {{{"a", {"1", "2"}}, {"b", {"3", "4"}}}}};
  using P = SweepPoint;
  EXPECT_THAT(points(plan), ElementsAre(P{"1", "3"}, P{"1", "4"}, P{"2", "3"}, P{"2", "4"}));
}

TEST(SweepPlan, BlocksThatSayTheSameAreRunOnce) {
  SweepPlan plan = two_blocks();
  plan.blocks.push_back(plan.blocks[1]);
  EXPECT_EQ(points(plan).size(), 8U);
}

TEST(SweepPlan, AxesWinOverTheCommonSettingsAndEmptyCellsSayNothing) {
  const SweepPlan plan = two_blocks();
  EXPECT_THAT(settings(plan, {"2", "", "ekf"}).assignments,
              ElementsAre("sim.laps=2", "seed=2", "filter=ekf"));
}

TEST(SweepPlan, FingerprintTellsSweepsApartButNotTheirLength) {
  const SweepPlan plan = two_blocks();
  const auto number = fingerprint(plan).value();
  SweepPlan longer = plan;
  longer.blocks[0][1].values.emplace_back("3");
  EXPECT_EQ(fingerprint(longer).value(), number);
  SweepPlan other = plan;
  other.user.assignments = {"sim.laps=3"};
  EXPECT_NE(fingerprint(other).value(), number);
  other = plan;
  other.input = "sim:l-shape";
  EXPECT_NE(fingerprint(other).value(), number);
  other = plan;
  other.blocks[0].push_back({"threads", {"1"}});
  EXPECT_NE(fingerprint(other).value(), number);
}

TEST(SweepPlan, ImpossiblePlansAreRefused) {
  SweepPlan plan = two_blocks();
  plan.blocks[0].push_back({"seed", {"5"}});
  EXPECT_THAT(check(plan).error().message, HasSubstr("seed is given twice"));
  const std::vector<std::string> many(1001, "1");
  EXPECT_THAT(check({"x", {}, {{{"a", many}, {"b", many}}}}).error().message, HasSubstr("at most 1000000"));
}

TEST(SweepPlan, StudyIsAboutParticlesBesideTheEkf) {
  const SweepPlan plan = study_plan();
  EXPECT_TRUE(check(plan).ok());
  EXPECT_THAT(columns(plan), ElementsAre("seed", "filter", "observe", "fastslam.particles"));
  EXPECT_THAT(points(plan), Contains(SweepPoint{"1", "ekf", "range-bearing", ""}));
  EXPECT_THAT(points(plan), Contains(SweepPoint{"20", "fastslam", "range-bearing", "1000"}));
}

}  // namespace
}  // namespace waymark::study
