#include "waymark/association/join_maps.hpp"

#include <gmock/gmock.h>

#include "support/matrix_near.hpp"
#include "waymark/core/gaussian.hpp"
#include "waymark/core/random.hpp"

namespace waymark {
namespace {

using test::matrix_near;
using testing::HasSubstr;

/// Maps of parts of one world, each in a frame of its own, with errors as their covariance claims them.
class World {
 public:
  explicit World(std::uint64_t seed) : random_(seed, StreamPurpose::kWorld) {
    for (double& coordinate : landmarks_) coordinate = random_.uniform(-10.0, 10.0);
  }

  MapState map(int begin, int end, const Pose2& T_map_world) {
    MapState map;
    const int count = end - begin;
    const Eigen::Index n = 3 + 2 * count;
    const Eigen::MatrixXd A = Eigen::MatrixXd::NullaryExpr(n, n, [&] { return 0.02 * random_.normal(); });
    map.covariance = A * A.transpose();
    const Eigen::VectorXd error = A * Eigen::VectorXd::NullaryExpr(n, [&] { return random_.normal(); });
    map.landmarks.resize(2 * count);
    for (int i = 0; i < count; ++i) {
      map.ids.push_back({LandmarkId::Family::kMarker, begin + i});
      map.landmarks.segment<2>(2 * i) = T_map_world * landmark(begin + i) + error.segment<2>(3 + 2 * i);
    }
    map.observations.assign(map.ids.size(), 2);
    map.T_world_robot = T_map_world;
    return map;
  }

  [[nodiscard]] Eigen::Vector2d landmark(int i) const { return landmarks_.segment<2>(2 * i); }

 private:
  RandomStream random_;
  Eigen::Matrix<double, 24, 1> landmarks_;
};

const Pose2 kFrame{3.0, -2.0, 2.5};

TEST(JoinMaps, PutsTheSecondIntoTheFrameOfTheFirst) {
  double d2 = 0.0;
  double nees = 0.0;
  constexpr int kRuns = 60;
  for (std::uint64_t seed = 0; seed < kRuns; ++seed) {
    World world(seed);
    const auto joined = join_maps(world.map(0, 8, {}), world.map(4, 12, kFrame), PoseOf::kFirst);
    if (!joined) continue;  // one in a thousand
    EXPECT_EQ(joined->common, 4);
    EXPECT_EQ(joined->dof, 5);
    d2 += joined->d2;
    ASSERT_EQ(joined->map.ids.size(), 12U);
    EXPECT_TRUE(is_covariance(joined->map.covariance));
    Eigen::VectorXd error(24);
    for (int i = 0; i < 12; ++i)
      error.segment<2>(2 * i) = joined->map.landmarks.segment<2>(2 * i) - world.landmark(i);
    nees += error.dot(joined->map.covariance.bottomRightCorner(24, 24).llt().solve(error));
  }
  // 99.9 % bands of means of 60 chi-square variables with 5 and 24 degrees of freedom.
  EXPECT_GT(d2 / kRuns, 3.7);
  EXPECT_LT(d2 / kRuns, 6.5);
  EXPECT_GT(nees / kRuns, 21.1);
  EXPECT_LT(nees / kRuns, 27.1);
}

TEST(JoinMaps, MakesBothSurer) {
  World world(1);
  const MapState first = world.map(0, 8, {});
  const auto joined = join_maps(first, world.map(4, 12, kFrame), PoseOf::kFirst);
  ASSERT_TRUE(joined) << joined.error().message;
  EXPECT_TRUE(
      (joined->map.covariance.diagonal().head(19).array() <= first.covariance.diagonal().array() + 1e-9)
          .all());
  EXPECT_LT(joined->map.covariance.trace(), 10.0 * first.covariance.trace());
  EXPECT_EQ(joined->map.observations[0], 2);
  EXPECT_EQ(joined->map.observations[5], 4);
}

TEST(JoinMaps, KeepsThePoseThatIsAskedFor) {
  World world(2);
  const MapState second = world.map(2, 12, kFrame);
  const auto joined = join_maps(world.map(0, 10, {}), second, PoseOf::kSecond);
  ASSERT_TRUE(joined) << joined.error().message;
  // It stands at the origin of the world.
  EXPECT_TRUE(matrix_near(joined->map.T_world_robot.position(), Eigen::Vector2d::Zero(), 0.6));
  EXPECT_TRUE(
      matrix_near(difference(joined->T_first_second, kFrame.inverse()), Eigen::Vector3d::Zero(), 0.5));
}

TEST(JoinMaps, NeedsTwoLandmarksInCommon) {
  World world(3);
  const auto joined = join_maps(world.map(0, 5, {}), world.map(4, 12, kFrame), PoseOf::kFirst);
  ASSERT_FALSE(joined);
  EXPECT_THAT(joined.error().message, HasSubstr("1 landmarks in common"));
}

TEST(JoinMaps, RefusesMapsThatContradictEachOther) {
  World world(4);
  MapState second = world.map(4, 12, kFrame);
  second.landmarks[2] += 3.0;
  const auto joined = join_maps(world.map(0, 8, {}), second, PoseOf::kFirst);
  ASSERT_FALSE(joined);
  EXPECT_THAT(joined.error().message, HasSubstr("contradict each other"));
}

TEST(JoinMaps, TwoCertainMapsOfOnePlaceAreOne) {
  World world(5);
  MapState map = world.map(0, 6, {});
  map.covariance.setZero();
  const auto joined = join_maps(map, map, PoseOf::kFirst);
  ASSERT_TRUE(joined) << joined.error().message;
  EXPECT_TRUE(matrix_near(joined->map.landmarks, map.landmarks, 1e-9));
}

}  // namespace
}  // namespace waymark
