#include "workbench/live/mjpeg_splitter.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace waymark::live {
namespace {

/// The frame of a JPEG file: markers and lengths are right, its content is nothing.
std::string jpeg(int size, char fill = 'x') {
  std::string text("\xff\xd8\xff\xe0\x00\x04\xff\xd9\xff\xda\x00\x03\x01",
                   13);  // an end inside a segment is none
  text += std::string(static_cast<std::size_t>(size), fill);
  text += std::string("\xff\x00\xff\xd3zz\xff\xd9", 8);
  return text;
}

std::vector<std::string> split(MjpegSplitter& frames, const std::string& bytes, std::size_t piece) {
  std::vector<std::string> images;
  for (std::size_t at = 0; at < bytes.size(); at += piece) {
    frames.add(std::string_view(bytes).substr(at, piece));
    while (auto frame = frames.next()) images.push_back(std::move(frame->jpeg));
  }
  return images;
}

TEST(MjpegSplitter, CutsImagesOneBehindTheOther) {
  for (const std::size_t piece : {std::size_t{1}, std::size_t{7}, std::size_t{100'000}}) {
    MjpegSplitter frames;
    EXPECT_EQ(split(frames, jpeg(100) + jpeg(5000) + jpeg(0), piece),
              (std::vector<std::string>{jpeg(100), jpeg(5000), jpeg(0)}));
    EXPECT_EQ(frames.damaged(), 0);
  }
}

TEST(MjpegSplitter, ReadsTheStampOfEachPart) {
  MjpegSplitter frames;
  frames.add("HTTP/1.0 200 OK\r\nContent-Type: multipart/x-mixed-replace; boundary=b\r\n\r\n");
  frames.add("--b\r\nContent-Type: image/jpeg\r\nX-Timestamp: 12.250000\r\n\r\n" + jpeg(10) + "\r\n");
  frames.add("--b\r\nContent-Type: image/jpeg\r\n\r\n" + jpeg(20) + "\r\n");
  const auto first = frames.next();
  ASSERT_TRUE(first);
  EXPECT_EQ(first->stamp, std::chrono::milliseconds(12'250));
  const auto second = frames.next();
  ASSERT_TRUE(second);
  EXPECT_FALSE(second->stamp);
  EXPECT_EQ(second->jpeg, jpeg(20));
}

TEST(MjpegSplitter, PassesOverImagesThatBreakOff) {
  MjpegSplitter frames;
  const std::string cut = jpeg(1000).substr(0, 500);
  EXPECT_EQ(split(frames, cut + "\r\n--b\r\n\r\n" + jpeg(30) + jpeg(40), 64),
            (std::vector<std::string>{jpeg(30), jpeg(40)}));
  EXPECT_EQ(frames.damaged(), 1);
}

TEST(MjpegSplitter, OutlivesNoise) {
  MjpegSplitter frames;
  std::string noise;
  unsigned int state = 1;
  for (int i = 0; i < 1'000'000; ++i) {
    state = state * 1664525U + 1013904223U;
    noise += static_cast<char>(state >> 24U);
  }
  static_cast<void>(split(frames, noise, 4096));
  EXPECT_EQ(
      split(frames, std::string(100'000, '\0') + std::string(70'000, '\xff') + jpeg(30) + jpeg(40), 4096)
          .back(),
      jpeg(40));
}

TEST(MjpegSplitter, GivesUpAnImageThatNeverEnds) {
  MjpegSplitter frames;
  frames.add(jpeg(10).substr(0, 13));
  for (int i = 0; i < 300; ++i) {
    frames.add(std::string(65'536, 'x'));
    EXPECT_FALSE(frames.next());
  }
  EXPECT_EQ(frames.damaged(), 1);
}

}  // namespace
}  // namespace waymark::live
