#include "workbench/logs/map_forms.hpp"

#include <gmock/gmock.h>

#include "support/io_support.hpp"

#include "workbench/logs/files.hpp"
#include "workbench/logs/map_files.hpp"

namespace waymark {
namespace {

using test::TempFolder;
using testing::HasSubstr;

MapState some_map(int dimension) {
  MapState map;
  map.made_by = "a \"test\"";
  map.landmark_dimension = dimension;
  map.stamp = Stamp{Duration{1248444175103000001}};
  map.T_world_robot = {0.1, 1.0 / 3.0, -2.0};
  map.ids = {{LandmarkId::Family::kMarker, 4}, {LandmarkId::Family::kBarcode, 4}, {}};
  map.observations = {1, 2, 3};
  map.patches = {{map.ids[1], {0.1, 0.2, 0.3}, {0, 127, 128, 255}}};
  map.landmarks = Eigen::VectorXd::LinSpaced(3 * dimension, -1.0, 2.0 / 3.0);
  const Eigen::Index n = 3 + 3 * dimension;
  map.covariance = 0.3 * Eigen::MatrixXd::Identity(n, n) + Eigen::MatrixXd::Constant(n, n, 0.1);
  return map;
}

class Forms : public testing::TestWithParam<int> {};

TEST_P(Forms, JsonAndBackIsTheSameToTheLastBit) {
  const TempFolder folder;
  const MapState map = some_map(GetParam());
  ASSERT_TRUE(write_map_of_any_form(folder.path() / "map.json", map).ok());
  const auto read = read_map_of_any_form(folder.path() / "map.json");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(*format_map(*read), *format_map(map));
}

TEST_P(Forms, JsonKeepsAMapWhoseMakerIsNotUtf8) {
  const TempFolder folder;
  MapState map = some_map(GetParam());
  map.made_by = "ekf on R\xe4ume";
  ASSERT_TRUE(write_map_of_any_form(folder.path() / "map.json", map).ok());
  EXPECT_EQ(read_map_of_any_form(folder.path() / "map.json").value().made_by, "ekf on R\xef\xbf\xbdume");
}

TEST_P(Forms, ATableKeepsTheLandmarksWithoutTheirCorrelations) {
  const TempFolder folder;
  const MapState map = some_map(GetParam());
  ASSERT_TRUE(write_map_of_any_form(folder.path() / "map.csv", map).ok());
  const auto read = read_map_of_any_form(folder.path() / "map.csv");
  ASSERT_FALSE(read);  // two kinds, one number
  EXPECT_THAT(read.error().message, HasSubstr("landmark 4 is listed twice"));
  MapState named = map;
  named.ids[1].number = 5;
  ASSERT_TRUE(write_map_of_any_form(folder.path() / "map.csv", named).ok());
  const auto again = read_map_of_any_form(folder.path() / "map.csv");
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(again->landmark_dimension, GetParam());
  EXPECT_EQ(again->landmarks, map.landmarks);
  EXPECT_EQ(again->covariance(3, 4), map.covariance(3, 4));
  EXPECT_EQ(again->covariance(3, 3 + GetParam()), 0.0);
  EXPECT_EQ(again->observations, map.observations);
}

INSTANTIATE_TEST_SUITE_P(MapForms, Forms, testing::Values(2, 3));

TEST(MapForms, RefusesWhatIsNoMap) {
  const TempFolder folder;
  const auto error_of = [&](const std::string& name, const std::string& text) {
    EXPECT_TRUE(write_file(folder.path() / name, text).ok());
    const auto read = read_map_of_any_form(folder.path() / name);
    return read ? std::string("none") : read.error().message;
  };
  EXPECT_THAT(error_of("m.json", "{"), HasSubstr("m.json: is not a map"));
  EXPECT_THAT(error_of("m.json", "{\"waymark_map\": 2}"), HasSubstr("version 2 of the map format"));
  EXPECT_THAT(error_of("m.json", "{\"waymark_map\": 1}"), HasSubstr("made_by"));
  EXPECT_THAT(error_of("m.txt", ""), HasSubstr("ends with .waymark, .json or .csv"));
}

}  // namespace
}  // namespace waymark
