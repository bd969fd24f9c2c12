#include "workbench/eval/median.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "eval/eval_support.hpp"

namespace waymark::eval {
namespace {

TEST(Median, OddEvenAndEmpty) {
  EXPECT_EQ(median({3.0, 1.0, 2.0}), 2.0);
  EXPECT_EQ(median({4.0, 1.0, 3.0, 2.0}), 2.5);
  EXPECT_EQ(median({}), std::nullopt);
}

TEST(RobustSigma, FindsTheSpreadUnderOutliers) {
  RandomStream random = test::random_stream(1);
  std::vector<double> lengths;
  for (int i = 0; i < 20000; ++i) lengths.push_back(std::hypot(0.3 * random.normal(), 0.3 * random.normal()));
  EXPECT_NEAR(robust_sigma(lengths), 0.3, 0.01);
  lengths.insert(lengths.end(), 1000, 1e6);
  EXPECT_NEAR(robust_sigma(lengths), 0.3, 0.03);
}

}  // namespace
}  // namespace waymark::eval
