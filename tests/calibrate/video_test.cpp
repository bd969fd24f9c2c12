#include "workbench/calibrate/video.hpp"

#include <gtest/gtest.h>
#include <opencv2/videoio.hpp>

#include "support/io_support.hpp"

namespace waymark::calibrate {
namespace {

TEST(Video, GivesFiveFramesASecondInGrey) {
  const test::TempFolder folder;
  const auto path = folder.path() / "video.avi";
  cv::VideoWriter writer(path.string(), cv::CAP_OPENCV_MJPEG, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'),
                         25.0, {160, 120});
  ASSERT_TRUE(writer.isOpened());
  for (int i = 0; i < 50; ++i) writer.write(cv::Mat(120, 160, CV_8UC3, cv::Scalar::all(4 * i)));
  writer.release();

  const auto video = open_video(path);
  ASSERT_TRUE(video) << video.error().message;
  EXPECT_TRUE((*video)->is_stream());
  int frames = 0;
  while (const auto image = *(*video)->next()) {
    ASSERT_TRUE(image->pixels);
    EXPECT_EQ(image->name, "frame " + std::to_string(5 * frames));
    EXPECT_EQ(image->pixels->width_px(), 160);
    EXPECT_NEAR((*image->pixels)(80, 60), 20 * frames, 6);
    ++frames;
  }
  EXPECT_EQ(frames, 10);
  EXPECT_DOUBLE_EQ((*video)->progress(), 1.0);
}

TEST(Video, ThatNobodyCanDecodeIsRefused) {
  const test::TempFolder folder;
  const auto path = folder.write("video.txt", "no video\n");
  const auto video = open_video(path);
  ASSERT_FALSE(video);
  EXPECT_NE(video.error().message.find("nor a video that can be decoded"), std::string::npos);
}

}  // namespace
}  // namespace waymark::calibrate
