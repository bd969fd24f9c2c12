#include "workbench/logs/map_files.hpp"

#include <limits>

#include <gmock/gmock.h>

#include "support/io_support.hpp"
#include "waymark/core/random.hpp"

namespace waymark {
namespace {

using test::TempFolder;
using testing::HasSubstr;

Eigen::MatrixXd random_matrix(RandomStream& random, Eigen::Index rows, Eigen::Index cols) {
  return Eigen::MatrixXd::NullaryExpr(rows, cols, [&] { return random.normal(); });
}

Eigen::MatrixXd random_covariance(RandomStream& random, Eigen::Index n) {
  const Eigen::MatrixXd A = random_matrix(random, n, n);
  Eigen::MatrixXd P = A * A.transpose() / 3.0;
  P.triangularView<Eigen::StrictlyUpper>() = P.transpose().eval();
  return P;
}

MapState random_map(int landmarks, int dimension) {
  RandomStream random(5, StreamPurpose::kSimulation, static_cast<std::uint64_t>(landmarks));
  MapState map;
  map.made_by = "waymark 0.1.0: a # 'log'";
  map.landmark_dimension = dimension;
  map.stamp = Stamp{Duration{1248444175103000001}};
  map.T_world_robot = {random.normal(), random.normal() * 1e-20, 0.1};
  for (int i = 0; i < landmarks; ++i) {
    map.ids.push_back({static_cast<LandmarkId::Family>(i % 4), i});
    map.observations.push_back(7 * i);
  }
  map.landmarks = random_matrix(random, landmarks * dimension, 1);
  for (int i = 0; dimension == 3 && i < landmarks; i += 2) {
    LandmarkPatch patch{map.ids[static_cast<std::size_t>(i)], {random.normal(), random.normal(), 0.3}, {}};
    for (int k = 0; k < 9; ++k) patch.pixels.push_back(static_cast<std::uint8_t>(random.uniform(0.0, 256.0)));
    map.patches.push_back(std::move(patch));
  }
  map.covariance = random_covariance(random, 3 + landmarks * dimension);
  return map;
}

void expect_same(const MapState& a, const MapState& b) {
  EXPECT_EQ(a.made_by, b.made_by);
  EXPECT_EQ(a.landmark_dimension, b.landmark_dimension);
  EXPECT_EQ(a.stamp, b.stamp);
  EXPECT_EQ(a.T_world_robot, b.T_world_robot);
  EXPECT_EQ(a.ids, b.ids);
  EXPECT_EQ(a.observations, b.observations);
  EXPECT_EQ(a.landmarks, b.landmarks);
  EXPECT_EQ(a.covariance, b.covariance);
  ASSERT_EQ(a.patches.size(), b.patches.size());
  for (std::size_t i = 0; i < a.patches.size(); ++i) {
    EXPECT_EQ(a.patches[i].id, b.patches[i].id);
    EXPECT_EQ(a.patches[i].T_world_robot, b.patches[i].T_world_robot);
    EXPECT_EQ(a.patches[i].pixels, b.patches[i].pixels);
  }
}

class MapRoundTrip : public testing::TestWithParam<std::pair<int, int>> {};

TEST_P(MapRoundTrip, GivesTheSameMapToTheLastBit) {
  const TempFolder folder;
  const auto [landmarks, dimension] = GetParam();
  const MapState map = random_map(landmarks, dimension);
  ASSERT_TRUE(write_map(folder.path() / "map.waymark", map).ok());
  const auto read = read_map(folder.path() / "map.waymark");
  ASSERT_TRUE(read.ok()) << read.error().message;
  expect_same(*read, map);
}

INSTANTIATE_TEST_SUITE_P(MapFiles, MapRoundTrip,
                         testing::Values(std::pair{0, 2}, std::pair{1, 2}, std::pair{1, 3}, std::pair{40, 2},
                                         std::pair{25, 3}));

/// The text of a map of two landmarks with one passage replaced.
std::string damaged(std::string_view passage, std::string_view replacement) {
  const std::string text =
      "waymark_map: 1\nmade_by: x\nstamp_s: 1.5\npose: 1 2 0.5\nlandmark_dimension: 2\nlandmarks: 1\n"
      "marker 7 3 1.5 2.5\ncovariance: 5\n1 0 0 0 0\n2 0 0 0\n3 0 0\n4 0.5\n5\nend\n";
  const std::size_t place = text.find(passage);
  EXPECT_NE(place, text.npos);
  return text.substr(0, place) + std::string(replacement) + text.substr(place + passage.size());
}

TEST(MapFiles, ReadsWhatAPersonWrote) {
  const auto map = parse_map("# by hand\n" + damaged("end", "# done\r\n\nend"), "m");
  ASSERT_TRUE(map.ok()) << map.error().message;
  EXPECT_EQ(map->ids, (std::vector<LandmarkId>{{LandmarkId::Family::kMarker, 7}}));
  EXPECT_EQ(map->covariance(3, 4), 0.5);
  EXPECT_EQ(map->covariance(4, 3), 0.5);
  EXPECT_EQ(map->stamp, Stamp{Duration{1'500'000'000}});
}

struct MapDamage {
  const char* passage;
  const char* replacement;
  const char* error;
};

class DamagedMap : public testing::TestWithParam<MapDamage> {};

TEST_P(DamagedMap, IsAnErrorThatTellsWhere) {
  const auto map = parse_map(damaged(GetParam().passage, GetParam().replacement), "m");
  ASSERT_FALSE(map.ok());
  EXPECT_THAT(map.error().message, HasSubstr(GetParam().error));
}

INSTANTIATE_TEST_SUITE_P(
    MapFiles, DamagedMap,
    testing::Values(
        MapDamage{"waymark_map: 1", "waymark_map: 2", "m:1: version '2' of the map format"},
        MapDamage{"waymark_map: 1", "id,x_m,y_m", "m:1: expected `waymark_map:`"},
        MapDamage{"stamp_s: 1.5", "stamp_s: now", "m:3: 'now' is not a number of seconds"},
        MapDamage{"pose: 1 2 0.5", "pose: 1 nan 0.5", "m:4: 'nan' is not a finite number"},
        MapDamage{"pose: 1 2 0.5", "pose: 1 2", "m:4: '' is not a finite number"},
        MapDamage{"pose: 1 2 0.5", "pose: 1 2 3 4", "m:4: unexpected text at the end of this line"},
        MapDamage{"dimension: 2", "dimension: 4", "m:5: the dimension of a landmark must be 2 or 3"},
        MapDamage{"landmarks: 1", "landmarks: -1", "m:6: the number of landmarks cannot be negative"},
        MapDamage{"landmarks: 1", "landmarks: 2000000000", "m:8: 'covariance:' is not a kind of landmark"},
        MapDamage{"marker 7", "tree 7", "m:7: 'tree' is not a kind of landmark"},
        MapDamage{"marker 7 3", "marker 7 -3", "m:7: the number of observations cannot be negative"},
        MapDamage{"1.5 2.5\n", "1.5 2.5 3.5\n", "m:7: unexpected text at the end of this line"},
        MapDamage{"covariance: 5", "covariance: 7",
                  "m:8: the covariance has size 7, but pose and landmarks need 5"},
        MapDamage{"2 0 0 0\n", "2 0 inf 0\n", "m:10: 'inf' is not a finite number"},
        MapDamage{"2 0 0 0\n", "2 0 0\n", "m:10: '' is not a finite number"},
        MapDamage{"4 0.5\n", "4 50\n", "m: the covariance is not positive semi-definite"},
        MapDamage{"\n5\nend\n", "\n-5\nend\n", "m: the covariance is not positive semi-definite"},
        MapDamage{"\n5\nend\n", "\n5\n", "m: the file ends before the line `end`"},
        MapDamage{"3 0 0\n4 0.5\n5\nend\n", "", "m:8: the file is too short"},
        MapDamage{"4 0.5\n5\nend\n", "          \n          \n", "m: the file ends before all rows"},
        MapDamage{"made_by: x\nstamp_s: 1.5\npose: 1 2 0.5\nlandmark_dimension: 2\nlandmarks: 1\n"
                  "marker 7 3 1.5 2.5\ncovariance: 5\n1 0 0 0 0\n2 0 0 0\n3 0 0\n4 0.5\n5\nend\n",
                  "", "m: the file ends before `made_by:`"}));

TEST(MapFiles, CutAnywhereAMapIsRefused) {
  for (const int dimension : {2, 3}) {
    const std::string text = format_map(random_map(3, dimension)).value();
    for (std::size_t length = 0; length + 4 < text.size(); ++length)
      EXPECT_FALSE(parse_map(text.substr(0, length), "m").ok()) << "after " << length << " bytes";
  }
}

TEST(MapFiles, PatchThatCannotBeOneIsAnErrorThatTellsWhere) {
  const auto error_of = [](std::string patches) {
    return parse_map(damaged("5\nend", "5\n" + std::move(patches) + "end"), "m").error().message;
  };
  EXPECT_THAT(error_of("patches: 2\nmarker 7 0 0 0 ff\n"),
              HasSubstr("m:16: 'end' is not a kind of landmark"));
  EXPECT_THAT(error_of("patches: 1\nmarker 7 0 0 0 fg\n"), HasSubstr("m:15: the pixels of a patch"));
  EXPECT_THAT(error_of("patches: 1\nmarker 7 0 0 0 ffff\n"), HasSubstr("m:15: the pixels of a patch"));
  EXPECT_THAT(error_of("patches: 1\nmarker 7 0 0 0 f\n"), HasSubstr("m:15: the pixels of a patch"));
  EXPECT_THAT(error_of("patches: 1\nmarker 8 0 0 0 ff\n"), HasSubstr("m: a patch of landmark 8, which is"));
}

TEST(MapFiles, IdMayStandOnceUnlessItIsNobodys) {
  MapState map = random_map(2, 2);
  map.ids = {{LandmarkId::Family::kMarker, 3}, {LandmarkId::Family::kMarker, 3}};
  EXPECT_THAT(parse_map(format_map(map).value(), "m").error().message,
              HasSubstr("landmark 3 is listed twice"));
  map.ids = {LandmarkId{}, LandmarkId{}};
  EXPECT_TRUE(parse_map(format_map(map).value(), "m").ok());
}

TEST(MapFiles, MapWhosePartsDisagreeIsNotWritten) {
  MapState map = random_map(2, 2);
  map.observations.pop_back();
  EXPECT_THAT(format_map(map).error().message, HasSubstr("2 landmarks"));
  EXPECT_FALSE(write_map("/dev/null", map).ok());
}

TEST(MapFiles, LineBreaksInTheProvenanceBecomeBlanks) {
  MapState map = random_map(1, 2);
  map.made_by = "a\nend\r\n";
  EXPECT_EQ(parse_map(format_map(map).value(), "m").value().made_by, "a end");
}

TEST(MapFiles, MapCsvReadsBackToTheLastBit) {
  const TempFolder folder;
  RandomStream random(6, StreamPurpose::kSimulation);
  Snapshot snapshot;
  for (int i = 0; i < 20; ++i)
    snapshot.landmarks.push_back({{LandmarkId::Family::kMarker, i},
                                  {random.normal(), random.normal(), random.normal()},
                                  random_covariance(random, 3),
                                  i});
  snapshot.landmarks.push_back({});
  ASSERT_TRUE(write_map_csv(folder.path() / "map.csv", snapshot).ok());
  const auto read = read_map_csv(folder.path() / "map.csv");
  ASSERT_TRUE(read.ok()) << read.error().message;
  ASSERT_EQ(read->size(), snapshot.landmarks.size());
  for (std::size_t i = 0; i < read->size(); ++i) {
    EXPECT_EQ((*read)[i].id, snapshot.landmarks[i].id);
    EXPECT_EQ((*read)[i].position_m, snapshot.landmarks[i].position_m);
    EXPECT_EQ((*read)[i].covariance, snapshot.landmarks[i].covariance);
    EXPECT_EQ((*read)[i].observations, snapshot.landmarks[i].observations);
  }
}

TEST(MapFiles, MapCsvHasTheDocumentedColumns) {
  Snapshot snapshot;
  snapshot.landmarks.push_back(
      {{LandmarkId::Family::kMarker, 4}, {0.1, 2.0, 0.0}, Eigen::Matrix3d::Zero(), 9});
  EXPECT_EQ(format_map_csv(snapshot),
            "id,x_m,y_m,z_m,sxx,sxy,sxz,syy,syz,szz,observations\n4,0.1,2,0,0,0,0,0,0,0,9\n");
}

TEST(MapFiles, BadMapCsvIsAnErrorWithItsLine) {
  const TempFolder folder;
  const auto file =
      folder.write("map.csv", "id,x_m,y_m,z_m,sxx,sxy,sxz,syy,syz,szz,observations\n4,0,0,0,1,2,0,1,0,0,9\n");
  EXPECT_THAT(read_map_csv(file).error().message, HasSubstr("map.csv:2: the covariance is not positive"));
}

}  // namespace
}  // namespace waymark
