#include "waymark/ekf/duplicates.hpp"

#include <gtest/gtest.h>

#include "support/circle_world.hpp"
#include "support/unknown_identity_observations.hpp"
#include "waymark/association/gate.hpp"
#include "waymark/ekf/ekf_slam.hpp"

namespace waymark {
namespace {

using test::CircleWorld;
using test::drive;
using test::nearest_m;

/// Landmarks on the x axis, each known to a decimetre, of which the first was just observed.
class LandmarksInARow : public testing::Test {
 protected:
  /// Returns the index.
  int append(double x_m, const Existence& existence) {
    const LandmarkRecord record{
        .id = map_.table().unused_id(), .identity = Identity::kUnknown, .existence = existence};
    return map_.append({x_m, 0.0}, 0.01 * Eigen::Matrix2d::Identity(), {}, record);
  }
  [[nodiscard]] std::optional<ekf::Duplicate> find(int observed) {
    map_.table().begin_scan();
    map_.table().observe(observed);
    nearby_.refresh(map_, Eigen::Vector2d::Zero());
    return ekf::find_duplicate(map_, nearby_, model_, Gate(GateOptions{}).threshold(2));
  }

  AssociationModel model_{AssociationOptions{}, LandmarkSensor{}};
  ekf::PointMap map_{{.capacity = 16}, 0, 1};
  ekf::NearbyLandmarks nearby_{10.0};
};

TEST_F(LandmarksInARow, TheNearestThatWasNotObservedIsTheTwin) {
  const int landmark = append(5.0, {});
  append(5.3, {});
  const int twin = append(5.1, {});
  const auto found = find(landmark);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->landmark, landmark);
  EXPECT_EQ(found->twin, twin);
  EXPECT_GT(found->score, 0.0);
}

TEST_F(LandmarksInARow, TwoThatAreFarApartAreTwo) {
  const int landmark = append(5.0, {});
  append(6.5, {});
  EXPECT_FALSE(find(landmark));
}

TEST_F(LandmarksInARow, TwoThatAreCertainAreTwo) {
  const int landmark = append(5.0, Existence::certain());
  append(5.1, Existence::certain());
  EXPECT_FALSE(find(landmark));
}

TEST_F(LandmarksInARow, TheCertainOneStaysAndKeepsAllObservations) {
  const int landmark = append(5.0, {});
  const int twin = append(5.1, Existence::certain());
  const LandmarkId stays = map_.table()[twin].id;
  const auto found = find(landmark);
  ASSERT_TRUE(found);
  ASSERT_TRUE(ekf::merge(map_, *found));
  ASSERT_EQ(map_.table().size(), 1);
  EXPECT_EQ(map_.table()[0].id, stays);
  EXPECT_EQ(map_.table()[0].observations, 3);
  EXPECT_NEAR(map_.state().landmark(0).x(), 5.05, 1e-5);
}

TEST_F(LandmarksInARow, MergingTellsNothingOfTheHeading) {
  map_.state().predict({{}, Eigen::Vector3d(0.01, 0.01, 0.04).asDiagonal()});
  const int landmark = append(5.0, {});
  append(5.1, {});
  const auto found = find(landmark);
  ASSERT_TRUE(found);
  ASSERT_TRUE(ekf::merge(map_, *found));
  EXPECT_NEAR(map_.state().active().pose().covariance(2, 2), 0.04, 1e-12);
}

TEST(Duplicates, ALandmarkThatIsThereTwiceIsMerged) {
  CircleWorld world(6);
  EkfSlam filter({.capacity = 40, .unknown = UnknownAssociation{}}, world.sensor());
  drive(filter, world, 20);
  ASSERT_EQ(filter.snapshot().landmarks.size(), 8U);
  std::size_t removed = 0;
  for (int i = 0; i < 20; ++i) {
    filter.predict(world.move());
    removed += filter.correct(world.look()).removed.size();  // the same ones, now with names
  }
  EXPECT_GT(filter.merges(), 0);
  EXPECT_EQ(removed, 8U);
  const auto landmarks = filter.snapshot().landmarks;
  EXPECT_EQ(landmarks.size(), 8U);
  for (const LandmarkEstimate& landmark : landmarks)
    EXPECT_EQ(landmark.id.family, LandmarkId::Family::kMarker);
  for (const auto& p : world.landmarks()) EXPECT_LT(nearest_m(filter.snapshot(), p), 0.5);
}

}  // namespace
}  // namespace waymark
