#include "waymark/ekf/pixel_update.hpp"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "support/allocation_counter.hpp"
#include "support/matrix_near.hpp"
#include "waymark/core/gaussian.hpp"

#include "pixel_world.hpp"

namespace waymark::ekf {
namespace {

using test::matrix_near;
using test::PixelWorld;

/// A robot in front of a wall of corners, which is not quite where it believes to be.
struct BeforeAWall : PixelWorld {
  explicit BeforeAWall(int corners = 12, const PixelSlamOptions& options = {})
      : PixelWorld(options), points(test::wall(corners)), update(options, map, prediction) {
    load(points, 0.003);
    move({0.2, 0.0, 0.0}, 0.01);
    truth = truth * Pose2{0.01, 0.015, 0.01};
    map.begin_picture();
    for (int i = 0; i < corners; ++i) found.push_back(find(i, points[static_cast<std::size_t>(i)]));
  }
  [[nodiscard]] double error_m() const {
    return (map.map().state().pose().T_world_robot.position() - truth.position()).norm();
  }
  [[nodiscard]] std::vector<Innovation> run() {
    const auto innovations = update.update(found);
    return {innovations.begin(), innovations.end()};
  }

  std::vector<Eigen::Vector3d> points;
  PixelUpdate update;
  std::vector<FoundPixel> found;
};

TEST(PixelUpdate, BringsTheRobotToWhereThePixelsSayThatItIs) {
  BeforeAWall world;
  const double before_m = world.error_m();
  const FoundPixel& first = world.found[0];
  const Sighting sighting = *world.prediction.linearize(world.map.map(), first, world.here());
  const Eigen::Matrix2d S = world.map.map().state().innovation_covariance(sighting);
  const double nis = *mahalanobis_squared<2>(sighting.nu, S);
  const auto innovations = world.run();
  ASSERT_EQ(innovations.size(), world.points.size());
  for (std::size_t i = 0; i < innovations.size(); ++i) {
    EXPECT_EQ(innovations[i].outcome, Outcome::kMatched) << i;
    EXPECT_EQ(innovations[i].landmark, test::corner_id(static_cast<int>(i)));
    EXPECT_EQ(innovations[i].dof, 2);
    EXPECT_EQ(world.map.map().feature(static_cast<int>(i)).observations, 2);
  }
  EXPECT_EQ(innovations[0].nis, nis);
  EXPECT_EQ(innovations[0].log_density, log_gaussian<2>(nis, S));
  EXPECT_NEAR(innovations[0].gate, 18.42, 0.01);
  EXPECT_LT(world.error_m(), before_m);
  EXPECT_LT(world.prediction.linearize(world.map.map(), first, world.here())->nu.norm(),
            0.2 * sighting.nu.norm());
}

TEST(PixelUpdate, AWildPixelIsGatedAndChangesNothing) {
  BeforeAWall with, without;
  with.found[4].z_px.x() += 30.0;
  without.found.erase(without.found.begin() + 4);
  const auto innovations = with.run();
  static_cast<void>(without.run());
  EXPECT_EQ(innovations[4].outcome, Outcome::kGated);
  EXPECT_EQ(std::ranges::count(innovations, Outcome::kMatched, &Innovation::outcome), 11);
  EXPECT_EQ(with.map.map().feature(4).observations, 1);
  EXPECT_TRUE(matrix_near(with.map.map().state().mean(), without.map.map().state().mean(), 1e-12));
}

TEST(PixelUpdate, WhoIsAlwaysOutvotedIsRetired) {
  BeforeAWall world;
  for (int k = 0; k < 10; ++k) {
    world.found[4] = world.find(4, world.points[4]);
    world.found[4].z_px.x() += 30.0;
    EXPECT_EQ(world.run()[4].outcome, Outcome::kGated);
  }
  world.map.retire();
  ASSERT_EQ(world.map.removed().size(), 1U);
  EXPECT_EQ(world.map.removed()[0], test::corner_id(4));
}

TEST(PixelUpdate, WhatHardlyAgreesIsRescuedWhereItFitsInTheEnd) {
  // A noisy one, beyond the gate of agreement, 9.21, but within that of a sighting, 18.42.
  BeforeAWall world;
  world.found[4].R = 4.0 * Eigen::Matrix2d::Identity();
  world.found[4].z_px.x() -= 7.0;
  BeforeAWall others;
  others.found.erase(others.found.begin() + 4);
  static_cast<void>(others.run());
  const Sighting left = *others.prediction.linearize(others.map.map(), world.found[4], others.here());
  const double nis = *mahalanobis_squared<2>(left.nu, others.map.map().state().innovation_covariance(left));
  ASSERT_GT(nis, 10.0);
  ASSERT_LT(nis, 18.0);
  const auto innovations = world.run();
  EXPECT_EQ(innovations[4].outcome, Outcome::kMatched);
  EXPECT_LT(innovations[4].nis, nis) << "it is still that of before the update";
  EXPECT_FALSE(matrix_near(world.map.map().state().mean(), others.map.map().state().mean(), 1e-9));
}

TEST(PixelUpdate, ManyGoInBlocksEachLinearisedAtWhatTheEarlierOnesFound) {
  constexpr int kCorners = 40;
  BeforeAWall at_once(kCorners), in_two(kCorners);
  const auto innovations = at_once.run();
  ASSERT_EQ(innovations.size(), static_cast<std::size_t>(kCorners));
  const std::span<const FoundPixel> all(in_two.found);
  static_cast<void>(in_two.update.update(all.first(State::kMaxSightings)));
  const auto rest = in_two.update.update(all.subspan(State::kMaxSightings));
  for (std::size_t k = 0; k < rest.size(); ++k)
    EXPECT_EQ(rest[k].nis, innovations[State::kMaxSightings + k].nis);
  EXPECT_EQ(at_once.map.map().state().mean(), in_two.map.map().state().mean());
  EXPECT_EQ(at_once.map.map().state().covariance(), in_two.map.map().state().covariance());
}

TEST(PixelUpdate, AsInTheArticleEachIsGatedByItself) {
  BeforeAWall world(
      12, {.capacity = 20, .consistency = Consistency::kStandard, .update = UpdateMethod::kTextbook});
  world.map.map().state().predict({{}, 0.01 * Eigen::Matrix3d::Identity()});
  world.found[4].z_px.x() += 20.0;  // in its own wide ellipse still
  world.found[5].z_px.x() += 300.0;
  const auto innovations = world.run();
  EXPECT_EQ(innovations[4].outcome, Outcome::kMatched);
  EXPECT_EQ(innovations[5].outcome, Outcome::kGated);
}

TEST(PixelUpdate, WhatCannotBeSeenIsUnusable) {
  BeforeAWall world;
  world.move({0.0, 0.0, 3.1}, 0.001);
  const auto innovations = world.run();
  EXPECT_EQ(std::ranges::count(innovations, Outcome::kUnusable, &Innovation::outcome), 12);
  EXPECT_EQ(innovations[3].dof, 0);
  EXPECT_EQ(innovations[3].landmark, test::corner_id(3));
  EXPECT_FALSE(world.update.confirm(world.found[0]));
}

TEST(PixelUpdate, OneThatIsConfirmedNeedsNobodyToAgree) {
  BeforeAWall world;
  const double variance = world.map.map().state().pose().covariance.trace();
  const auto innovation = world.update.confirm(world.found[0]);
  ASSERT_TRUE(innovation);
  EXPECT_EQ(innovation->outcome, Outcome::kMatched);
  EXPECT_EQ(innovation->landmark, test::corner_id(0));
  EXPECT_LT(world.map.map().state().pose().covariance.trace(), variance);
}

/// A ray of unsure depth, which is believed to lead to 1.5 times its distance, seen from elsewhere.
struct UnsureRay : PixelWorld {
  explicit UnsureRay(const PixelSlamOptions& options = {})
      : PixelWorld(options), update(options, map, prediction) {
    const Eigen::Vector3d camera = here().p_world_camera;
    found.feature = add_ray(1, camera + 1.5 * (seen - camera), 0.2);
    move({0.8, -0.3, 0.1}, 1e-3);
    found = find(found.feature, seen);
  }
  [[nodiscard]] Sighting sighting() const { return *prediction.linearize(map.map(), found, here()); }
  [[nodiscard]] double error_m() const { return (prediction.place(map.map(), found.feature) - seen).norm(); }

