#include "waymark/ekf/nearby_landmarks.hpp"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

namespace waymark::ekf {
namespace {

std::vector<int> within(const NearbyLandmarks& nearby, const Eigen::Vector2d& p_world, double radius_m) {
  std::vector<int> found;
  nearby.visit(p_world, radius_m, [&](int landmark) { found.push_back(landmark); });
  std::ranges::sort(found);
  return found;
}

TEST(NearbyLandmarks, AreThoseWithinTheRadius) {
  PointMap map({.capacity = 64}, 0, 1);
  for (int k = 0; k < 40; ++k)
    map.append({0.5 * k, 0.0}, 1e-4 * Eigen::Matrix2d::Identity(), {},
               {.id = {LandmarkId::Family::kMarker, k}});
  NearbyLandmarks nearby(10.0);
  nearby.refresh(map, Eigen::Vector2d::Zero());
  EXPECT_EQ(within(nearby, {5.0, 0.0}, 0.6), (std::vector<int>{9, 10, 11}));
  EXPECT_EQ(nearby.place(10), Eigen::Vector2d(5.0, 0.0));
  map.remove(10);
  nearby.refresh(map, Eigen::Vector2d::Zero());
  EXPECT_EQ(within(nearby, {5.0, 0.0}, 0.6), (std::vector<int>{9, 11}));
}

TEST(NearbyLandmarks, TheLargestSigmaIsOfAllLandmarks) {
  PointMap map({.capacity = 8}, 0, 1);
  for (int k = 1; k < 4; ++k) {
    const int landmark = map.append({1.0 * k, 0.0}, 0.01 * k * k * Eigen::Matrix2d::Identity(), {},
                                    {.id = {LandmarkId::Family::kMarker, k}});
    map.note_sigma(landmark);
  }
  NearbyLandmarks nearby(10.0);
  nearby.refresh(map, Eigen::Vector2d::Zero());
  EXPECT_NEAR(nearby.sigma_m(), 0.3 * std::sqrt(2.0), 1e-12);
}

TEST(NearbyLandmarks, ThoseOutOfReachOfACompressedMapAreAskedNowAndThen) {
  PointMap map({.capacity = 400, .compressed = Compress::kAlways, .submap = 48}, 0, 1);
  for (int k = 0; k < 300; ++k)
    map.append({0.5 * k, 0.0}, 1e-4 * Eigen::Matrix2d::Identity(), {},
               {.id = {LandmarkId::Family::kMarker, k}});
  ASSERT_FALSE(map.state().is_active(0));
  NearbyLandmarks nearby(10.0);
  const Eigen::Vector2d p_far(150.0, 0.0);
  for (int scan = 0; scan < 16; ++scan) {
    map.table().begin_scan();
    nearby.refresh(map, p_far);
  }
  for (int k = 0; k < 300; ++k) EXPECT_EQ(nearby.place(k), map.state().landmark(k).head<2>()) << k;
}

}  // namespace
}  // namespace waymark::ekf
