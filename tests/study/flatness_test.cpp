#include "workbench/study/flatness.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "study_support.hpp"

namespace waymark::study {
namespace {

/// A simulated log whose own noise is known: near the top of its likelihood.
TuneProblem problem(std::vector<std::string> keys) {
  TuneRequest request{.logs = {"sim:square"}, .user = test::quick_plan({}).user, .keys = std::move(keys)};
  request.user.assignments.emplace_back("map.capacity=8");
  return TuneProblem::open(request).value();
}

double value(const TuneProblem& problem, const TunePoint& at) {
  ThreadPool alone(1);
  return problem.value(problem.total(problem.score(at, {}, {}, alone).value()));
}

TEST(Flatness, AProfileIsTheScoreAlongOneKey) {
  const TuneProblem two = problem({"sensor.range_sigma_m", "sensor.bearing_sigma_deg"});
  const TunePoint centre = two.start();
  const auto flatness = find_flatness(two, centre, 1, {});
  ASSERT_TRUE(flatness.has_value());
  for (std::size_t key = 0; key < 2; ++key) {
    const auto& slice = flatness->keys[key].slice;
    EXPECT_GE(slice.size(), 5U);
    EXPECT_TRUE(std::ranges::is_sorted(slice));
    for (const auto& [at, score] : slice) {
      TunePoint there = centre;
      there[key] = at;
      EXPECT_NEAR(score, value(two, there) - value(two, centre), 1e-9);
      EXPECT_LE(score, flatness->gained + 1e-9);
    }
  }
}

TEST(Flatness, AtTheEndsOfAnIntervalTheScoreHasFallenByTwoOrMore) {
  const TuneProblem one = problem({"sensor.range_sigma_m"});
  const auto flatness = find_flatness(one, one.start(), 2, {});
  ASSERT_TRUE(flatness.has_value());
  const KeyFlatness& key = flatness->keys.front();
  EXPECT_FALSE(key.open_low || key.open_high);
  // The parabola between two points, a factor of two apart, is off by less than a quarter of a unit.
  EXPECT_LT(value(one, {key.low}), value(one, one.start()) - 1.75);
  EXPECT_LT(value(one, {key.high}), value(one, one.start()) - 1.75);
}

TEST(Flatness, AKeyAtItsLimitIsOpenThere) {
  const TuneProblem one = problem({"sensor.range_sigma_m"});
  const TuneKey& key = one.keys().front();
  const auto flatness = find_flatness(one, {key.to_search(key.low)}, 1, {});
  ASSERT_TRUE(flatness.has_value());
  EXPECT_TRUE(flatness->keys.front().open_low);
  EXPECT_GT(flatness->gained, 0.0);  // it is better above
  EXPECT_GT(flatness->best.front(), key.to_search(key.low));
}

TEST(Flatness, IsNothingWhenStopped) {
  const TuneProblem one = problem({"sensor.range_sigma_m"});
  EXPECT_FALSE(find_flatness(one, one.start(), 1, [] { return false; }).has_value());
}

}  // namespace
}  // namespace waymark::study
