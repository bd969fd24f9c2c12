#include "workbench/bags/unpacked_file.hpp"

#include <gmock/gmock.h>

#include "support/io_support.hpp"

#include "bags/zstd_frame.hpp"

namespace waymark::bag {
namespace {

using test::zstd_frame;
using testing::HasSubstr;
using waymark::test::TempFolder;

TEST(UnpackedFile, HoldsWhatWasPackedUntilItIsGone) {
  const TempFolder folder;
  std::string content;
  for (int i = 0; i < 300'000; ++i) content += std::to_string(i);
  const auto packed = folder.write("drive_0.db3.zstd", zstd_frame(content));
  std::filesystem::path path;
  {
    const auto file = UnpackedFile::unpack(packed);
    ASSERT_TRUE(file.ok()) << file.error().message;
    path = (*file)->path();
    EXPECT_EQ(path.filename(), "drive_0.db3");
    EXPECT_EQ(read_file(path).value(), content);
  }
  EXPECT_FALSE(std::filesystem::exists(path.parent_path()));
}

TEST(UnpackedFile, RefusesWhatIsDamagedOrGrowsWithoutEnd) {
  const TempFolder folder;
  const std::string frame = zstd_frame(std::string(1000, 'a'));
  EXPECT_THAT(
      UnpackedFile::unpack(folder.write("cut.zstd", frame.substr(0, frame.size() - 4))).error().message,
      HasSubstr("cut.zstd: cannot be unpacked"));
  std::string zeros;
  zeros.resize(70'000'000);
  EXPECT_THAT(UnpackedFile::unpack(folder.write("bomb.zstd", zstd_frame(zeros))).error().message,
              HasSubstr("it holds more than"));
}

TEST(UnpackedFile, KnowsFramesByTheirFirstBytes) {
  EXPECT_TRUE(is_zstd(zstd_frame("a")));
  EXPECT_FALSE(is_zstd(std::string("\0\1\0\0", 4)));
  EXPECT_FALSE(is_zstd(""));
}

}  // namespace
}  // namespace waymark::bag
