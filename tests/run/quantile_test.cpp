#include "workbench/run/quantile.hpp"

#include <gtest/gtest.h>

namespace waymark {
namespace {

TEST(Quantile, IsTheValueThatSoManyAreBelow) {
  const std::vector<double> values{5.0, 1.0, 4.0, 2.0, 3.0};
  EXPECT_EQ(quantile(values, 0.0), 1.0);
  EXPECT_EQ(quantile(values, 0.5), 3.0);
  EXPECT_EQ(quantile(values, 1.0), 5.0);
}

TEST(Quantile, OfNothingIsZero) { EXPECT_EQ(quantile({}, 0.5), 0.0); }

}  // namespace
}  // namespace waymark
