#include "workbench/report/nis_histogram.hpp"

#include <cmath>
#include <numeric>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace waymark {
namespace {

double mass(const std::vector<double>& density, double bin_width) {
  return bin_width * std::accumulate(density.begin(), density.end(), 0.0);
}

TEST(NisHistogram, ExpectsTheExponentialForTwoDegreesOfFreedom) {
  const std::vector<double> nis{0.05};
  const std::vector<int> dof{2};
  const auto histogram = nis_histogram(nis, dof);
  EXPECT_EQ(histogram.dof, 2);
  const double w = histogram.bin_width;
  EXPECT_NEAR(histogram.expected[3], (std::exp(-1.5 * w) - std::exp(-2.0 * w)) / w, 1e-12);
  EXPECT_NEAR(mass(histogram.expected, w), 0.998, 0.002);
}

TEST(NisHistogram, CountsAllOfTheMostFrequentDof) {
  const std::vector<double> nis{0.1, 0.1, 1e9, 0.1, std::nan("")};
  const std::vector<int> dof{1, 1, 1, 2, 1};
  const auto histogram = nis_histogram(nis, dof);
  EXPECT_EQ(histogram.dof, 1);
  EXPECT_NEAR(histogram.density[0] * histogram.bin_width, 2.0 / 3.0, 1e-12);
  EXPECT_NEAR(mass(histogram.density, histogram.bin_width), 2.0 / 3.0,
              1e-12);  // one lies beyond the last bin
}

TEST(NisHistogram, FollowsTheExpectationForChiSquareSamples) {
  std::mt19937_64 random(1);
  std::chi_squared_distribution<double> chi2(2.0);
  std::vector<double> nis(200'000);
  for (double& value : nis) value = chi2(random);
  const std::vector<int> dof(nis.size(), 2);
  const auto histogram = nis_histogram(nis, dof);
  for (std::size_t i = 0; i < histogram.density.size(); ++i) {
    const double p = histogram.expected[i] * histogram.bin_width;
    const double sigma = std::sqrt(p * (1.0 - p) / static_cast<double>(nis.size())) / histogram.bin_width;
    EXPECT_NEAR(histogram.density[i], histogram.expected[i], 5.0 * sigma);
  }
}

TEST(NisHistogram, IsEmptyWithoutObservations) {
  const auto histogram = nis_histogram({}, {});
  EXPECT_EQ(histogram.dof, 0);
  EXPECT_TRUE(histogram.density.empty());
}

}  // namespace
}  // namespace waymark
