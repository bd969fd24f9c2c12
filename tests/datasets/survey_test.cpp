#include "workbench/datasets/survey.hpp"

#include <gmock/gmock.h>

#include "support/io_support.hpp"

#include "workbench/logs/files.hpp"

namespace waymark {
namespace {

using test::TempFolder;

MapState map_of_barcodes() {
  MapState map;
  map.ids = {{LandmarkId::Family::kMarker, 3}, {LandmarkId::Family::kBarcode, 7}};
  return map;
}

Result<MapState> survey_of(const std::string& text) {
  const TempFolder folder;
  EXPECT_TRUE(write_file(folder.path() / "survey.csv", text).ok());
  return read_survey(folder.path() / "survey.csv", map_of_barcodes());
}

TEST(Survey, IsAMapOfIndependentLandmarksUnderTheIdsOfTheOther) {
  const auto survey = survey_of("id,x_m,y_m,sxx,sxy,syy\n7,1,2,0.01,0.001,0.04\n9,3,4,0.01,0,0.01\n");
  ASSERT_TRUE(survey) << survey.error().message;
  EXPECT_EQ(survey->ids,
            (std::vector<LandmarkId>{{LandmarkId::Family::kBarcode, 7}, {LandmarkId::Family::kMarker, 9}}));
  EXPECT_EQ(survey->landmarks, Eigen::Vector4d(1.0, 2.0, 3.0, 4.0));
  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(7, 7);
  expected.diagonal().tail<4>() << 0.01, 0.04, 0.01, 0.01;
  expected(3, 4) = expected(4, 3) = 0.001;
  EXPECT_EQ(survey->covariance, expected);
}

TEST(Survey, MayLackTheCovarianceOfXWithY) {
  const auto survey = survey_of("id,x_m,y_m,sxx,syy\n7,1,2,0.01,0.04\n");
  ASSERT_TRUE(survey) << survey.error().message;
  EXPECT_EQ(survey->covariance(3, 4), 0.0);
}

TEST(Survey, RefusesWhatIsNoSurvey) {
  const auto expect_error = [](const std::string& rows, const char* words) {
    const auto survey = survey_of("id,x_m,y_m,sxx,sxy,syy\n" + rows);
    ASSERT_FALSE(survey) << rows;
    EXPECT_THAT(survey.error().message, testing::HasSubstr(words));
  };
  expect_error("7,1,2,-0.01,0,0.04\n", "survey.csv:2: the covariance is not positive");
  expect_error("7,1,2,1,0,1\n7,1,2,1,0,1\n", "survey.csv:3: this id is listed twice");
  expect_error("-1,1,2,1,0,1\n", "survey.csv:2");
  EXPECT_THAT(survey_of("id,x_m,y_m,z_m\n7,1,2,0\n").error().message,
              testing::HasSubstr("survey.csv:2: a survey needs variances: columns id,x_m,y_m,sxx,sxy,syy"));
}

}  // namespace
}  // namespace waymark
