#include "waymark/io/open_source.hpp"

#include <gmock/gmock.h>

#include "io_support.hpp"

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

TEST(OpenSource, RecognisesMrclamAndPassesTheRobotOn) {
  const TempFolder folder;
  folder.write("Barcodes.dat", "6 63\n");
  folder.write("Robot2_Odometry.dat", "1 0 0\n");
  folder.write("Robot2_Measurement.dat", "");
  EXPECT_THAT(open_source(folder.path()).error().message, HasSubstr("input.robot can be 2"));
  const auto source = open_source(folder.path(), {.mrclam = {.robot = 2}});
  ASSERT_TRUE(source.ok()) << source.error().message;
  EXPECT_EQ((*source)->info().format, "MRCLAM");
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
  EXPECT_THAT(error, HasSubstr("is a directory but no log: expected log.yaml with wheels.csv"));
  EXPECT_THAT(error, HasSubstr("Barcodes.dat"));
  EXPECT_THAT(error, HasSubstr("found a.txt, b.txt, c.txt, d.txt, e.txt and 1 more"));
}

TEST(OpenSource, FileOfALogPointsToItsFolder) {
  const TempFolder folder;
  folder.write("log.yaml", "waymark_log: 1\n");
  const auto file = folder.write("wheels.csv", "stamp_s,left_rad,right_rad\n");
  EXPECT_THAT(open_source(file).error().message, HasSubstr("give its folder, " + folder.path().string()));
  const TempFolder other;
  EXPECT_THAT(open_source(other.write("x.bin", "\x01")).error().message, HasSubstr("x.bin is no log"));
}

TEST(OpenSource, InputKeysAreBoundToTheOptions) {
  InputOptions options;
  Schema schema;
  describe(schema, options);
  EXPECT_TRUE(schema.set("input.robot", "3", "test").ok());
  EXPECT_TRUE(schema.set("input.fix_known_errors", "false", "test").ok());
  EXPECT_EQ(options.mrclam.robot, 3);
  EXPECT_FALSE(options.mrclam.fix_known_errors);
  EXPECT_FALSE(schema.set("input.robot", "0", "test").ok());
}

}  // namespace
}  // namespace waymark
