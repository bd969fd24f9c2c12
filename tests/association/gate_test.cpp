#include "waymark/association/gate.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "waymark/core/chi2.hpp"

namespace waymark {
namespace {

TEST(Gate, LetsTheChosenPartOfTrueObservationsPass) {
  const Gate gate(GateOptions{0.99});
  EXPECT_NEAR(gate.threshold(1), 6.6349, 1e-4);
  EXPECT_NEAR(gate.threshold(2), 9.2103, 1e-4);
  EXPECT_NEAR(gate.threshold(3), 11.3449, 1e-4);
}

TEST(Gate, ProbabilityOneGatesNothing) {
  EXPECT_EQ(Gate(GateOptions{1.0}).threshold(2), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace waymark
