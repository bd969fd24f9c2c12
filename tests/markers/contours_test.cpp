#include "waymark/markers/contours.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace waymark::markers {
namespace {

ContrastMap bright_map(int width_px, int height_px) {
  ContrastMap map;
  map.width_px = width_px;
  map.height_px = height_px;
  map.values.assign(static_cast<std::size_t>(map.stride() * (height_px + 2)), 100);
  return map;
}

std::vector<Contour> trace(const ContrastMap& map, std::size_t points_min = 3) {
  std::vector<Contour> all;
  ContourTracer().trace(map, points_min, [&](const Contour& contour) { all.push_back(contour); });
  return all;
}

/// Positive where a contour goes clockwise in the image.
double area(const Contour& contour) {
  double twice = 0.0;
  for (std::size_t i = 0; i < contour.size(); ++i) {
    const auto a = contour[i].cast<double>(), b = contour[(i + 1) % contour.size()].cast<double>();
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * twice;
}

TEST(Contours, LieOnADiskToPartsOfAPixel) {
  ContrastMap map = bright_map(60, 50);
  const Eigen::Vector2d middle(30.3, 24.6);
  constexpr double kRadius_px = 15.2;
  for (int v = 0; v < 50; ++v)
    for (int u = 0; u < 60; ++u)
      map.row(v)[u] = static_cast<std::int16_t>(
          std::lround(200.0 * ((Eigen::Vector2d(u, v) - middle).norm() - kRadius_px)));
  const auto contours = trace(map);
  ASSERT_EQ(contours.size(), 1U);
  for (const auto& p : contours[0]) EXPECT_NEAR((p.cast<double>() - middle).norm(), kRadius_px, 0.02);
  EXPECT_NEAR(area(contours[0]), M_PI * kRadius_px * kRadius_px, 3.0);
}

TEST(Contours, GoTheOtherWayAroundWhatIsBright) {
  ContrastMap map = bright_map(20, 20);
  for (int v = 3; v < 15; ++v)
    for (int u = 3; u < 15; ++u) map.row(v)[u] = -100;
  for (int v = 7; v < 11; ++v)
    for (int u = 7; u < 11; ++u) map.row(v)[u] = 100;
  const auto contours = trace(map);
  ASSERT_EQ(contours.size(), 2U);
  EXPECT_NEAR(area(contours[0]), 144.0, 1.0);
  EXPECT_NEAR(area(contours[1]), -16.0, 1.0);
}

TEST(Contours, JoinWhatTouchesAtACornerWhereTheMeanIsDark) {
  for (const auto dark : {std::int16_t{-50}, std::int16_t{-150}}) {
    ContrastMap map = bright_map(12, 12);
    for (int i = 0; i < 4; ++i)
      for (int k = 0; k < 4; ++k) {
        map.row(2 + i)[2 + k] = dark;
        map.row(6 + i)[6 + k] = dark;
      }
    EXPECT_EQ(trace(map).size(), dark == -150 ? 1U : 2U);
  }
}

TEST(Contours, CloseAtTheEdgeOfTheImage) {
  ContrastMap map = bright_map(9, 6);
  for (int v = 0; v < 6; ++v)
    for (int u = 0; u < 9; ++u) map.row(v)[u] = -100;
  const auto contours = trace(map);
  ASSERT_EQ(contours.size(), 1U);
  EXPECT_EQ(contours[0].size(), 2U * (9 + 6));
}

TEST(Contours, BelowTheSmallestAreLeftOut) {
  ContrastMap map = bright_map(30, 10);
  map.row(5)[4] = -100;
  for (int u = 10; u < 20; ++u) map.row(5)[u] = -100;
  EXPECT_EQ(trace(map, 3).size(), 2U);
  EXPECT_EQ(trace(map, 5).size(), 1U);
}

TEST(Contours, OfANewMapDoNotDependOnTheLast) {
  ContourTracer tracer;
  ContrastMap map = bright_map(20, 20);
  for (int u = 5; u < 12; ++u) map.row(8)[u] = -100;
  for (int round = 0; round < 2; ++round) {
    int contours = 0;
    tracer.trace(map, 3, [&](const Contour&) { ++contours; });
    EXPECT_EQ(contours, 1);
  }
}

}  // namespace
}  // namespace waymark::markers
