#include "workbench/datasets/mrclam.hpp"

#include <gmock/gmock.h>

#include "support/data_dir.hpp"
#include "support/io_support.hpp"

#include "workbench/config/flat_yaml.hpp"

namespace waymark {
namespace {

using test::only;
using test::TempFolder;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

/// A dataset with robots 1 and 3; landmark 6 has barcode 63, robot 2 barcode 14.
void write_dataset(const TempFolder& folder) {
  folder.write("Barcodes.dat", "# Subject Barcode\n  2 \t 14 \n  6 \t  63 \n  7 \t  25");
  folder.write("Landmark_Groundtruth.dat", "# header\n 6 \t 1.5 \t -2 \t 0.0001 \t 0.0002 \n");
  folder.write("Robot1_Odometry.dat", "# Time v w\n10.000 \t 0.1 \t 0.2 \n10.100 \t 0.3 \t 0.4 \n");
  folder.write("Robot1_Measurement.dat",
               "# Time Subject\n10.050 \t 63 \t 2.5 \t 0.5 \n10.050 \t 14 \t 1 \t 0 \n"
               "10.050 \t 25 \t 3.5 \t 0.1 \n10.070 \t 99 \t 1 \t 0 \n");
  folder.write("Robot1_Groundtruth.dat", "9.0 1 2 3\n10.05 4 5 6\n");
  folder.write("Robot3_Odometry.dat", "1 0 0\n");
  folder.write("Robot3_Measurement.dat", "");
}

std::unique_ptr<Source> open_robot(const TempFolder& folder, int robot = 1) {
  auto log = open_mrclam(folder.path(), {.robot = robot});
  EXPECT_TRUE(log.ok()) << log.error().message;
  return *std::move(log);
}

TEST(Mrclam, MapsBarcodesToLandmarksAndSkipsRobotsAndStrangers) {
  const TempFolder folder;
  write_dataset(folder);
  const auto log = open_robot(folder);
  const auto events = test::read_all(*log).events;
  const auto observations = only<Observations>(events);
  ASSERT_EQ(observations.size(), 1U);
  EXPECT_EQ(observations[0].first, parse_stamp("10.05"));
  ASSERT_EQ(observations[0].second.size(), 2U);
  EXPECT_EQ(observations[0].second[0].id, (LandmarkId{LandmarkId::Family::kBarcode, 6}));
  EXPECT_EQ(observations[0].second[1].id, (LandmarkId{LandmarkId::Family::kBarcode, 7}));
  EXPECT_EQ(std::get<RangeBearing>(observations[0].second[0].value).range_m, 2.5);
  EXPECT_EQ(std::get<RangeBearing>(observations[0].second[0].value).bearing_rad, 0.5);
  EXPECT_THAT(log->notes(), ElementsAre("observations skipped of other robots: 1",
                                        "observations of barcode 99 skipped, which is in no table: 1"));
}

TEST(Mrclam, ReadsVelocityAndTruthInTheOrderOfTime) {
  const TempFolder folder;
  write_dataset(folder);
  const auto events = test::read_all(*open_robot(folder)).events;
  ASSERT_EQ(events.size(), 5U);
  EXPECT_TRUE(std::holds_alternative<Truth>(events[0].content));
  EXPECT_EQ(std::get<Velocity>(events[1].content).w_radps, 0.2);
  EXPECT_EQ(std::get<Truth>(events[2].content).theta_rad, 6.0);
  EXPECT_TRUE(std::holds_alternative<Observations>(events[3].content));
}

TEST(Mrclam, InfoHoldsLandmarksNameAndTheSettingsOfTheFamily) {
  const TempFolder folder;
  write_dataset(folder);
  const auto log = open_robot(folder, 3);
  EXPECT_THAT(log->info().name, testing::EndsWith("robot 3"));
  ASSERT_EQ(log->info().landmarks.size(), 1U);
  EXPECT_EQ(log->info().landmarks[0].y_m, -2.0);
  const auto file = read_file(std::filesystem::path(WAYMARK_SOURCE_DIR) / "configs/mrclam.yaml");
  ASSERT_TRUE(file.ok());
  std::vector<std::pair<std::string, std::string>> expected;
  const auto entries = flatten_yaml(*file, "mrclam.yaml");
  ASSERT_TRUE(entries.ok()) << entries.error().message;
  for (const auto& entry : *entries) expected.emplace_back(entry.key, entry.value);
  EXPECT_FALSE(expected.empty());
  EXPECT_EQ(log->info().settings, expected);
}

TEST(Mrclam, RobotThatIsNotThereNamesThoseThatAre) {
  const TempFolder folder;
  write_dataset(folder);
  EXPECT_THAT(open_mrclam(folder.path(), {.robot = 2}).error().message,
              HasSubstr("no robot 2; input.robot can be 1, 3"));
}

TEST(Mrclam, OdometryThatGoesBackInTimeIsSkippedAndCounted) {
  const TempFolder folder;
  write_dataset(folder);
  folder.write("Robot1_Odometry.dat", "2 0.1 0\n1.9 0.2 0\n2 0.3 0\n");
  const auto log = open_robot(folder);
  EXPECT_EQ(only<Velocity>(test::read_all(*log).events).size(), 2U);
  EXPECT_THAT(log->notes(), Contains("rows of Robot1_Odometry.dat skipped that go back in time: 1"));
  EXPECT_THAT(log->notes(), Contains("rows of Robot1_Odometry.dat with the same stamp as the row before: 1"));
}

/// A byte-order mark, a header and whole seconds, as in the spreadsheet export of dataset 1.
constexpr const char* kRounded =
    "\xEF\xBB\xBF# Time [s],x [m],y [m],,\n8,9,9,9\r\n9,1,2,-3\r\n9,2,3,-2\r\n10,9,9,9\r\n";

TEST(Mrclam, RoundedTruthIsSpreadOverItsSeconds) {
  const TempFolder folder;
  write_dataset(folder);
  folder.write("Robot3_Groundtruth_rounded.csv", kRounded);
  const auto log = open_robot(folder, 3);
  const auto truth = only<Truth>(test::read_all(*log).events);
  ASSERT_EQ(truth.size(), 2U);
  EXPECT_EQ(truth[0].first, parse_stamp("8.5"));
  EXPECT_EQ(truth[0].second.theta_rad, -3.0);
  EXPECT_EQ(truth[1].first, parse_stamp("9"));
  EXPECT_EQ(truth[1].second.x_m, 2.0);
  EXPECT_THAT(log->notes(),
              Contains(HasSubstr("Robot3_Groundtruth_rounded.csv: stamps are rounded to whole seconds")));
}

TEST(Mrclam, PublishedTruthWinsOverRounded) {
  const TempFolder folder;
  write_dataset(folder);
  folder.write("Robot1_Groundtruth_rounded.csv", kRounded);
  const auto log = open_robot(folder);
  const auto truth = only<Truth>(test::read_all(*log).events);
  ASSERT_EQ(truth.size(), 2U);
  EXPECT_EQ(truth[0].first, parse_stamp("9"));
  EXPECT_EQ(truth[0].second.theta_rad, 3.0);
  EXPECT_THAT(log->notes(), testing::Not(Contains(HasSubstr("rounded"))));
}

TEST(Mrclam, BadRoundedTruthIsAnErrorWithFileAndLine) {
  const TempFolder folder;
  write_dataset(folder);
  folder.write("Robot3_Groundtruth_rounded.csv", "8,1,1,1\n9,1,1,1\n9,1,,1\n10,1,1,1\n");
  EXPECT_THAT(test::read_all(*open_robot(folder, 3)).error,
              HasSubstr("Robot3_Groundtruth_rounded.csv:3: expected 4 columns"));
  folder.write("Robot3_Groundtruth_rounded.csv", "8,1,1,1\ntime,x,y\n");
  EXPECT_THAT(open_mrclam(folder.path(), {.robot = 3}).error().message,
              HasSubstr("Robot3_Groundtruth_rounded.csv:2: 'time' is not a whole number"));
}

TEST(Mrclam, LandmarksOfDataset1ArePutRightUnlessToldNotTo) {
  const TempFolder folder;
  write_dataset(folder);
  folder.write("Landmark_Groundtruth.dat", "11 3.15071999 2.38294871 0 0\n17 0.03596156 -2.84396626 0 0\n");
  const auto fixed = open_robot(folder);
  EXPECT_EQ(fixed->info().landmarks[0].id.number, 17);
  EXPECT_EQ(fixed->info().landmarks[1].id.number, 11);
  EXPECT_THAT(fixed->notes(), Contains(HasSubstr("landmarks 11 and 17")));
  const auto as_published = open_mrclam(folder.path(), {.robot = 1, .fix_known_errors = false}).value();
  EXPECT_EQ(as_published->info().landmarks[0].id.number, 11);
}

TEST(Mrclam, BadFilesAreErrorsWithFileAndLine) {
  const TempFolder folder;
  write_dataset(folder);
  folder.write("Robot1_Measurement.dat", "1 63 -1 0\n");
  EXPECT_THAT(test::read_all(*open_robot(folder)).error, HasSubstr("Robot1_Measurement.dat:1: range -1 m"));
  folder.write("Robot1_Measurement.dat", "1 63 1 0\n2 63 1");
  EXPECT_THAT(test::read_all(*open_robot(folder)).error,
              HasSubstr("Robot1_Measurement.dat:2: expected 4 columns"));
  folder.write("Barcodes.dat", "6 63\n7 63\n");
  EXPECT_THAT(open_mrclam(folder.path()).error().message, HasSubstr("Barcodes.dat:2: barcode 63 already"));
  std::filesystem::remove(folder.path() / "Robot3_Measurement.dat");
  folder.write("Barcodes.dat", "6 63\n");
  EXPECT_THAT(open_mrclam(folder.path(), {.robot = 3}).error().message,
              HasSubstr("Robot3_Measurement.dat: No such file"));
}

struct Recorded {
  const char* dataset;
  int robot;
  std::size_t odometry_rows;
  std::size_t landmark_observations;
  int robot_observations;
  std::vector<std::string> further_notes;
  std::size_t truth_rows = 0;  // 0: not counted
};

void PrintTo(const Recorded& recorded, std::ostream* out) {
  *out << recorded.dataset << " robot " << recorded.robot;
}

class MrclamRecording : public testing::TestWithParam<Recorded> {};

TEST_P(MrclamRecording, HoldsTheKnownCounts) {
  const Recorded& known = GetParam();
  WAYMARK_REQUIRE_DATA(known.dataset);
  const auto log = open_mrclam(test::data_path(known.dataset), {.robot = known.robot});
  ASSERT_TRUE(log.ok()) << log.error().message;
  EXPECT_EQ((*log)->info().landmarks.size(), 15U);
  const auto delivered = test::read_all(**log);
  EXPECT_EQ(delivered.error, "");
  const auto notes = (*log)->notes();
  const auto back =
      std::ranges::count_if(notes, [](const auto& note) { return note.find("go back") != note.npos; });
  EXPECT_EQ(only<Velocity>(delivered.events).size() + static_cast<std::size_t>(back), known.odometry_rows);
  EXPECT_EQ(test::count_observations(delivered.events), known.landmark_observations);
  EXPECT_THAT(notes,
              Contains("observations skipped of other robots: " + std::to_string(known.robot_observations)));
  if (known.truth_rows > 0) {
    EXPECT_EQ(only<Truth>(delivered.events).size(), known.truth_rows);
  }
  for (const auto& note : known.further_notes) EXPECT_THAT(notes, Contains(note));
}

std::string unknown_barcode(int barcode, int count) {
  return "observations of barcode " + std::to_string(barcode) +
         " skipped, which is in no table: " + std::to_string(count);
}

std::string repeated(int robot, int count) {
  return "rows of Robot" + std::to_string(robot) +
         "_Odometry.dat with the same stamp as the row before: " + std::to_string(count);
}

std::string first_row_late(int robot) {
  return "rows of Robot" + std::to_string(robot) + "_Odometry.dat skipped that go back in time: 1";
}

INSTANTIATE_TEST_SUITE_P(
    Mrclam, MrclamRecording,
    testing::Values(Recorded{"mrclam6", 1, 61785, 1534, 407, {unknown_barcode(43, 1)}},
                    Recorded{"mrclam6", 2, 65005, 3239, 792, {repeated(2, 1)}},
                    Recorded{"mrclam6", 3, 61158, 4348, 1277, {unknown_barcode(34, 2), repeated(3, 8)}},
                    Recorded{"mrclam6", 4, 52916, 2023, 373, {unknown_barcode(50, 3), repeated(4, 10)}},
                    Recorded{
                        "mrclam1", 3, 97351, 6771, 1969, {unknown_barcode(43, 2), repeated(3, 22)}, 89057},
                    Recorded{"mrclam9", 1, 17676, 8697, 1495, {unknown_barcode(52, 1), first_row_late(1)}},
                    Recorded{"mrclam9", 2, 17490, 8130, 969, {first_row_late(2)}},
                    Recorded{"mrclam9", 3, 17548, 7651, 1602, {first_row_late(3)}},
                    Recorded{"mrclam9", 4, 17812, 3753, 757, {first_row_late(4)}},
                    Recorded{"mrclam9", 5, 17689, 8454, 1647, {unknown_barcode(52, 1)}}));

}  // namespace
}  // namespace waymark
