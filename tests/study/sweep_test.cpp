#include "workbench/study/sweep.hpp"

#include <gmock/gmock.h>

#include "support/io_support.hpp"

#include "study_support.hpp"

namespace waymark::study {
namespace {

using waymark::test::TempFolder;

SweepPlan plan(std::vector<std::string> seeds) { return test::quick_plan({{"seed", std::move(seeds)}}); }

SweepRow row(const std::string& seed) { return {{seed}, {}, {}}; }

TEST(Sweep, HandsOutEveryRunOnce) {
  const TempFolder folder;
  const auto sweep = Sweep::open(plan({"1", "2", "3"}), folder.path()).value();
  EXPECT_EQ(sweep->total(), 3U);
  for (std::size_t expected = 0; expected < 3; ++expected) EXPECT_EQ(sweep->take(), expected);
  EXPECT_FALSE(sweep->take().has_value());
  sweep->finish(row("2"));
  sweep->finish(row("2"));
  EXPECT_EQ(sweep->done(), 1U);
}

TEST(Sweep, RowsComeInTheOrderOfThePlanWhateverFinishedFirst) {
  const TempFolder folder;
  const auto sweep = Sweep::open(plan({"1", "2", "3"}), folder.path()).value();
  for (const char* seed : {"3", "1", "2"}) sweep->finish(row(seed));
  std::string seeds;
  for (const auto& done : sweep->rows()) seeds += done.point[0];
  EXPECT_EQ(seeds, "123");
}

TEST(Sweep, GoesOnWhereItEndedAndCanGrow) {
  const TempFolder folder;
  Sweep::open(plan({"1", "2", "3"}), folder.path()).value()->finish(row("2"));
  const auto sweep = Sweep::open(plan({"1", "2", "4"}), folder.path()).value();
  EXPECT_EQ(sweep->resumed(), 1U);
  EXPECT_EQ(sweep->take(), 0U);
  EXPECT_EQ(sweep->take(), 2U);
  EXPECT_FALSE(sweep->take().has_value());
}

TEST(Sweep, StoppedHandsOutNoMore) {
  const TempFolder folder;
  const auto sweep = Sweep::open(plan({"1", "2"}), folder.path()).value();
  sweep->stop();
  EXPECT_FALSE(sweep->take().has_value());
  EXPECT_TRUE(sweep->stopped());
}

TEST(Sweep, ThatFailsStopsAndKeepsTheFirstReason) {
  const TempFolder folder;
  const auto sweep = Sweep::open(plan({"1", "2"}), folder.path()).value();
  EXPECT_FALSE(sweep->error().has_value());
  sweep->fail({"first", Error::Kind::kFailed});
  sweep->fail({"second", Error::Kind::kFailed});
  EXPECT_EQ(sweep->error()->message, "first");
  EXPECT_FALSE(sweep->take().has_value());
}

TEST(Sweep, RowsOfNoRunOfThePlanAreLeftOut) {
  const TempFolder folder;
  const auto sweep = Sweep::open(plan({"1"}), folder.path()).value();
  sweep->finish(row("77"));
  EXPECT_EQ(sweep->done(), 0U);
}

TEST(Sweep, TableHasAHeaderAndARowPerRun) {
  const SweepPlan one = plan({"1"});
  EXPECT_EQ(csv(one, {row("1")}), csv_header(one) + "\n" + to_csv(row("1")) + "\n");
}

}  // namespace
}  // namespace waymark::study
