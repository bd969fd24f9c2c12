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
  EXPECT_THAT(error_of("m.json", "[]"), HasSubstr("m.json: is not a map: waymark_map is missing"));
  EXPECT_THAT(error_of("m.txt", ""), HasSubstr("ends with .waymark, .json or .csv"));
}

TEST(MapForms, NoNumberOfAJsonMapChangesInSilence) {
  const TempFolder folder;
  const auto file = folder.path() / "m.json";
  const std::string good =
      R"({"waymark_map": 1, "made_by": "x", "stamp_s": "1.5", "pose": [1, 2, 0.5], "landmark_dimension": 2,
          "landmarks": [{"kind": "marker", "number": 7, "sightings": 5, "position_m": [1, 2]}],
          "covariance": [[1, 0, 0, 0, 0], [1, 0, 0, 0], [1, 0, 0], [1, 0], [1]],
          "patches": [{"kind": "marker", "number": 7, "pose": [0, 0, 0], "pixels": [9]}]})";
  ASSERT_TRUE(write_file(file, good));
  ASSERT_TRUE(read_map_of_any_form(file)) << read_map_of_any_form(file).error().message;
  const auto error_with = [&](const std::string& part, const std::string& instead) {
    std::string text = good;
    text.replace(text.find(part), part.size(), instead);
    EXPECT_TRUE(write_file(file, text));
    const auto read = read_map_of_any_form(file);
    return read ? std::string("none") : read.error().message;
  };
  EXPECT_THAT(error_with("\"number\": 7", "\"number\": 4294967297"),
              HasSubstr("m.json: is not a map: landmarks[0].number: 4294967297 is not a whole number from "
                        "-2147483648 to 2147483647"));
  EXPECT_THAT(error_with("\"number\": 7", "\"number\": 1e300"), HasSubstr("landmarks[0].number"));
  EXPECT_THAT(error_with("\"number\": 7", "\"number\": 7.5"), HasSubstr("7.5 is not a whole number"));
  EXPECT_THAT(error_with("\"number\": 7", "\"number\": true"), HasSubstr("is not a number"));
  EXPECT_THAT(error_with("ings\": 5", "ings\": 18446744073709551615"), HasSubstr("landmarks[0].sightings"));
  EXPECT_THAT(error_with("dimension\": 2", "dimension\": 4294967298"), HasSubstr("landmark_dimension"));
  EXPECT_THAT(error_with("[9]", "[265]"), HasSubstr("patches[0].pixels[0]: 265 is not a whole number"));
  EXPECT_THAT(error_with("[9]", "[-1]"), HasSubstr("patches[0].pixels[0]"));
  EXPECT_THAT(error_with("[1, 2, 0.5]", "[1, 2]"), HasSubstr("pose: has 2 items; expected 3"));
  EXPECT_THAT(error_with("[1, 0, 0, 0], [1, 0, 0]", "[1, 0, 0], [1, 0, 0]"), HasSubstr("covariance[1]"));
  EXPECT_THAT(error_with("\"1.5\"", "\"soon\""), HasSubstr("stamp_s: is not a number of seconds"));
  EXPECT_THAT(error_with("\"marker\"", "\"tree\""), HasSubstr("landmarks[0].kind: is not a kind"));
  EXPECT_THAT(error_with("[1, 2]}]", "[1, 1e999]}]"), testing::Not(HasSubstr("exception")));
}

}  // namespace
}  // namespace waymark
