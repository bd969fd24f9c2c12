#include "waymark/vision/new_corners.hpp"

#include <set>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "support/allocation_counter.hpp"
#include "waymark/vision/patch.hpp"

#include "squares.hpp"

namespace waymark::vision {
namespace {

constexpr CornerOptions kCorners{.threshold = 20, .arc = 9};

GreyImage frame(std::uint64_t seed) {
  RandomStream random(seed, StreamPurpose::kWorld);
  return test::squares(320, 240, random, 2.0);
}

FrameBudget plenty() {
  FrameBudget budget(BudgetKind::kWork);
  budget.start(std::chrono::seconds(1));
  return budget;
}

int cell_of(const Eigen::Vector2d& place) {
  return static_cast<int>(place.y() / 80.0) * 4 + static_cast<int>(place.x() / 80.0);
}

TEST(ShiTomasi, IsTheSmallerEigenvalueOfTheGradients) {
  const GreyImage image = frame(1);
  RandomStream random(2, StreamPurpose::kWorld);
  for (int i = 0; i < 50; ++i) {
    const int u = static_cast<int>(random.uniform(20.0, 300.0)),
              v = static_cast<int>(random.uniform(20.0, 220.0));
    Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
    for (int y = v - 8; y <= v + 7; ++y) {
      for (int x = u - 8; x <= u + 7; ++x) {
        const Eigen::Vector2d g(0.5 * (image(x + 1, y) - image(x - 1, y)),
                                0.5 * (image(x, y + 1) - image(x, y - 1)));
        sum += g * g.transpose();
      }
    }
    const double expected = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(sum).eigenvalues()(0);
    EXPECT_NEAR(shi_tomasi_score(image, u, v, 16), expected, 1e-6 * sum.trace());
  }
}

TEST(NewCorners, KeepTheirDistanceFromFeaturesFromEachOtherAndFromTheBorder) {
  RandomStream random(3, StreamPurpose::kWorld);
  NewCorners corners({.wanted = 100, .max_candidates = 20, .max_new = 20}, kCorners, 16, 320, 240);
  std::size_t found = 0;
  for (std::uint64_t seed = 10; seed < 30; ++seed) {
    const GreyImage image = frame(seed);
    std::vector<Eigen::Vector2d> features;
    for (int i = 0; i < 20; ++i)
      features.emplace_back(random.uniform(-10.0, 330.0), random.uniform(-10.0, 250.0));
    FrameBudget budget = plenty();
    for (const Corner& corner : corners.find(image, features, 0, budget)) {
      EXPECT_TRUE(cut_reference(image, corner.u, corner.v));
      for (const Eigen::Vector2d& other : features)
        EXPECT_GE((other - Eigen::Vector2d(corner.u, corner.v)).norm(), 20.0);
      features.emplace_back(corner.u, corner.v);
      ++found;
    }
  }
  EXPECT_GT(found, 60U);
}

TEST(NewCorners, AreLookedForOnlyInCellsThatHoldTooFewFeatures) {
  const GreyImage image = frame(4);
  NewCorners corners({.wanted = 12, .max_candidates = 20, .max_new = 20}, kCorners, 16, 320, 240);
  const std::vector<Eigen::Vector2d> features{{10.0, 10.0}, {150.0, 70.0}, {319.0, 239.0}};
  std::set<int> occupied;
  for (const Eigen::Vector2d& f : features) occupied.insert(cell_of(f));
  FrameBudget budget = plenty();
  const auto found = corners.find(image, features, 0, budget);
  EXPECT_EQ(found.size(), 9U);  // one in each of the others
  for (const Corner& corner : found) EXPECT_TRUE(occupied.insert(cell_of({corner.u, corner.v})).second);
}

TEST(NewCorners, ObeyTheirLimits) {
  const GreyImage image = frame(5);
  const auto number = [&](const NewCornerOptions& options, std::size_t features, int candidates) {
    NewCorners corners(options, kCorners, 16, 320, 240);
    FrameBudget budget = plenty();
    return corners.find(image, std::vector<Eigen::Vector2d>(features, {-100.0, -100.0}), candidates, budget)
        .size();
  };
  EXPECT_EQ(number({}, 0, 0), 4U);
  EXPECT_EQ(number({.max_new = 2}, 0, 0), 2U);
  EXPECT_EQ(number({}, 0, 7), 1U);
  EXPECT_EQ(number({}, 0, 8), 0U);
  EXPECT_EQ(number({}, 23, 0), 1U);
  EXPECT_EQ(number({}, 24, 0), 0U);
  EXPECT_EQ(number({}, 50, 20), 0U);
}

TEST(NewCorners, GoRoundTheImageAndStopWhenTimeIsUp) {
  const GreyImage image = frame(6);
  NewCorners corners({.max_new = 1}, kCorners, 16, 320, 240);
  std::set<int> cells;
  for (int i = 0; i < 12; ++i) {
    FrameBudget budget = plenty();
    for (const Corner& corner : corners.find(image, {}, 0, budget))
      cells.insert(cell_of({corner.u, corner.v}));
  }
  EXPECT_EQ(cells.size(), 12U);
  FrameBudget none(BudgetKind::kWork);
  none.start(Duration{1000});
  EXPECT_TRUE(corners.find(image, {}, 0, none).empty());
}

TEST(NewCorners, AllocateNothing) {
  const GreyImage image = frame(7);
  NewCorners corners({}, kCorners, 16, 320, 240);
  const test::AllocationCount count;
  for (int i = 0; i < 10; ++i) {
    FrameBudget budget = plenty();
    EXPECT_FALSE(corners.find(image, {}, 0, budget).empty());
  }
  EXPECT_EQ(count.allocations(), 0);
}

}  // namespace
}  // namespace waymark::vision
