#include "waymark/ekf/point_map.hpp"

#include <gtest/gtest.h>

#include "support/matrix_near.hpp"

namespace waymark::ekf {
namespace {

LandmarkId numbered(int number) { return {LandmarkId::Family::kMarker, number}; }

/// A robot that is unsure of its place, with markers 0, 1, 2 at (1, 0), (2, 0), (3, 0).
class MapOfThree : public testing::Test {
 protected:
  MapOfThree() {
    map_.table().begin_scan();
    map_.management().begin_scan();
    map_.state().predict({{}, Eigen::Vector3d(0.01, 0.01, 0.04).asDiagonal()});
    for (int k = 0; k < 3; ++k) append(k);
  }
  int append(int number) {
    return map_.append({1.0 + number, 0.0}, 1e-4 * Eigen::Matrix2d::Identity(), {}, {.id = numbered(number)});
  }
  [[nodiscard]] double x_m(int landmark) const { return map_.state().landmark(landmark).x(); }

  PointMap map_{{.capacity = 6}, 0, 1};
};

TEST_F(MapOfThree, APointTurnsWithTheRobot) {
  const Eigen::Matrix2d P = map_.state().landmark_covariance(1).topLeftCorner<2, 2>();
  const Eigen::Matrix2d expected = Eigen::Vector2d(0.01 + 1e-4, 0.01 + 4.0 * 0.04 + 1e-4).asDiagonal();
  EXPECT_TRUE(test::matrix_near(P, expected, 1e-12));
}

TEST_F(MapOfThree, StateAndTableKeepTheSameIndices) {
  map_.remove(0);
  ASSERT_EQ(map_.table().size(), 2);
  ASSERT_EQ(map_.state().landmarks(), 2);
  EXPECT_EQ(map_.table().find(numbered(2)), 0);
  EXPECT_DOUBLE_EQ(x_m(0), 3.0);
  EXPECT_EQ(map_.place(0), Eigen::Vector2d(3.0, 0.0));
  EXPECT_EQ(map_.table().removed().size(), 1U);
}

TEST_F(MapOfThree, AHandleStaysWhenIndicesChange) {
  const int first = map_.append_point({7.0, 0.0});
  const int second = map_.append_point({8.0, 0.0});
  map_.remove(0);
  EXPECT_DOUBLE_EQ(x_m(map_.index_of_point(first)), 7.0);
  EXPECT_DOUBLE_EQ(x_m(map_.index_of_point(second)), 8.0);
  map_.remove_point(first);
  EXPECT_DOUBLE_EQ(x_m(map_.index_of_point(second)), 8.0);
  const int third = map_.append_point({9.0, 0.0});
  EXPECT_EQ(third, first) << "handles are used again";
  EXPECT_DOUBLE_EQ(x_m(map_.index_of_point(third)), 9.0);
  map_.remove_point(third);
  map_.remove_point(second);
  EXPECT_EQ(map_.table().size(), 2);
}

TEST_F(MapOfThree, PointsAreNotInTheMap) {
  static_cast<void>(map_.append_point({7.0, 0.0}));
  append(3);
  const Snapshot snapshot = map_.snapshot();
  const MapState saved = map_.save();
  ASSERT_EQ(snapshot.landmarks.size(), 4U);
  ASSERT_EQ(saved.ids.size(), 4U);
  EXPECT_EQ(saved.ids[3], numbered(3));
  EXPECT_DOUBLE_EQ(saved.landmarks[6], 4.0);
  EXPECT_EQ(saved.covariance.rows(), 3 + 2 * 4);
}

TEST_F(MapOfThree, RoomIsMadeByTheLeastUsefulButNeverByPoints) {
  const int point = map_.append_point({7.0, 0.0});
  append(3);
  append(4);
  EXPECT_FALSE(map_.make_room()) << "all are of this scan";
  map_.management().begin_scan();
  for (int k = 0; k < 5; ++k) {
    EXPECT_TRUE(map_.make_room());
    append(10 + k);
    map_.management().begin_scan();
  }
  EXPECT_EQ(map_.state().landmarks(), 6);
  EXPECT_DOUBLE_EQ(x_m(map_.index_of_point(point)), 7.0);
}

TEST_F(MapOfThree, IsLoadedAsItWasSaved) {
  const MapState saved = map_.save();
  PointMap again({.capacity = 6, .loaded = 3}, 0, 1);
  ASSERT_TRUE(again.load(saved));
  EXPECT_EQ(again.save().landmarks, saved.landmarks);
  EXPECT_EQ(again.save().covariance, saved.covariance);
  EXPECT_EQ(again.table().find(numbered(2)), 2);
  EXPECT_FALSE(again.load(saved)) << "only before the first";
}

}  // namespace
}  // namespace waymark::ekf
