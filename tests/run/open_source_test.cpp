#include "workbench/run/open_source.hpp"

#include <gmock/gmock.h>

#include "support/data_dir.hpp"
#include "support/io_support.hpp"

#include "datasets/mat_support.hpp"

namespace waymark {
namespace {

using test::TempFolder;
using testing::HasSubstr;

TEST(OpenSource, RecognisesALogFolder) {
  const TempFolder folder;
  folder.write("log.yaml", "waymark_log: 1\n");
  const auto source = open_source(folder.path());
  ASSERT_TRUE(source.ok()) << source.error().message;
  EXPECT_EQ((*source)->info().format, "log folder");
}

TEST(OpenSource, LogYamlSaysWhatAFolderIsEvenWithABagInIt) {
  const TempFolder folder;
  folder.write("drive_0.mcap", "\x89MCAP0\r\n");
  EXPECT_FALSE(open_source(folder.path()).ok());
  folder.write("log.yaml", "waymark_log: 1\n");
  const auto source = open_source(folder.path());
  ASSERT_TRUE(source.ok()) << source.error().message;
  EXPECT_EQ((*source)->info().format, "log folder");
}

TEST(OpenSource, RecognisesMrclamAndPassesTheRobotOn) {
  const TempFolder folder;
  folder.write("Barcodes.dat", "6 63\n");
  folder.write("Robot2_Odometry.dat", "1 0 0\n");
  folder.write("Robot2_Measurement.dat", "");
  EXPECT_THAT(open_source(folder.path()).error().message, HasSubstr("input.robot can be 2"));
  const auto source = open_source(folder.path(), {.robot = 2});
  ASSERT_TRUE(source.ok()) << source.error().message;
  EXPECT_EQ((*source)->info().format, "MRCLAM");
}

TEST(OpenSource, RecognisesMatFilesByTheirVariablesAndChoosesTheRun) {
  const TempFolder folder;
  const std::string other = test::mat_header() + test::mat_variable("other", Eigen::MatrixXd::Zero(1, 1));
  const auto first = folder.write("a.mat", other);
  folder.write("b.mat", "damaged");
  EXPECT_THAT(open_source(first).error().message,
              HasSubstr("a.mat is not a log: expected the variables of Plaza (GT, DR, TD)"));
  EXPECT_THAT(open_source(folder.path()).error().message, HasSubstr("a.mat is not a log"));
  EXPECT_THAT(open_source(folder.path(), {.run = 2}).error().message,
              HasSubstr("b.mat: is not a MATLAB file that can be read"));
  EXPECT_THAT(open_source(folder.path(), {.run = 3}).error().message,
              HasSubstr("no run 3; input.run can be 1 to 2"));
}

TEST(OpenSource, RecognisesPlazaAsTextAndTheLabyrinth) {
  const TempFolder plaza;
  plaza.write("Plaza1_DR.txt", "1 0.1 0\n2 0.1 0\n");
  plaza.write("Plaza1_TD.txt", "1 2 5 10\n");
  const auto run = open_source(plaza.path());
  ASSERT_TRUE(run.ok()) << run.error().message;
  EXPECT_EQ((*run)->info().format, "Plaza");
  EXPECT_THAT(open_source(plaza.path() / "Plaza1_DR.txt").error().message, HasSubstr("give its folder"));
  const TempFolder labyrinth;
  labyrinth.write("Indoor_UWB_Input.txt", "range2 1 2 0.01 0 0 107 0\n");
  const auto other = open_source(labyrinth.path());
  ASSERT_TRUE(other.ok()) << other.error().message;
  EXPECT_EQ((*other)->info().format, "UWB labyrinth");
}

TEST(OpenSource, RecognisesPlanarMonoSlam) {
  const TempFolder folder;
  folder.write("trajectory.dat", "");
  folder.write("world.dat", "");
  folder.write("camera.dat", "no camera");
  EXPECT_THAT(open_source(folder.path()).error().message, HasSubstr("camera.dat:1: expected a line"));
  EXPECT_THAT(open_source(folder.path() / "world.dat").error().message, HasSubstr("give its folder"));
}

TEST(OpenSource, RecognisesTheLogsOfTheVehicle) {
  for (const char* name : {"victoria-park", "victoria-park/victoria_park.txt", "car-park"}) {
    WAYMARK_REQUIRE_DATA(name);
    const auto source = open_source(test::data_path(name));
    EXPECT_TRUE(source.ok()) << source.error().message;
  }
}

TEST(OpenSource, LogFolderWithoutLogYamlIsStillMeantAsOne) {
  const TempFolder folder;
  folder.write("wheels.csv", "stamp_s,left_rad,right_rad\n");
  EXPECT_THAT(open_source(folder.path()).error().message, HasSubstr("log.yaml is missing"));
}

TEST(OpenSource, PathThatDoesNotExistIsNamed) {
  EXPECT_EQ(open_source("/no/such/log").error().message, "no such file or directory: /no/such/log");
  const TempFolder folder;
  const auto file = folder.write("x", "");
  EXPECT_FALSE(open_source(file / "below").ok());
}

TEST(OpenSource, FolderThatIsNoLogTellsWhatWasExpectedAndFound) {
  const TempFolder folder;
  EXPECT_THAT(open_source(folder.path()).error().message, HasSubstr("found nothing"));
  for (const char* name : {"a.txt", "b.txt", "c.txt", "d.txt", "e.txt", "f.txt"}) folder.write(name, "");
  const std::string error = open_source(folder.path()).error().message;
  EXPECT_THAT(error, HasSubstr("is a directory, but not a log: expected a bag's metadata.yaml"));
  EXPECT_THAT(error, HasSubstr("log.yaml with wheels.csv"));
  EXPECT_THAT(error, HasSubstr("Barcodes.dat"));
  EXPECT_THAT(error, HasSubstr("found a.txt, b.txt, c.txt, d.txt, e.txt and 1 more"));
}

TEST(OpenSource, FileOfALogPointsToItsFolder) {
  const TempFolder folder;
  folder.write("log.yaml", "waymark_log: 1\n");
  const auto file = folder.write("wheels.csv", "stamp_s,left_rad,right_rad\n");
  EXPECT_THAT(open_source(file).error().message, HasSubstr("give its folder, " + folder.path().string()));
  const TempFolder other;
  EXPECT_THAT(open_source(other.write("x.bin", "\x01")).error().message, HasSubstr("x.bin is not a log"));
  EXPECT_THAT(open_source(other.write("drive.bag", "")).error().message,
              HasSubstr("drive.bag: the file is empty"));
}

}  // namespace
}  // namespace waymark
