#include "waymark/ekf/depth_initialiser.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "support/allocation_counter.hpp"

#include "pixel_world.hpp"

namespace waymark::ekf {
namespace {

using test::corner_id;
using test::PixelWorld;

const Eigen::Matrix2d kSmallNoise = 0.01 * Eigen::Matrix2d::Identity();

/// A robot that drives past a corner, 2 cm an image, and weighs it in every one.
struct PassingBy : PixelWorld {
  explicit PassingBy(const PixelSlamOptions& some = {})
      : PixelWorld(some), initialiser(some, map, prediction) {
    begin_image();
  }
  void begin_image() {
    map.begin_image();
    initialiser.begin_image();
  }
  [[nodiscard]] Outcome begin(int number) {
    return initialiser.begin(corner_id(number), pixel(corner), kSmallNoise);
  }
  /// False where the pixel is outside of its gate.
  [[nodiscard]] bool weigh_in_next_image(double off_px = 0.0) {
    move({0.02, 0.0, 0.0}, 1e-4);
    begin_image();
    return initialiser.weigh(corner_id(1), pixel(corner) + Eigen::Vector2d(off_px, 0.0), kSmallNoise);
  }

  DepthInitialiser initialiser;
  Eigen::Vector3d corner{2.5, 0.9, 0.8};
};

TEST(DepthInitialiser, ACandidateThatIsSeenFromElsewhereBecomesARayOfItsDepth) {
  PassingBy world;
  ASSERT_EQ(world.begin(1), Outcome::kAdded);
  EXPECT_TRUE(world.initialiser.knows(corner_id(1)));
  int images = 1;
  for (; !world.initialiser.is_ready(corner_id(1)); ++images) {
    ASSERT_LT(images, DepthInitialiser::kMaxImages);
    const auto expected = world.initialiser.expect();
    ASSERT_EQ(expected.size(), 1U);
    EXPECT_EQ(expected[0].id, corner_id(1));
    ASSERT_TRUE(world.weigh_in_next_image());
  }
  EXPECT_GT(images, DepthInitialiser::kMinImages);
  const auto feature = world.initialiser.accept(corner_id(1));
  ASSERT_TRUE(feature);
  EXPECT_FALSE(world.initialiser.knows(corner_id(1)));
  EXPECT_EQ(world.initialiser.size(), 0);
  const PixelMap& map = world.map.map();
  EXPECT_EQ(map.feature(*feature).id, corner_id(1));
  EXPECT_EQ(map.feature(*feature).observations, images);
  ASSERT_FALSE(map.feature(*feature).is_point());
  EXPECT_EQ(map.state().landmarks(), 2) << "the ray and its anchor";
  const int element = map.feature(*feature).element;
  const double rho_sigma = std::sqrt(map.state().landmark_covariance(element)(2, 2));
  EXPECT_NEAR(map.state().landmark(element)[2], 1.0 / 2.4, 0.06);
  EXPECT_GT(rho_sigma, 0.03) << "less sure than the particles are, of which each stands for 0.019 / m";
}

TEST(DepthInitialiser, AsInTheArticleItBecomesAPoint) {
  PassingBy world({.init = Initialization::kArticle});
  ASSERT_EQ(world.begin(1), Outcome::kAdded);
  while (!world.initialiser.is_ready(corner_id(1))) ASSERT_TRUE(world.weigh_in_next_image());
  const auto feature = world.initialiser.accept(corner_id(1));
  ASSERT_TRUE(feature);
  world.begin_image();
  const PixelMap& map = world.map.map();
  EXPECT_TRUE(map.feature(*feature).is_point());
  EXPECT_EQ(map.state().landmarks(), 1) << "its anchor has left";
  EXPECT_LT((map.state().landmark(map.feature(*feature).element) - world.corner).norm(), 0.5);
}

TEST(DepthInitialiser, FromOnePlaceDepthDoesNotShowAndTheArticleWaitsForIt) {
  for (const auto init : {Initialization::kDelayed, Initialization::kArticle}) {
    PassingBy world({.init = init});
    ASSERT_EQ(world.begin(1), Outcome::kAdded);
    for (int images = 0; images < DepthInitialiser::kMaxImages; ++images) {
      EXPECT_FALSE(world.initialiser.is_ready(corner_id(1)));
      ASSERT_TRUE(world.initialiser.weigh(corner_id(1), world.pixel(world.corner), kSmallNoise));
    }
    EXPECT_EQ(world.initialiser.is_ready(corner_id(1)), init == Initialization::kDelayed);
  }
}

TEST(DepthInitialiser, AWildPixelIsRefusedAndLeavesTheDepthsAlone) {
  PassingBy world;
  ASSERT_EQ(world.begin(1), Outcome::kAdded);
  ASSERT_TRUE(world.weigh_in_next_image());
  const Expectation before = world.initialiser.expect()[0];
  EXPECT_FALSE(world.initialiser.weigh(corner_id(1), world.pixel(world.corner) + Eigen::Vector2d(0.0, 40.0),
                                       kSmallNoise));
  const Expectation after = world.initialiser.expect()[0];
  EXPECT_EQ(after.predicted_px, before.predicted_px);
  EXPECT_EQ(after.S, before.S);
}

TEST(DepthInitialiser, WhoIsNotFoundOrTakesTooLongIsGivenUp) {
  for (const bool missed : {true, false}) {
    PassingBy world;
    ASSERT_EQ(world.begin(1), Outcome::kAdded);
    int images = 0;
    for (; world.initialiser.knows(corner_id(1)); ++images) {
      ASSERT_LE(images, 2 * DepthInitialiser::kMaxImages);
      if (missed) world.initialiser.missed(corner_id(1));
      world.begin_image();
    }
    EXPECT_EQ(images, missed ? 10 : 2 * DepthInitialiser::kMaxImages + 1);
    ASSERT_EQ(world.map.removed().size(), 1U);
    EXPECT_EQ(world.map.removed()[0], corner_id(1));
    EXPECT_EQ(world.map.map().state().landmarks(), 0) << "its anchor has left as well";
  }
}

TEST(DepthInitialiser, CandidatesOfOneImageShareAnAnchorAndThereAreOnlySoMany) {
  PassingBy world({.max_candidates = 3});
  for (const int number : {1, 2, 3}) EXPECT_EQ(world.begin(number), Outcome::kAdded);
  EXPECT_EQ(world.map.map().state().landmarks(), 1);
  EXPECT_EQ(world.begin(4), Outcome::kMapFull);
  EXPECT_EQ(world.initialiser.size(), 3);
}

TEST(DepthInitialiser, WhereTheMapHasNoRoomACandidateIsGivenUp) {
  PassingBy world({.capacity = 1});
  world.load({{4.0, 0.0, 0.5}});  // of this image, so that it stays
  ASSERT_EQ(world.begin(1), Outcome::kAdded);
  EXPECT_FALSE(world.initialiser.accept(corner_id(1)));
  ASSERT_EQ(world.map.removed().size(), 1U);
  EXPECT_EQ(world.map.removed()[0], corner_id(1));
  EXPECT_EQ(world.initialiser.size(), 0);
}

TEST(DepthInitialiser, AllocatesNothingOnceItIsMade) {
  PassingBy world({.capacity = 3});
  const test::AllocationCount count;
  for (int number = 0; number < 20; ++number) {
    ASSERT_EQ(world.begin(number), Outcome::kAdded);
    static_cast<void>(world.initialiser.expect());
    static_cast<void>(world.initialiser.weigh(corner_id(number), world.pixel(world.corner), kSmallNoise));
    ASSERT_TRUE(world.initialiser.accept(corner_id(number)));
    world.begin_image();
  }
  EXPECT_EQ(count.allocations(), 0);
}

}  // namespace
}  // namespace waymark::ekf
