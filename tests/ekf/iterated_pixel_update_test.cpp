#include "waymark/ekf/iterated_pixel_update.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "support/allocation_counter.hpp"
#include "support/matrix_near.hpp"

#include "pixel_world.hpp"

namespace waymark::ekf {
namespace {

using test::matrix_near;
using test::PixelWorld;

const Eigen::Vector3d kSeen(3.0, 0.5, 0.7);

/// A ray of unsure depth, which is believed to lead to 1.5 times its distance, seen from elsewhere.
struct UnsureRay : PixelWorld {
  explicit UnsureRay(const PixelSlamOptions& some = {}) : PixelWorld(some), options(some) {
    const Eigen::Vector3d camera = here().p_world_camera;
    ray = add_ray(1, camera + 1.5 * (kSeen - camera), 0.2);
    move({0.8, -0.3, 0.1}, 1e-3);
    found = find(ray, kSeen);
  }
  [[nodiscard]] LinearizedObservation linearization() const {
    return *prediction.linearize(map.map(), found, here());
  }
  [[nodiscard]] bool update() {
    IteratedPixelUpdate iterated(options, prediction);
    iterated.add(found, linearization());
    return iterated.apply(map.map());
  }

  PixelSlamOptions options;
  int ray = 0;
  FoundPixel found{};
};

TEST(IteratedPixelUpdate, LandsWhereThePixelIs) {
  UnsureRay iterated;
  UnsureRay once({.init = Initialization::kArticle});
  const double before_px = iterated.linearization().nu.norm();
  ASSERT_TRUE(iterated.update());
  ASSERT_TRUE(once.update());
  EXPECT_GT(before_px, 10.0);
  EXPECT_LT(iterated.linearization().nu.norm(), 0.5);
  EXPECT_LT(iterated.linearization().nu.norm(), 0.5 * once.linearization().nu.norm());
  const auto distance = [](const UnsureRay& world) {
    return (world.prediction.place(world.map.map(), world.ray) - kSeen).norm();
  };
  EXPECT_LT(distance(iterated), distance(once));
}

TEST(IteratedPixelUpdate, IsTheStatesOwnWhereTheArticleIsFollowedAndWithFirstEstimates) {
  for (const PixelSlamOptions& options : {PixelSlamOptions{.init = Initialization::kArticle},
                                          PixelSlamOptions{.consistency = Consistency::kFej}}) {
    UnsureRay world(options);
    UnsureRay plain(options);
    ASSERT_TRUE(world.update());
    const LinearizedObservation linearization = plain.linearization();
    ASSERT_TRUE(plain.map.map().state().update({&linearization, 1}));
    EXPECT_EQ(world.map.map().state().mean(), plain.map.map().state().mean());
    EXPECT_EQ(world.map.map().state().covariance(), plain.map.map().state().covariance());
  }
}

TEST(IteratedPixelUpdate, WhatIsAsGoodAsLinearIsNotLinearisedAnew) {
  PixelWorld world, plain;
  for (PixelWorld* each : {&world, &plain}) {
    each->load({kSeen}, 1e-3);
    each->move({0.1, 0.0, 0.0}, 1e-3);
  }
  const FoundPixel found = world.find(0, kSeen);
  const LinearizedObservation linearization =
      *world.prediction.linearize(world.map.map(), found, world.here());
  IteratedPixelUpdate update({}, world.prediction);
  update.add(found, linearization);
  ASSERT_TRUE(update.apply(world.map.map()));
  ASSERT_TRUE(plain.map.map().state().update({&linearization, 1}));
  EXPECT_EQ(world.map.map().state().mean(), plain.map.map().state().mean());
}

TEST(IteratedPixelUpdate, WithoutPixelsOrWithImpossibleOnesNothingChanges) {
  UnsureRay world;
  const Eigen::VectorXd before = world.map.map().state().mean();
  IteratedPixelUpdate update(world.options, world.prediction);
  EXPECT_TRUE(update.apply(world.map.map()));
  update.add(world.found, world.linearization());
  update.clear();
  EXPECT_TRUE(update.apply(world.map.map()));
  LinearizedObservation impossible = world.linearization();
  impossible.R.setConstant(std::numeric_limits<double>::quiet_NaN());
  update.add(world.found, impossible);
  EXPECT_FALSE(update.apply(world.map.map()));
  EXPECT_EQ(world.map.map().state().mean(), before);
}

TEST(IteratedPixelUpdate, AllocatesNothingOnceItIsMade) {
  UnsureRay world;
  const LinearizedObservation linearization = world.linearization();
  IteratedPixelUpdate update(world.options, world.prediction);
  const test::AllocationCount count;
  update.add(world.found, linearization);
  EXPECT_TRUE(update.apply(world.map.map()));
  EXPECT_EQ(count.allocations(), 0);
}

}  // namespace
}  // namespace waymark::ekf
