#include "waymark/core/chi2.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "waymark/core/random.hpp"

namespace waymark {
namespace {

struct TableRow {
  double probability;
  double dof;
  double quantile;
};

TEST(Chi2Quantile, AgreesWithPublishedTables) {
  for (const auto& [probability, dof, quantile] :
       {TableRow{0.95, 1, 3.841459}, TableRow{0.99, 1, 6.634897}, TableRow{0.5, 2, 1.386294},
        TableRow{0.95, 2, 5.991465}, TableRow{0.99, 2, 9.210340}, TableRow{0.95, 3, 7.814728},
        TableRow{0.999, 3, 16.266236}, TableRow{0.05, 10, 3.940299}, TableRow{0.95, 10, 18.307038},
        TableRow{0.025, 150, 117.984515}, TableRow{0.975, 150, 185.800447}, TableRow{0.99, 150, 193.207686}})
    EXPECT_NEAR(chi2_quantile(probability, dof), quantile, 1e-6) << probability << " " << dof;
}

TEST(Chi2Cdf, HasItsClosedFormsForOneTwoAndFourDegrees) {
  for (double x = 1e-6; x < 200.0; x *= 1.3) {
    EXPECT_NEAR(chi2_cdf(x, 1), std::erf(std::sqrt(0.5 * x)), 1e-14) << x;
    EXPECT_NEAR(chi2_cdf(x, 2), -std::expm1(-0.5 * x), 1e-14) << x;
    EXPECT_NEAR(chi2_cdf(x, 4), 1.0 - std::exp(-0.5 * x) * (1.0 + 0.5 * x), 1e-14) << x;
  }
}

TEST(Chi2Cdf, ObeysTheRecurrenceOverDegreesOfFreedom) {
  RandomStream random(1, StreamPurpose::kWorld);
  for (int i = 0; i < 2000; ++i) {
    const double dof = random.uniform(1.0, 300.0);
    const double x = dof * random.uniform(0.2, 3.0);
    const double step = std::exp(0.5 * dof * std::log(0.5 * x) - 0.5 * x - std::lgamma(0.5 * dof + 1.0));
    EXPECT_NEAR(chi2_cdf(x, dof + 2.0), chi2_cdf(x, dof) - step, 1e-12) << x << " " << dof;
  }
}

TEST(Chi2Quantile, IsTheInverseOfTheCdf) {
  RandomStream random(2, StreamPurpose::kWorld);
  for (int i = 0; i < 2000; ++i) {
    const double dof = std::exp(random.uniform(0.0, std::log(5000.0)));
    const double probability = random.uniform(1e-6, 1.0 - 1e-6);
    EXPECT_NEAR(chi2_cdf(chi2_quantile(probability, dof), dof), probability, 1e-10)
        << probability << " " << dof;
  }
}

TEST(Chi2, HandlesTheEndsOfItsRange) {
  EXPECT_EQ(chi2_cdf(0.0, 3), 0.0);
  EXPECT_EQ(chi2_cdf(-1.0, 3), 0.0);
  EXPECT_EQ(chi2_cdf(1e6, 3), 1.0);
  EXPECT_EQ(chi2_quantile(0.0, 3), 0.0);
  EXPECT_EQ(chi2_quantile(1.0, 3), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace waymark
