#include "workbench/study/maximise.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace waymark::study {
namespace {

using Point = std::vector<double>;

SearchBox box(std::size_t dimension, double low = -5.0) {
  return {Point(dimension, 2.0), Point(dimension, low), Point(dimension, 5.0), Point(dimension, 0.7)};
}

/// A hill with its top at (0.3, 0.6, 0.9, ...) whose axes are no axes of the search.
std::optional<double> hill(const Point& at) {
  double value = 0.0;
  for (std::size_t i = 0; i < at.size(); ++i) {
    const double d = at[i] - 0.3 * static_cast<double>(i + 1);
    value -= 10.0 * d * d;
    if (i > 0) value -= 5.0 * std::pow(d + at[i - 1] - 0.3 * static_cast<double>(i), 2);
  }
  return value;
}

TEST(Maximise, FindsTheTopInAnyDimension) {
  for (const std::size_t dimension : {1U, 2U, 5U}) {
    const Maximum top = maximise(hill, box(dimension), 0.01);
    ASSERT_EQ(top.at.size(), dimension);
    EXPECT_GT(top.value, -0.05);
    for (std::size_t i = 0; i < dimension; ++i)
      EXPECT_NEAR(top.at[i], 0.3 * static_cast<double>(i + 1), 0.05) << dimension;
    EXPECT_FALSE(top.stopped);
  }
}

TEST(Maximise, StaysInItsBox) {
  const Maximum top = maximise(hill, box(2, 1.0), 0.01);
  EXPECT_NEAR(top.at[0], 1.0, 0.02);
  for (const double x : top.at) EXPECT_GE(x, 1.0);
}

TEST(Maximise, SmallStepsOfTheFunctionDoNoHarm) {
  const auto stepped = [](const Point& at) -> std::optional<double> {
    return std::floor(20.0 * *hill(at)) / 20.0;
  };
  EXPECT_GT(*hill(maximise(stepped, box(3), 0.01).at), -0.2);
}

TEST(Maximise, NeverReturnsLessThanItsStart) {
  const auto flat = [](const Point& at) -> std::optional<double> {
    return at == Point{2.0, 2.0} ? 1.0 : 0.0;
  };
  EXPECT_EQ(maximise(flat, box(2), 0.01).value, 1.0);
}

TEST(Maximise, KeepsTheBestWhenStopped) {
  int calls = 0;
  double best = -HUGE_VAL;
  const Maximum top = maximise(
      [&](const Point& at) -> std::optional<double> {
        if (++calls > 7) return std::nullopt;
        best = std::max(best, *hill(at));
        return hill(at);
      },
      box(3), 0.01);
  EXPECT_TRUE(top.stopped);
  EXPECT_EQ(calls, 8);
  EXPECT_EQ(top.evaluations, 7);
  EXPECT_EQ(top.value, best);
  EXPECT_EQ(*hill(top.at), best);
}

TEST(Maximise, StoppedAtOnceItIsWhereItBegan) {
  const Maximum top = maximise([](const Point&) { return std::optional<double>(); }, box(2), 0.01);
  EXPECT_TRUE(top.stopped);
  EXPECT_EQ(top.at, box(2).start);
}

}  // namespace
}  // namespace waymark::study
