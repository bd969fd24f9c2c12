#include "workbench/eval/truth_check.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "eval/eval_support.hpp"
#include "workbench/eval/map_error.hpp"

namespace waymark::eval {
namespace {

using test::random_pose;
using test::random_stream;
using test::surveyed;

/// The layout of UTIAS MRCLAM 1, where the published file has 11 and 17 exchanged; here they are right.
const std::vector<TrueLandmark> kMrclam1{
    surveyed(6, 5.709, 4.964),   surveyed(7, 5.253, 5.537),   surveyed(8, 3.700, 4.466),
    surveyed(9, 2.314, 3.375),   surveyed(10, 0.482, 4.396),  surveyed(11, 0.036, -2.844),
    surveyed(12, 4.063, 0.944),  surveyed(13, 2.680, 0.268),  surveyed(14, 0.948, 0.756),
    surveyed(15, 3.763, -2.031), surveyed(16, 1.698, -2.090), surveyed(17, 3.151, 2.383),
    surveyed(18, 0.943, -5.434), surveyed(19, 2.590, -5.523), surveyed(20, 2.099, -3.915)};

/// Eight tags of a small robot; 5 and 6 stand only 0.4 m apart.
const std::vector<TrueLandmark> kSmallRoom{
    surveyed(1, 1.69, 0.2),   surveyed(2, 1.69, -0.2),  surveyed(3, 1.12, 1.315), surveyed(4, 1.52, 1.315),
    surveyed(5, -0.37, 0.84), surveyed(6, -0.37, 1.24), surveyed(7, 0.2, -0.275), surveyed(8, -0.2, -0.275)};

std::vector<TrueLandmark> exchanged(std::vector<TrueLandmark> survey, int a, int b) {
  for (TrueLandmark& landmark : survey) {
    if (landmark.id.number == a) {
      landmark.id.number = b;
    } else if (landmark.id.number == b) {
      landmark.id.number = a;
    }
  }
  return survey;
}

/// What a filter would make of these landmarks: another frame, and an error of each.
std::vector<LandmarkEstimate> noisy_map(const std::vector<TrueLandmark>& survey, RandomStream& random,
                                        double sigma_m) {
  const Pose2 T_map_survey = random_pose(random);
  std::vector<LandmarkEstimate> map;
  for (const TrueLandmark& landmark : survey) {
    const Eigen::Vector2d p = T_map_survey * Eigen::Vector2d(landmark.x_m, landmark.y_m);
    map.push_back(
        {.id = landmark.id,
         .position_m = {p.x() + sigma_m * random.normal(), p.y() + sigma_m * random.normal(), 0.0}});
  }
  return map;
}

std::vector<int> numbers(const std::vector<MapOddity>& oddities) {
  std::vector<int> result;
  for (const MapOddity& oddity : oddities) result.push_back(oddity.id.number);
  return result;
}

struct Room {
  std::vector<TrueLandmark> survey;
  int a;
  int b;
  double sigma_m;
};

class ExchangedLandmarks : public testing::TestWithParam<Room> {};

TEST_P(ExchangedLandmarks, AreFoundAndMendedAndNothingElse) {
  const auto& [survey, a, b, sigma_m] = GetParam();
  const auto wrong = exchanged(survey, a, b);
  RandomStream random = random_stream(14);
  int right = 0;
  constexpr int kRuns = 200;
  for (int i = 0; i < kRuns; ++i) {
    const auto oddities = compare_maps(noisy_map(survey, random, sigma_m), wrong);
    const auto mended = with_exchanges(wrong, oddities);
    const bool all_right = std::ranges::all_of(survey, [&](const TrueLandmark& landmark) {
      return std::ranges::any_of(mended, [&](const TrueLandmark& m) {
        return m.id == landmark.id && m.x_m == landmark.x_m && m.y_m == landmark.y_m;
      });
    });
    if (all_right && oddities.size() == 2) ++right;
  }
  EXPECT_GE(right, kRuns * 95 / 100);
}

TEST_P(ExchangedLandmarks, AreNotSeenInARightSurvey) {
  const auto& room = GetParam();
  RandomStream random = random_stream(15);
  int alarms = 0;
  constexpr int kRuns = 200;
  for (int i = 0; i < kRuns; ++i) {
    if (!compare_maps(noisy_map(room.survey, random, room.sigma_m), room.survey).empty()) ++alarms;
  }
  EXPECT_LE(alarms, kRuns * 5 / 100);
}

INSTANTIATE_TEST_SUITE_P(Rooms, ExchangedLandmarks,
                         testing::Values(Room{kMrclam1, 11, 17, 0.1}, Room{kMrclam1, 7, 15, 0.05},
                                         Room{kSmallRoom, 5, 6, 0.03}));

TEST(CompareMaps, FindsASingleMovedLandmark) {
  auto survey = kMrclam1;
  survey[3].x_m += 1.5;
  RandomStream random = random_stream(16);
  const auto oddities = compare_maps(noisy_map(kMrclam1, random, 0.03), survey);
  ASSERT_EQ(numbers(oddities), std::vector{9});
  EXPECT_NEAR(oddities[0].off_m, 1.5, 0.2);
  EXPECT_FALSE(oddities[0].seen_at);
  EXPECT_THAT(describe(oddities), testing::ElementsAre(testing::HasSubstr("landmark 9 is seen 1.")));
}

TEST(CompareMaps, NamesTheOthersPlaceInALongerExchange) {
  const auto survey = exchanged(exchanged(kMrclam1, 6, 12), 12, 18);
  RandomStream random = random_stream(17);
  const auto oddities = compare_maps(noisy_map(kMrclam1, random, 0.03), survey);
  EXPECT_THAT(numbers(oddities), testing::UnorderedElementsAre(6, 12, 18));
  for (const MapOddity& oddity : oddities) EXPECT_TRUE(oddity.seen_at);
  EXPECT_EQ(describe(oddities).size(), 3u);
}

TEST(CompareMaps, SaysNothingOfTooFewLandmarks) {
  RandomStream random = random_stream(18);
  const std::vector<TrueLandmark> three(kMrclam1.begin(), kMrclam1.begin() + 3);
  EXPECT_TRUE(compare_maps(noisy_map(three, random, 0.0), exchanged(three, 6, 7)).empty());
  EXPECT_TRUE(compare_maps({}, kMrclam1).empty());
  EXPECT_TRUE(compare_maps(noisy_map(kMrclam1, random, 0.0), {}).empty());
}

TEST(Describe, SaysAnExchangeOnce) {
  RandomStream random = random_stream(19);
  const auto oddities = compare_maps(noisy_map(kMrclam1, random, 0.02), exchanged(kMrclam1, 11, 17));
  EXPECT_THAT(describe(oddities),
              testing::ElementsAre(testing::HasSubstr("landmarks 11 and 17 may be exchanged")));
}

/// Observations of all landmarks from a robot that drives about, with one in ten grossly wrong.
std::vector<PositionObservation> observations_from(const Trajectory& path, const Eigen::Vector2d& sensor_m) {
  RandomStream random = random_stream(20);
  std::vector<PositionObservation> landmark_observations;
  for (const TrajectoryPoint& point : path) {
    for (const TrueLandmark& landmark : kMrclam1) {
      const Pose2 T_robot_world = (point.pose * Pose2{-sensor_m.x(), -sensor_m.y(), 0.0}).inverse();
      Eigen::Vector2d p = T_robot_world * Eigen::Vector2d(landmark.x_m, landmark.y_m);
      p += 0.1 * Eigen::Vector2d(random.normal(), random.normal());
      if (random.uniform() < 0.1) p += Eigen::Vector2d(5.0, 5.0);
      landmark_observations.push_back({point.stamp, landmark.id, p});
    }
  }
  return landmark_observations;
}

TEST(PlaceObservations, FindsWhereLandmarksAreFromTruePoses) {
  const Trajectory path = test::wavy_path(300);  // of the truth sensor
  const Eigen::Vector2d sensor_m(0.4, -0.2);
  const auto map =
      place_observations(observations_from(path, sensor_m), TruthTrack::from_trajectory(path), sensor_m);
  ASSERT_EQ(map.size(), kMrclam1.size());
  EXPECT_EQ(map[0].observations, 300);
  for (const auto [i, j] : match_by_number(map, kMrclam1)) {
    EXPECT_LT(landmark_error_m(map[i], kMrclam1[j], {}).norm(), 0.1);
  }
  EXPECT_TRUE(find_oddities(map, kMrclam1, {}).empty());
  EXPECT_THAT(numbers(find_oddities(map, exchanged(kMrclam1, 11, 17), {})), testing::ElementsAre(11, 17));
}

TEST(PlaceObservations, LeavesOutWhatHasNoTruePose) {
  const Trajectory path = test::wavy_path(8);
  const auto landmark_observations = observations_from(path, {0, 0});
  const TruthTrack no_headings({test::truth_at(0, 0, 0), test::truth_at(0.1, 0, 0)});
  EXPECT_TRUE(place_observations(landmark_observations, no_headings).empty());
  EXPECT_TRUE(place_observations(landmark_observations, TruthTrack()).empty());
  const TruthTrack four_poses = TruthTrack::from_trajectory({path.begin(), path.begin() + 4});
  EXPECT_TRUE(place_observations(landmark_observations, four_poses).empty())
      << "four observations each are too few";
}

}  // namespace
}  // namespace waymark::eval
