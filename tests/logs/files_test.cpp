#include "workbench/logs/files.hpp"

#include <gmock/gmock.h>

#include "support/io_support.hpp"

namespace waymark {
namespace {

using test::TempFolder;
using testing::HasSubstr;

TEST(Files, ReadsBackWhatWasWritten) {
  const TempFolder folder;
  const std::string bytes("a\0b\r\n\xFF", 6);
  const auto file = folder.write("x", bytes);
  EXPECT_EQ(read_file(file).value(), bytes);
}

TEST(Files, WritingReplacesAndLeavesNoPartBehind) {
  const TempFolder folder;
  const auto file = folder.write("x", "a long first content");
  folder.write("x", "second");
  EXPECT_EQ(read_file(file).value(), "second");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

TEST(Files, MissingFileAndFolderInPlaceOfAFileAreErrorsThatNameThem) {
  const TempFolder folder;
  EXPECT_THAT(read_file(folder.path() / "none").error().message, HasSubstr("none: No such file"));
  EXPECT_THAT(read_file(folder.path()).error().message, HasSubstr("Is a directory"));
  EXPECT_THAT(write_file(folder.path() / "none" / "x", "a").error().message, HasSubstr("none/x"));
  EXPECT_FALSE(write_file(folder.path(), "a").ok());
}

TEST(Files, OutputFolderIsMadeWithThoseAboveIt) {
  const TempFolder folder;
  EXPECT_TRUE(ensure_output_folder(folder.path() / "a" / "b").ok());
  EXPECT_TRUE(std::filesystem::is_directory(folder.path() / "a" / "b"));
  EXPECT_TRUE(ensure_output_folder(folder.path() / "a" / "b").ok());
}

TEST(Files, OutputFolderThatCannotBeIsAnError) {
  const TempFolder folder;
  const auto file = folder.write("x", "a");
  EXPECT_THAT(ensure_output_folder(file).error().message, HasSubstr("x"));
  EXPECT_FALSE(ensure_output_folder(file / "below").ok());
}

TEST(Files, BaseNameIsTheLastPartWithOrWithoutSlash) {
  EXPECT_EQ(base_name("logs/loop"), "loop");
  EXPECT_EQ(base_name("logs/loop/"), "loop");
  EXPECT_EQ(base_name("logs/loop/."), "loop");
}

}  // namespace
}  // namespace waymark
