#pragma once

#include <Eigen/Core>
#include <gtest/gtest.h>

namespace waymark::test {

/// Every entry of `actual` is within `tolerance` of `expected`; a NaN is near nothing. Use in EXPECT_TRUE.
template <class A, class B>
testing::AssertionResult matrix_near(const Eigen::MatrixBase<A>& actual, const Eigen::MatrixBase<B>& expected,
                                     double tolerance) {
  if (actual.rows() == expected.rows() && actual.cols() == expected.cols() &&
      ((actual - expected).array().abs() <= tolerance).all())
    return testing::AssertionSuccess();
  return testing::AssertionFailure() << "actual\n"
                                     << actual << "\nexpected\n"
                                     << expected << "\ntolerance " << tolerance;
}

}  // namespace waymark::test
