#include "workbench/study/tune.hpp"

#include <cmath>

#include <gmock/gmock.h>

#include "study_support.hpp"
#include "workbench/study/sweep_summary.hpp"
#include "workbench/study/tune_text.hpp"

namespace waymark::study {
namespace {

using testing::HasSubstr;

constexpr double kRangeSigma_m = 0.08;
constexpr double kBearingSigma_deg = 1.5;

/// A small world whose sensor errs by so much, to be tuned from a third and from three times of that.
TuneRequest request(int threads = 1) {
  TuneRequest request{.logs = {"sim:square"}, .user = test::quick_plan({}).user, .threads = threads};
  for (const char* setting : {"sim.range_sigma_m=0.08", "sim.bearing_sigma_deg=1.5",
                              "sensor.range_sigma_m=0.24", "sensor.bearing_sigma_deg=0.5", "map.capacity=8"})
    request.user.assignments.emplace_back(setting);
  request.keys = {"sensor.range_sigma_m", "sensor.bearing_sigma_deg"};
  return request;
}

/// How far the truth is from what was found, in halves of the interval: standard deviations, two of which an
/// interval has on each side.
double sigmas_off(const TunedKey& key, double truth) {
  const double half = 0.5 * std::log(key.interval->second / key.interval->first);
  return 2.0 * std::abs(std::log(key.after / truth)) / half;
}

// 4.9 standard deviations: a millionth of all worlds are beyond for one key. No seed is chosen.
TEST(Tune, FindsTheNoiseThatWasSimulatedWithinWhatItSays) {
  for (const char* seed : {"seed=1", "seed=2", "seed=3"}) {
    TuneRequest simulated = request();
    simulated.user.assignments.emplace_back(seed);
    const auto result = tune(simulated);
    ASSERT_TRUE(result.ok()) << result.error().message;
    ASSERT_EQ(result->keys.size(), 2U);
    const double truths[] = {kRangeSigma_m, kBearingSigma_deg};
    for (std::size_t k = 0; k < 2; ++k) {
      const TunedKey& key = result->keys[k];
      ASSERT_TRUE(key.interval.has_value());
      EXPECT_LT(sigmas_off(key, truths[k]), 4.9) << key.name << " " << key.after << " " << seed;
      EXPECT_LT(key.interval->second / key.interval->first, 2.0) << key.name;
      EXPECT_FALSE(key.open_low || key.open_high);
    }
    EXPECT_GT(result->after, result->before);
    EXPECT_GT(result->held_out.back().after, result->held_out.back().before);
  }
}

TEST(Tune, TheNumberOfThreadsDoesNotMatter) {
  const auto one = tune(request(1)).value();
  const auto three = tune(request(3)).value();
  EXPECT_EQ(to_yaml(one), to_yaml(three));
  EXPECT_EQ(one.runs, three.runs);
  ASSERT_EQ(one.held_out.size(), three.held_out.size());
  for (std::size_t i = 0; i < one.held_out.size(); ++i)
    EXPECT_EQ(one.held_out[i].after, three.held_out[i].after);
  for (std::size_t k = 0; k < one.keys.size(); ++k) EXPECT_EQ(one.keys[k].slice, three.keys[k].slice);
}

TEST(Tune, SeveralLogsAreLeftOutOneByOne) {
  TuneRequest two = request();
  two.logs = {"sim:square@seed=1", "sim:square@seed=2"};
  const auto result = tune(two);
  ASSERT_TRUE(result.ok()) << result.error().message;
  ASSERT_EQ(result->held_out.size(), 3U);
  EXPECT_EQ(result->held_out[1].name, "sim:square@seed=2");
  EXPECT_EQ(result->held_out[2].name, "all");
  EXPECT_EQ(result->logs.size(), 2U);
}

TEST(Tune, ByRmseMakesThePathNoWorse) {
  TuneRequest by_rmse = request();
  by_rmse.by = TuneBy::kRmse;
  const auto result = tune(by_rmse);
  ASSERT_TRUE(result.ok()) << result.error().message;
  EXPECT_LE(result->after, result->before);
  const std::size_t rmse = figure_index("position_rmse_aligned_m");
  EXPECT_NEAR(result->logs.front().figures_after[rmse], result->after, 1e-12);
}

TEST(Tune, StoppedItKeepsTheBestSoFar) {
  int asked = 0;
  const auto result = tune(request(), [&asked](double) { return ++asked < 40; });
  ASSERT_TRUE(result.ok());
  EXPECT_TRUE(result->stopped);
  ASSERT_EQ(result->keys.size(), 2U);
  EXPECT_FALSE(result->keys[0].interval.has_value());
  EXPECT_THAT(to_yaml(*result), HasSubstr("stopped early"));
}

}  // namespace
}  // namespace waymark::study
