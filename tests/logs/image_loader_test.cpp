#include "workbench/logs/image_loader.hpp"

#include <gmock/gmock.h>

#include "support/io_support.hpp"

#include "workbench/logs/camera_yaml.hpp"
#include "workbench/logs/log_folder.hpp"

namespace waymark {
namespace {

using test::TempFolder;
using testing::HasSubstr;

GreyImage gradient(int width, int height) {
  GreyImage image(width, height);
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u) image(u, v) = static_cast<std::uint8_t>(u + 3 * v);
  return image;
}

/// A log of three images between two odometry readings.
void write_frames(const TempFolder& folder) {
  folder.write("log.yaml", "waymark_log: 1\n");
  folder.write("velocity.csv", "stamp_s,v_mps,w_radps\n0,1,0\n9,0,0\n");
  folder.write("images.csv", "stamp_s,file\n1,a.png\n2,b.png\n3,c.png\n");
  std::filesystem::create_directories(folder.path() / "images");
  for (const char* name : {"a.png", "b.png", "c.png"})
    ASSERT_TRUE(write_png(folder.path() / "images" / name, gradient(40, 30)).ok());
}

TEST(ImageLoader, GivesImagesTheirPixelsAndLeavesTheRest) {
  const TempFolder folder;
  write_frames(folder);
  ImageLoader loader(*open_log_folder(folder.path()));
  EXPECT_EQ(loader.info().format, "log folder");
  const auto delivered = test::read_all(loader);
  EXPECT_EQ(delivered.events.size(), 5U);
  const auto images = test::only<Image>(delivered.events);
  ASSERT_EQ(images.size(), 3U);
  for (const auto& [stamp, image] : images) EXPECT_EQ(*image.pixels, gradient(40, 30));
  EXPECT_TRUE(loader.notes().empty());
  EXPECT_EQ(loader.progress(), 1.0);
}

TEST(ImageLoader, SkipsAndCountsWhatCannotBeRead) {
  const TempFolder folder;
  write_frames(folder);
  const auto whole = read_file(folder.path() / "images/b.png").value();
  folder.write("images/b.png", whole.substr(0, whole.size() / 2));
  folder.write("images/c.png", "no image");
  ImageLoader loader(*open_log_folder(folder.path()));
  EXPECT_EQ(test::read_all(loader).events.size(), 3U);
  ASSERT_EQ(loader.notes().size(), 1U);
  EXPECT_THAT(loader.notes()[0], HasSubstr("images skipped: 2, the first because: "));
  EXPECT_THAT(loader.notes()[0], HasSubstr("b.png"));
}

TEST(ImageLoader, ScalesASequenceByTheBitsOfTheCamera) {
  const TempFolder folder;
  write_frames(folder);
  // 10 bits are seen first, 12 then, and in the dark third image they are still the camera's.
  const std::string white = "P5 1 1 65535\n";
  folder.write("images/a.png", white + "\3\xff");
  folder.write("images/b.png", white + "\x0f\xff");
  folder.write("images/c.png", white + "\3\xff");
  ImageLoader loader(*open_log_folder(folder.path()));
  const auto images = test::only<Image>(test::read_all(loader).events);
  ASSERT_EQ(images.size(), 3U);
  EXPECT_EQ((*images[0].second.pixels)(0, 0), 255);
  EXPECT_EQ((*images[1].second.pixels)(0, 0), 255);
  EXPECT_EQ((*images[2].second.pixels)(0, 0), 63);
  ASSERT_EQ(loader.notes().size(), 1U);
  EXPECT_THAT(loader.notes()[0], HasSubstr("uses 12 of 16 bits (largest value 4095)"));
}

TEST(ImageLoader, SkipsImagesOfAnotherSizeThanTheCameras) {
  const TempFolder folder;
  write_frames(folder);
  folder.write("camera.yaml", to_camera_yaml({.width_px = 40, .height_px = 30}, "front"));
  ASSERT_TRUE(write_png(folder.path() / "images/b.png", gradient(30, 40)).ok());
  ImageLoader loader(*open_log_folder(folder.path()));
  EXPECT_EQ(test::only<Image>(test::read_all(loader).events).size(), 2U);
  ASSERT_EQ(loader.notes().size(), 1U);
  EXPECT_THAT(loader.notes()[0], HasSubstr("30 x 40 pixels, expected 40 x 30"));
}

}  // namespace
}  // namespace waymark
