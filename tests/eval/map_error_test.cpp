#include "workbench/eval/map_error.hpp"

#include <gtest/gtest.h>

#include "eval/eval_support.hpp"

namespace waymark::eval {
namespace {

using test::surveyed;

LandmarkEstimate seen(int number, double x_m, double y_m,
                      LandmarkId::Family family = LandmarkId::Family::kBarcode) {
  return {.id = {family, number}, .position_m = {x_m, y_m, 0.0}};
}

const std::vector<TrueLandmark> kSurvey{surveyed(1, 0, 0), surveyed(2, 4, 0), surveyed(3, 0, 3),
                                        surveyed(4, 5, 5)};
const PathFrames kSameFrame{.T_truth_anchored = Pose2{}, .T_truth_aligned = Pose2{}};

std::vector<LandmarkEstimate> map_of(const std::vector<TrueLandmark>& survey, const Pose2& T_map_truth,
                                     LandmarkId::Family family = LandmarkId::Family::kBarcode) {
  std::vector<LandmarkEstimate> map;
  for (const TrueLandmark& landmark : survey) {
    const Eigen::Vector2d p = T_map_truth * Eigen::Vector2d(landmark.x_m, landmark.y_m);
    map.push_back(seen(landmark.id.number, p.x(), p.y(), family));
  }
  return map;
}

TEST(MapError, CountsMissedAndSpurious) {
  const std::vector<LandmarkEstimate> map{seen(2, 4.3, 0.4), seen(1, 0, 0), seen(9, 7, 7), seen(1, 3, 3)};
  const auto error = map_error(map, kSurvey, kSameFrame);
  ASSERT_TRUE(error);
  EXPECT_EQ(error->matched, 2u);
  EXPECT_EQ(error->missed, 2u);
  EXPECT_EQ(error->spurious, 2u) << "an unknown one, and the second one with number 1";
  EXPECT_NEAR(*error->rmse_m, std::sqrt(0.25 / 2), 1e-12);
  EXPECT_FALSE(error->rmse_self_m) << "two landmarks fit anything";
}

TEST(MapError, SelfAlignmentForgivesTheFrameAndThePathDoesNot) {
  const Pose2 T_map_truth{2.0, -1.0, 0.7};
  const auto error = map_error(map_of(kSurvey, T_map_truth), kSurvey,
                               {.T_truth_anchored = Pose2{}, .T_truth_aligned = T_map_truth.inverse()});
  ASSERT_TRUE(error);
  EXPECT_NEAR(*error->rmse_self_m, 0.0, 1e-12);
  EXPECT_NEAR(*error->rmse_m, 0.0, 1e-12);
  EXPECT_GT(*error->rmse_anchored_m, 1.0);
}

TEST(MapError, WithoutPathTruthOnlyTheSelfAlignedFigure) {
  const auto error = map_error(map_of(kSurvey, {1, 2, 3}), kSurvey, {});
  ASSERT_TRUE(error);
  EXPECT_NEAR(*error->rmse_self_m, 0.0, 1e-12);
  EXPECT_FALSE(error->rmse_m);
  EXPECT_FALSE(error->rmse_anchored_m);
  EXPECT_FALSE(error->nees_per_dof);
}

TEST(MapError, MatchesNearestWhenNamesMeanNothing) {
  auto map = map_of(kSurvey, {0.1, 0.0, 0.0}, LandmarkId::Family::kCorner);
  std::ranges::reverse(map);
  for (std::size_t i = 0; i < map.size(); ++i) map[i].id.number = static_cast<int>(i) + 1;
  map.push_back(seen(7, 4.2, 0.0, LandmarkId::Family::kCorner));  // a double of number 2
  const auto error = map_error(map, kSurvey, kSameFrame);
  ASSERT_TRUE(error);
  EXPECT_EQ(error->matched, 4u);
  EXPECT_EQ(error->spurious, 1u);
  EXPECT_NEAR(*error->rmse_m, 0.1, 1e-12);
  EXPECT_FALSE(map_error(map, kSurvey, {})) << "no names and no path: nobody knows which is which";
}

TEST(MatchNearest, IsOneToOneAndNearestFirst) {
  const std::vector<LandmarkEstimate> map{seen(1, 0.4, 0), seen(2, 0.1, 0), seen(3, 20, 20)};
  const std::vector<TrueLandmark> survey{surveyed(1, 0, 0), surveyed(2, 0.85, 0)};
  const auto matches = match_nearest(map, survey, {});
  ASSERT_EQ(matches.size(), 2u);
  EXPECT_EQ(matches[0].estimated, 1u);
  EXPECT_EQ(matches[0].surveyed, 0u);
  EXPECT_EQ(matches[1].estimated, 0u);
  EXPECT_EQ(matches[1].surveyed, 1u);
}

TEST(ResolveNames, TrustsMarkersAndBarcodesOnly) {
  const auto named = map_of(kSurvey, {});
  const auto without_identity = map_of(kSurvey, {}, LandmarkId::Family::kNone);
  EXPECT_EQ(resolve_names(LandmarkNames::kAuto, named, kSurvey), LandmarkNames::kKnown);
  EXPECT_EQ(resolve_names(LandmarkNames::kAuto, without_identity, kSurvey), LandmarkNames::kUnknown);
  EXPECT_EQ(resolve_names(LandmarkNames::kKnown, without_identity, kSurvey), LandmarkNames::kKnown);
}

TEST(MapError, NeesTurnsTheCovarianceAndSkipsSingularOnes) {
  const Pose2 T_map_truth{0, 0, -kPi / 2};  // x of the truth is -y of the map
  auto map = map_of(kSurvey, T_map_truth);
  for (LandmarkEstimate& landmark : map) {
    landmark.position_m.y() -= 0.3;
    landmark.covariance.diagonal() << 1e-4, 0.09, 0.0;
  }
  map[0].covariance.setZero();
  const auto error =
      map_error(map, kSurvey, {.T_truth_anchored = T_map_truth.inverse(), .T_truth_aligned = {}});
  ASSERT_TRUE(error);
  EXPECT_EQ(error->nees_skipped, 1u);
  EXPECT_NEAR(*error->nees_per_dof, 0.5, 1e-9);
}

TEST(LandmarkError, CountsHeightOnlyForLandmarksThatHaveOne) {
  LandmarkEstimate landmark = seen(1, 1.0, 2.0);
  EXPECT_EQ(landmark_error_m(landmark, surveyed(1, 1, 2, 0.5), {}).norm(), 0.0);
  landmark.covariance(2, 2) = 0.01;
  EXPECT_NEAR(landmark_error_m(landmark, surveyed(1, 1, 2, 0.5), {}).z(), -0.5, 1e-12);
}

TEST(MapError, EmptyInputs) {
  EXPECT_FALSE(map_error(map_of(kSurvey, {}), {}, kSameFrame));
  const auto error = map_error({}, kSurvey, kSameFrame);
  ASSERT_TRUE(error);
  EXPECT_EQ(error->missed, 4u);
  EXPECT_FALSE(error->rmse_m);
}

}  // namespace
}  // namespace waymark::eval
