#include "waymark/association/contradictions.hpp"

#include <gtest/gtest.h>

namespace waymark {
namespace {

LandmarkId landmark_id(int number) { return {LandmarkId::Family::kMarker, number}; }

Observation seen_at(int number, double range_m) {
  return {landmark_id(number), RangeBearing{range_m, 0.0},
          Eigen::Matrix2d(Eigen::Vector2d(1e-4, 1e-4).asDiagonal())};
}

TEST(Contradictions, GoOnWhileObservationsAgree) {
  Contradictions contradictions(LandmarkSensor{});
  contradictions.contradict(landmark_id(1), seen_at(1, 3.0));
  EXPECT_EQ(contradictions.contradict(landmark_id(1), seen_at(1, 3.001)).observations, 2);
  const Contradiction& other = contradictions.contradict(landmark_id(1), seen_at(1, 4.0));
  EXPECT_EQ(other.observations, 1);
  EXPECT_EQ(other.in_a_row, 3);
  EXPECT_NEAR(contradictions.seen(other)->p_robot.x(), 4.0, 1e-12);
}

TEST(Contradictions, EndWithAnAcceptedObservationOfTheirLandmark) {
  Contradictions contradictions(LandmarkSensor{});
  contradictions.contradict(landmark_id(1), seen_at(1, 3.0));
  contradictions.support(landmark_id(2), true);
  EXPECT_NE(contradictions.find(landmark_id(1)), nullptr);
  contradictions.support(landmark_id(1), false);
  EXPECT_EQ(contradictions.find(landmark_id(1)), nullptr);
}

TEST(Contradictions, CountWhatSupportsThePoseMeanwhile) {
  Contradictions contradictions(LandmarkSensor{});
  contradictions.support(landmark_id(2), true);
  const Contradiction began = contradictions.contradict(landmark_id(1), seen_at(1, 3.0));
  EXPECT_EQ(contradictions.supporters_since(began), 0);
  for (int i = 0; i < 3; ++i) contradictions.support(landmark_id(2), true);
  contradictions.support(landmark_id(3), true);
  contradictions.support(landmark_id(4), false);  // not connected with the map
  EXPECT_EQ(contradictions.support_since(began), 4);
  EXPECT_EQ(contradictions.supporters_since(began), 2);
  contradictions.predict({{2.0, 0.0, 0.0}, Eigen::Matrix3d::Identity() * 1e-6, 1.0});
  EXPECT_DOUBLE_EQ(contradictions.travelled_since_m(began), 2.0);
}

TEST(Contradictions, OneTooManyTakesThePlaceOfTheOldest) {
  Contradictions contradictions(LandmarkSensor{});
  const auto capacity = static_cast<int>(LocalMap::kCapacity);
  for (int number = 0; number <= capacity; ++number)
    contradictions.contradict(landmark_id(number), seen_at(number, 3.0));
  EXPECT_EQ(contradictions.all().size(), LocalMap::kCapacity);
  EXPECT_EQ(contradictions.find(landmark_id(0)), nullptr);
  const Contradiction* const latest = contradictions.find(landmark_id(capacity));
  ASSERT_NE(latest, nullptr);
  EXPECT_NE(contradictions.seen(*latest), nullptr);
}

}  // namespace
}  // namespace waymark
