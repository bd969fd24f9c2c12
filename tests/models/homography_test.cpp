#include "waymark/models/homography.hpp"

#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "support/matrix_near.hpp"
#include "waymark/core/random.hpp"

namespace waymark {
namespace {

const Eigen::Matrix3d kTrue{{400.0, 30.0, 310.0}, {-25.0, 380.0, 250.0}, {0.2, -0.1, 1.0}};

std::vector<PlacePair> pairs_of(int count, double noise_px, RandomStream& random) {
  std::vector<PlacePair> pairs;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector2d from(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5));
    const Eigen::Vector2d noise(noise_px * random.normal(), noise_px * random.normal());
    pairs.push_back({from, (kTrue * from.homogeneous()).hnormalized() + noise});
  }
  return pairs;
}

TEST(Homography, IsFoundFromFourExactPairs) {
  RandomStream random(1, StreamPurpose::kSimulation);
  const auto H = homography(pairs_of(4, 0.0, random));
  ASSERT_TRUE(H);
  EXPECT_TRUE(test::matrix_near(*H, kTrue, 1e-5));
}

TEST(Homography, OfManyPairsLeavesLessThanTheirNoise) {
  RandomStream random(2, StreamPurpose::kSimulation);
  const auto H = homography(pairs_of(200, 0.5, random));
  ASSERT_TRUE(H);
  for (const PlacePair& exact : pairs_of(50, 0.0, random))
    EXPECT_LT(((*H * exact.from.homogeneous()).hnormalized() - exact.to).norm(), 0.4);
}

TEST(Homography, NeedsFourPairsNotOnALine) {
  RandomStream random(3, StreamPurpose::kSimulation);
  EXPECT_FALSE(homography(pairs_of(3, 0.0, random)));
  std::vector<PlacePair> line;
  for (int i = 0; i < 9; ++i) line.push_back({{0.1 * i, 0.0}, {10.0 * i, 20.0 + i}});
  EXPECT_FALSE(homography(line));
  EXPECT_FALSE(homography(std::vector<PlacePair>(5, PlacePair{{1.0, 2.0}, {3.0, 4.0}})));
}

}  // namespace
}  // namespace waymark
