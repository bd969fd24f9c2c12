#include "workbench/calibrate/opencv.hpp"

#include <cstdlib>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "photographed_board.hpp"
#include "workbench/calibrate/video.hpp"

namespace waymark::calibrate {
namespace {

using testing::HasSubstr;

/// Where OpenCV's module is not installed.
class WithoutOpenCv : public testing::Test {
 protected:
  void SetUp() override {
    const char* folder = std::getenv("WAYMARK_MODULE_DIR");
    if (folder != nullptr) folder_ = folder;
    ASSERT_EQ(setenv("WAYMARK_MODULE_DIR", "/nowhere", 1), 0);
  }
  void TearDown() override {
    if (folder_.empty())
      unsetenv("WAYMARK_MODULE_DIR");
    else
      setenv("WAYMARK_MODULE_DIR", folder_.c_str(), 1);
  }

 private:
  std::string folder_;
};

TEST_F(WithoutOpenCv, OneLineSaysHowToGetIt) {
  const auto opencv = load_opencv("seeing");
  ASSERT_FALSE(opencv);
  EXPECT_EQ(
      opencv.error().message,
      "seeing needs the OpenCV module (waymark-opencv.so is not installed): run scripts/setup.sh --opencv "
      "and build again");
}

TEST_F(WithoutOpenCv, NoBoardIsLookedForAndNoVideoRead) {
  const auto finder = make_board_finder(test::chessboard());
  ASSERT_FALSE(finder);
  EXPECT_THAT(finder.error().message, HasSubstr("finding a board in images needs the OpenCV module"));
  EXPECT_FALSE(guess_chessboard(test::DrawnBoard{}.draw(test::chessboard(), 480, 400)));
  const auto video = open_video("board.mp4");
  ASSERT_FALSE(video);
  EXPECT_THAT(video.error().message, HasSubstr("board.mp4: reading a video needs the OpenCV module"));
}

}  // namespace
}  // namespace waymark::calibrate
