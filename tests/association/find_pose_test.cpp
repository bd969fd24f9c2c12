#include "waymark/association/find_pose.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "support/matrix_near.hpp"
#include "waymark/core/random.hpp"

namespace waymark {
namespace {

constexpr double kSigma_m = 0.02;

/// Landmarks anywhere in 20 m x 20 m, and a robot that sees those within reach of it.
class Place {
 public:
  explicit Place(std::uint64_t seed, int landmarks = 30) : random_(seed, StreamPurpose::kWorld) {
    map_.landmarks.resize(2 * landmarks);
    for (double& coordinate : map_.landmarks) coordinate = random_.uniform(-10.0, 10.0);
    for (int i = 0; i < landmarks; ++i) map_.ids.push_back({LandmarkId::Family::kMarker, i});
    map_.observations.assign(map_.ids.size(), 1);
    const Eigen::Index n = 3 + 2 * landmarks;
    map_.covariance = kSigma_m * kSigma_m * Eigen::MatrixXd::Identity(n, n);
    robot_ = {random_.uniform(-4.0, 4.0), random_.uniform(-4.0, 4.0), random_.uniform(-3.0, 3.0)};
  }

  [[nodiscard]] const MapState& map() const { return map_; }
  [[nodiscard]] const Pose2& robot() const { return robot_; }

  std::vector<ObservedLandmark> look(int count, bool named) {
    std::vector<ObservedLandmark> seen;
    for (int i = 0; i < count; ++i) {
      const Eigen::Vector2d noise(random_.normal(), random_.normal());
      const Eigen::Vector2d p_world = map_.landmarks.segment<2>(2 * i);
      seen.push_back({named ? std::optional(map_.ids[static_cast<std::size_t>(i)]) : std::nullopt,
                      robot_.inverse() * p_world + kSigma_m * noise,
                      kSigma_m * kSigma_m * Eigen::Matrix2d::Identity()});
    }
    return seen;
  }

 private:
  RandomStream random_;
  MapState map_;
  Pose2 robot_;
};

void expect_robot(const Place& place, const PoseCandidates& found) {
  EXPECT_TRUE(
      test::matrix_near(difference(found.best.T_world_robot, place.robot()), Eigen::Vector3d::Zero(), 0.1));
}

TEST(FindPose, NamedLandmarksTellIt) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Place place(seed);
    const auto found = find_pose(place.look(6, true), place.map());
    EXPECT_GE(found.best.agreeing, 5);
    expect_robot(place, found);
  }
}

TEST(FindPose, AMisreadIdentityIsOutvoted) {
  Place place(3);
  auto seen = place.look(6, true);
  seen[2].id->number = 17;
  const auto found = find_pose(seen, place.map());
  EXPECT_EQ(found.best.agreeing, 5);
  EXPECT_EQ(found.best.landmarks[2], -1);
  expect_robot(place, found);
}

TEST(FindPose, LandmarksWithoutNamesAreFoundByTheirDistances) {
  int clear = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Place place(seed);
    const auto found = find_pose(place.look(8, false), place.map());
    if (found.best.agreeing < found.rival + 2) continue;
    ++clear;
    expect_robot(place, found);
  }
  EXPECT_GE(clear, 17);
}

TEST(FindPose, AnotherPlaceDoesNotFit) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Place here(seed);
    const Place there(seed + 100);
    EXPECT_LE(find_pose(here.look(8, true), there.map()).best.agreeing, 3);
  }
}

TEST(FindPose, OneLandmarkTellsNothing) {
  Place place(5);
  EXPECT_EQ(find_pose(place.look(1, true), place.map()).best.agreeing, 0);
  EXPECT_EQ(find_pose({}, place.map()).best.agreeing, 0);
}

TEST(FindPose, CountsPairsThatStandElsewhereAndWereSeenTwice) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Place place(seed);
    auto seen = place.look(6, true);
    for (ObservedLandmark& each : seen) each.times = 2;
    EXPECT_EQ(count_contradictions(seen, place.map()), 0) << "seed " << seed;
    seen[2].p_robot += Eigen::Vector2d(30.0, 0.0);
    EXPECT_EQ(count_contradictions(seen, place.map()), 5) << "seed " << seed;
    seen[2].times = 1;
    EXPECT_EQ(count_contradictions(seen, place.map()), 0) << "seed " << seed;
  }
}

}  // namespace
}  // namespace waymark
