#include "workbench/config/read_file.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <gmock/gmock.h>

namespace waymark {
namespace {

using testing::HasSubstr;

TEST(ReadFile, DevicesAndPipesAreNotRead) {
  EXPECT_THAT(read_file("/dev/zero").error().message,
              HasSubstr("cannot read /dev/zero: not a regular file, but a device"));
  const std::string pipe = testing::TempDir() + "waymark_pipe_" + std::to_string(::getpid());
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THAT(read_file(pipe).error().message, HasSubstr("a pipe"));
  std::filesystem::remove(pipe);
}

TEST(ReadFile, FileOfUnknownSizeIsReadToItsEnd) {
  const auto text = read_file("/proc/self/status");
  ASSERT_TRUE(text.ok());
  EXPECT_THAT(*text, HasSubstr("Name:"));
}

TEST(ReadFile, SaysWhatIsWrongWithAPath) {
  EXPECT_THAT(read_file("/nowhere/x").error().message, HasSubstr("/nowhere/x: No such file"));
  EXPECT_THAT(read_file(testing::TempDir()).error().message, HasSubstr("Is a directory"));
  EXPECT_THAT(read_file(std::string(300, 'x')).error().message, HasSubstr("File name too long"));
}

}  // namespace
}  // namespace waymark
