#include "workbench/calibrate/image_source.hpp"

#include <fstream>

#include <gmock/gmock.h>

#include "support/io_support.hpp"

#include "workbench/logs/image_file.hpp"

namespace waymark::calibrate {
namespace {

namespace fs = std::filesystem;

class ImageSourceTest : public testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(folder_ / "none");
    for (const char* name : {"b1.png", "a2.png", "a1.PNG"})
      ASSERT_TRUE(write_png(folder_ / name, GreyImage(20, 10, 50)));
    std::ofstream(folder_ / "c.jpg") << "\xFF\xD8 cut off";
    std::ofstream(folder_ / "notes.txt") << "not an image";
  }

  static std::vector<std::string> names(const std::vector<std::string>& inputs) {
    std::vector<std::string> all;
    const auto source = open_images(inputs);
    if (!source) return {source.error().message};
    while (const auto image = *(*source)->next())
      all.push_back(image->name + (image->pixels ? "" : " unreadable"));
    return all;
  }

  test::TempFolder temp_;
  fs::path folder_ = temp_.path();
};

TEST_F(ImageSourceTest, FoldersPatternsAndFiles) {
  const std::string folder = folder_.string();
  EXPECT_THAT(names({folder}), testing::ElementsAre("a1.PNG", "a2.png", "b1.png", "c.jpg unreadable"));
  EXPECT_THAT(names({folder + "/a*"}), testing::ElementsAre("a1.PNG", "a2.png"));
  EXPECT_THAT(names({folder + "/b1.png", folder + "/a2.png"}), testing::ElementsAre("b1.png", "a2.png"));
  EXPECT_FALSE((*open_images({folder}))->is_stream());
}

TEST_F(ImageSourceTest, WhatHoldsNoImagesSaysWhatWasExpected) {
  const std::string folder = folder_.string();
  EXPECT_THAT(names({folder + "/none"}), testing::ElementsAre(testing::HasSubstr("none: no images")));
  EXPECT_THAT(names({folder + "/x*.png"}), testing::ElementsAre(testing::HasSubstr("there is no such file")));
  EXPECT_THAT(names({folder + "/b1.png", folder + "/notes.txt"}),
              testing::ElementsAre(testing::HasSubstr("notes.txt is not an image")));
  EXPECT_FALSE(open_images({folder + "/notes.txt"}));
}

TEST_F(ImageSourceTest, ImagesOfALogAreAStreamOfFiveASecond) {
  const fs::path log = folder_ / "log";
  fs::create_directories(log / "images");
  std::ofstream(log / "log.yaml") << "waymark_log: 1\n";
  std::ofstream table(log / "images.csv");
  table << "stamp_s,file\n";
  for (int i = 0; i < 10; ++i) {
    const std::string name = std::to_string(i) + ".png";
    ASSERT_TRUE(write_png(log / "images" / name, GreyImage(20, 10, 50)));
    table << 0.1 * i << "," << name << "\n";
  }
  table.close();
  const auto source = open_images({log.string()});
  ASSERT_TRUE(source) << source.error().message;
  EXPECT_TRUE((*source)->is_stream());
  int count = 0;
  while (const auto image = *(*source)->next()) count += image->pixels ? 1 : 0;
  EXPECT_EQ(count, 5);
}

}  // namespace
}  // namespace waymark::calibrate
