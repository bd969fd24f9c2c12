#include "waymark/ekf/locate.hpp"

#include <cmath>
#include <vector>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "support/matrix_near.hpp"
#include "waymark/core/random.hpp"

namespace waymark::ekf {
namespace {

constexpr double kViewSigma_m = 0.05;

/// Ranges to one point from several.
struct Ranges {
  std::vector<Eigen::Vector2d> places;
  std::vector<double> ranges_m;

  Ranges(std::vector<Eigen::Vector2d> from, const Eigen::Vector2d& p_world, std::uint64_t seed)
      : places(std::move(from)) {
    RandomStream random(seed, StreamPurpose::kSimulation);
    for (const auto& place : places)
      ranges_m.push_back((p_world - place).norm() + kViewSigma_m * random.normal());
  }

  [[nodiscard]] std::optional<LinearizedViews> operator()(const Eigen::Vector2d& p_world) const {
    const auto m = std::ssize(places);
    LinearizedViews views{
        Eigen::VectorXd(m), {m, 2}, kViewSigma_m * kViewSigma_m * Eigen::MatrixXd::Identity(m, m)};
    for (Eigen::Index i = 0; i < m; ++i) {
      const auto k = static_cast<std::size_t>(i);
      const Eigen::Vector2d d = p_world - places[k];
      views.nu[i] = ranges_m[k] - d.norm();
      views.H.row(i) = d.transpose() / d.norm();
    }
    return views;
  }
};

const std::vector<Eigen::Vector2d> kAround{{5, 0}, {0, 5}, {-5, 0}, {0, -5}, {3, 4}, {-4, 3}};
const std::vector<Eigen::Vector2d> kOnOneLine{{0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0}, {5, 0}};
const std::vector<Eigen::Vector2d> kAroundTheCorner{{0, 0}, {1, 0}, {2, 0}, {3, 0}, {3, 1}, {3, 2}};
const Eigen::Vector2d kPoint(1.0, 4.0);

TEST(Locate, FindsAPointByRangesFromAroundACornerWithinItsUncertainty) {
  double d2 = 0.0;
  constexpr int kRuns = 40;
  for (std::uint64_t seed = 0; seed < kRuns; ++seed) {
    const auto located = locate(kAround, Ranges(kAroundTheCorner, kPoint, seed));
    ASSERT_TRUE(located);
    const Eigen::Vector2d error = located->p_world - kPoint;
    d2 += error.dot(located->covariance.inverse() * error);
  }
  // 99.9 % band of a mean of 40 chi-square variables with 2 degrees of freedom.
  EXPECT_GT(d2 / kRuns, 1.1);
  EXPECT_LT(d2 / kRuns, 3.2);
}

TEST(Locate, RefusesToChooseBetweenMirrorImages) {
  EXPECT_FALSE(locate(kAround, Ranges(kOnOneLine, kPoint, 1)));
}

TEST(Locate, RefusesWhatNoPointExplains) {
  Ranges ranges(kAroundTheCorner, kPoint, 1);
  ranges.ranges_m[2] += 1.0;
  EXPECT_FALSE(locate(kAround, ranges));
}

TEST(Locate, RefusesTwoViewsThatLeaveNothingToCheck) {
  EXPECT_FALSE(locate(kAround, Ranges({{0, 0}, {3, 0}}, kPoint, 1)));
  EXPECT_FALSE(locate({}, Ranges(kAroundTheCorner, kPoint, 1)));
}

TEST(Descend, EndsWhereTheGradientVanishes) {
  const Ranges ranges(kAroundTheCorner, kPoint, 3);
  const auto found = descend({0.0, 5.0}, ranges);
  ASSERT_TRUE(found);
  const auto views = ranges(found->p_world);
  const Eigen::Vector2d gradient = views->H.transpose() * views->nu / (kViewSigma_m * kViewSigma_m);
  EXPECT_LT(gradient.dot(found->covariance * gradient), 1e-4);
  EXPECT_NEAR(found->nis, views->nu.squaredNorm() / (kViewSigma_m * kViewSigma_m), 1e-9);
}

TEST(Descend, ReturnsNothingWhereADirectionStaysOpen) {
  EXPECT_FALSE(descend({1.0, 1.0}, Ranges({{0, 0}}, {2.0, 2.0}, 1)));
}

}  // namespace
}  // namespace waymark::ekf
