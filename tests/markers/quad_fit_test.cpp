#include "waymark/markers/quad_fit.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "waymark/core/random.hpp"

namespace waymark::markers {
namespace {

/// Points about a pixel apart along a polygon, from the middle of its first side.
Contour along(const std::vector<Eigen::Vector2d>& corners, double noise_px = 0.0) {
  RandomStream random(3, StreamPurpose::kWorld);
  Contour contour;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector2d side = corners[(i + 1) % corners.size()] - corners[i];
    const int points = static_cast<int>(side.norm());
    for (int k = 0; k < points; ++k) {
      const Eigen::Vector2d noise(noise_px * random.normal(), noise_px * random.normal());
      contour.push_back((corners[i] + (k + 0.5) / points * side + noise).cast<float>());
    }
  }
  std::ranges::rotate(contour, contour.begin() + std::ssize(contour) / 8);
  return contour;
}

/// To the nearest corner of the other, the farthest.
double distance_px(const Corners& found, const std::vector<Eigen::Vector2d>& truth) {
  double farthest = 0.0;
  for (const auto& corner : truth) {
    double nearest = 1e9;
    for (const auto& each : found) nearest = std::min(nearest, (each - corner).norm());
    farthest = std::max(farthest, nearest);
  }
  return farthest;
}

const std::vector<Eigen::Vector2d> kQuad{{20.0, 10.0}, {70.0, 22.0}, {64.0, 80.0}, {11.0, 57.0}};

TEST(QuadFit, FindsTheCorners) {
  const auto quad = fit_quad(along(kQuad), 5.0);
  ASSERT_TRUE(quad);
  EXPECT_LT(distance_px(*quad, kQuad), 0.01);
}

TEST(QuadFit, AveragesNoise) {
  const auto quad = fit_quad(along(kQuad, 0.3), 5.0);
  ASSERT_TRUE(quad);
  EXPECT_LT(distance_px(*quad, kQuad), 0.4);
}

/// Of a slanted square with perspective, the corner farthest from another may be its neighbour.
TEST(QuadFit, FindsNarrowOnes) {
  const std::vector<Eigen::Vector2d> narrow{{10.0, 10.0}, {18.0, 12.0}, {18.0, 32.0}, {10.0, 36.0}};
  const auto quad = fit_quad(along(narrow), 5.0);
  ASSERT_TRUE(quad);
  EXPECT_LT(distance_px(*quad, narrow), 0.1);
}

TEST(QuadFit, GoesClockwise) {
  const auto quad = fit_quad(along(kQuad), 5.0);
  ASSERT_TRUE(quad);
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector2d a = (*quad)[(i + 1) % 4] - (*quad)[i],
                          b = (*quad)[(i + 2) % 4] - (*quad)[(i + 1) % 4];
    EXPECT_GT(a.x() * b.y() - a.y() * b.x(), 0.0);
  }
}

TEST(QuadFit, RefusesWhatIsBrightInside) {
  EXPECT_FALSE(fit_quad(along({kQuad.rbegin(), kQuad.rend()}), 5.0));
}

TEST(QuadFit, RefusesOtherShapes) {
  EXPECT_FALSE(fit_quad(along({{10.0, 10.0}, {60.0, 10.0}, {35.0, 60.0}}), 5.0)) << "triangle";
  std::vector<Eigen::Vector2d> circle, star;
  for (int i = 0; i < 60; ++i) {
    const double angle_rad = 2.0 * M_PI * i / 60;
    circle.push_back({50.0 + 30.0 * std::cos(angle_rad), 50.0 + 30.0 * std::sin(angle_rad)});
  }
  EXPECT_FALSE(fit_quad(along(circle), 5.0)) << "circle";
  for (int i = 0; i < 10; ++i) {
    const double angle_rad = 2.0 * M_PI * i / 10, r = i % 2 == 0 ? 40.0 : 16.0;
    star.push_back({50.0 + r * std::cos(angle_rad), 50.0 + r * std::sin(angle_rad)});
  }
  EXPECT_FALSE(fit_quad(along(star), 5.0)) << "star";
  EXPECT_FALSE(fit_quad(along({{10.0, 10.0}, {60.0, 10.0}, {25.0, 25.0}, {10.0, 60.0}}), 5.0)) << "dart";
}

TEST(QuadFit, RefusesWhatIsTooSmall) {
  const std::vector<Eigen::Vector2d> small{{10.0, 10.0}, {30.0, 10.0}, {30.0, 14.0}, {10.0, 14.0}};
  EXPECT_FALSE(fit_quad(along(small), 5.0));
  EXPECT_FALSE(fit_quad({{1.0F, 1.0F}, {2.0F, 1.0F}, {2.0F, 2.0F}}, 5.0));
}

}  // namespace
}  // namespace waymark::markers
