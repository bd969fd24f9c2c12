#include "workbench/study/sweep_figures.hpp"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>

#include "support/no_more_threads.hpp"

#include "study_support.hpp"
#include "workbench/study/sweep_journal.hpp"
#include "workbench/study/sweep_summary.hpp"

namespace waymark::study {
namespace {

using testing::HasSubstr;

double figure(const SweepRow& row, std::string_view name) { return row.figures[figure_index(name)]; }

TEST(SweepFigures, AreThoseOfTheRun) {
  const SweepPlan plan = test::quick_plan({{"seed", {"3"}}});
  const auto row = make_run(plan, {"3"});
  ASSERT_TRUE(row.has_value());
  EXPECT_EQ(row->error, "");
  const auto run = run_and_score(plan.input, settings(plan, {"3"})).value();
  EXPECT_EQ(figure(*row, "position_rmse_m"), *run.evaluation->path.position_rmse_m);
  EXPECT_EQ(figure(*row, "landmark_rmse_m"), *run.evaluation->map->rmse_m);
  EXPECT_GT(figure(*row, "step_mean_us"), 0.0);
}

TEST(SweepFigures, FrobeniusNormsDifferByTheSpreadOfParticles) {
  const SweepPlan plan = test::quick_plan({{"filter", {"ekf", "fastslam"}}});
  const auto ekf = make_run(plan, {"ekf"}).value();
  EXPECT_EQ(figure(ekf, "frobenius_mixture_m2"), figure(ekf, "frobenius_mean_m2"));
  const auto particles = make_run(plan, {"fastslam"}).value();
  EXPECT_GT(figure(particles, "frobenius_mixture_m2"), figure(particles, "frobenius_mean_m2"));
  EXPECT_GT(figure(particles, "frobenius_mean_m2"), 0.0);
}

TEST(SweepFigures, FrobeniusNormIsThatOfTheMeanCovariance) {
  const SweepPlan plan = test::quick_plan({{"seed", {"1"}}});
  const auto run = run_and_score(plan.input, settings(plan, {"1"})).value();
  Eigen::Matrix2d mean = Eigen::Matrix2d::Zero();
  const auto map = run.recording.filter->snapshot().landmarks;
  for (const auto& landmark : map)
    mean += landmark.covariance.topLeftCorner<2, 2>() / static_cast<double>(map.size());
  const double expected =
      std::sqrt(mean(0, 0) * mean(0, 0) + 2.0 * mean(0, 1) * mean(0, 1) + mean(1, 1) * mean(1, 1));
  EXPECT_NEAR(figures_of(run)[figure_index("frobenius_mixture_m2")], expected, 1e-12);
}

TEST(SweepFigures, RunThatCannotBeMadeHasItsErrorAndNoFigures) {
  const auto row = make_run(test::quick_plan({{"sim.range_max_m", {"0.1"}}}), {"0.1"});
  ASSERT_TRUE(row.has_value());
  EXPECT_THAT(row->error, HasSubstr("sim.range_max_m"));
  EXPECT_EQ(row->error_kind, Error::Kind::kBadInput);
  EXPECT_TRUE(std::ranges::all_of(row->figures, [](double value) { return std::isnan(value); }));
}

TEST(SweepFigures, RunInWhichSomethingIsThrownHasItsErrorToo) {
  const SweepPlan plan = test::quick_plan({{"threads", {"2"}}});
  const waymark::test::NoMoreThreads none;
  const auto row = make_run(plan, {"2"});
  ASSERT_TRUE(row.has_value());
  EXPECT_THAT(row->error, HasSubstr("could not start a thread"));
  EXPECT_EQ(row->error_kind, Error::Kind::kFailed);
  EXPECT_TRUE(std::ranges::all_of(row->figures, [](double value) { return std::isnan(value); }));
}

TEST(SweepFigures, InterruptedRunIsNoRow) {
  EXPECT_FALSE(make_run(test::quick_plan({{"seed", {"1"}}}), {"1"}, [] { return false; }).has_value());
}

TEST(SweepFigures, RowsReadBackToTheLastBit) {
  const SweepPlan plan = test::quick_plan({{"seed", {"1"}}, {"filter", {"ekf"}}});
  SweepRow row{{"1", "ekf"}, {}, "a line: with; blanks"};
  for (std::size_t i = 0; i < row.figures.size(); ++i) row.figures[i] = 1.0 / (3.0 + static_cast<double>(i));
  row.figures[2] = std::nan("");
  const auto rows = parse_rows(csv_header(plan) + "\n" + to_csv(row) + "\n", "rows", plan);
  ASSERT_TRUE(rows.ok()) << rows.error().message;
  ASSERT_EQ(rows->size(), 1U);
  EXPECT_EQ(rows->front().point, row.point);
  EXPECT_EQ(rows->front().error, row.error);
  for (std::size_t i = 0; i < row.figures.size(); ++i) {
    if (i == 2)
      EXPECT_TRUE(std::isnan(rows->front().figures[i]));
    else
      EXPECT_EQ(rows->front().figures[i], row.figures[i]);
  }
}

}  // namespace
}  // namespace waymark::study