  Eigen::Vector3d seen{3.0, 0.5, 0.7};
  FoundPixel found{};
  PixelUpdate update;
};

TEST(PixelUpdate, ARayOfUnsureDepthLandsWhereItsPixelIs) {
  UnsureRay iterated;
  UnsureRay once({.init = Initialization::kArticle});
  EXPECT_GT(iterated.sighting().nu.norm(), 10.0);
  ASSERT_TRUE(iterated.update.confirm(iterated.found));
  ASSERT_TRUE(once.update.confirm(once.found));
  EXPECT_LT(iterated.sighting().nu.norm(), 0.5);
  EXPECT_LT(iterated.sighting().nu.norm(), 0.5 * once.sighting().nu.norm());
  EXPECT_LT(iterated.error_m(), once.error_m());
}

TEST(PixelUpdate, IsLinearisedOnceWhereTheArticleIsFollowedAndWithFirstEstimates) {
  for (const PixelSlamOptions& options : {PixelSlamOptions{.init = Initialization::kArticle},
                                          PixelSlamOptions{.consistency = Consistency::kFej}}) {
    UnsureRay world(options);
    UnsureRay plain(options);
    ASSERT_TRUE(world.update.confirm(world.found));
    const Sighting sighting = plain.sighting();
    ASSERT_TRUE(plain.map.map().state().update({&sighting, 1}));
    EXPECT_EQ(world.map.map().state().mean(), plain.map.map().state().mean());
    EXPECT_EQ(world.map.map().state().covariance(), plain.map.map().state().covariance());
  }
}

TEST(PixelUpdate, AllocatesNothingOnceItIsMade) {
  BeforeAWall world(40);
  const test::AllocationCount count;
  static_cast<void>(world.update.update(world.found));
  static_cast<void>(world.update.confirm(world.found[0]));
  EXPECT_EQ(count.allocations(), 0);
}

}  // namespace
}  // namespace waymark::ekf
