#include "workbench/run/image_strip.hpp"

#include <gtest/gtest.h>

namespace waymark {
namespace {

Stamp at_image(int image) { return stamp_from_seconds(image / 30.0); }

ImageStrip image_strip_of(int images, std::size_t most) {
  ImageStrip image_strip(most);
  const std::vector<vision::SearchRecord> search_records(2);
  const std::vector<Innovation> innovations{
      {.landmark = {LandmarkId::Family::kCorner, 1}},
      {.landmark = {LandmarkId::Family::kCorner, 2}, .outcome = Outcome::kGated}};
  for (int i = 0; i < images; ++i)
    image_strip.add(at_image(i), GreyImage(4, 3, static_cast<std::uint8_t>(i)), search_records, innovations);
  return image_strip;
}

TEST(ImageStrip, KeepsAllOfAShortRun) {
  const ImageStrip image_strip = image_strip_of(5, 8);
  ASSERT_EQ(image_strip.frames().size(), 5U);
  EXPECT_EQ(image_strip.frames()[3].stamp, at_image(3));
  EXPECT_EQ(image_strip.frames()[3].image, GreyImage(4, 3, 3));
  EXPECT_EQ(image_strip.frames()[3].search_records.size(), 2U);
  ASSERT_EQ(image_strip.frames()[3].refused.size(), 1U);
  EXPECT_EQ(image_strip.frames()[3].refused[0].number, 2);
}

TEST(ImageStrip, SpreadsWhatItKeepsEvenlyOverALongRun) {
  for (const std::size_t most : {7U, 8U}) {
    for (const int images : {8, 9, 15, 16, 17, 100, 1441}) {
      const auto image_strip = image_strip_of(images, most);
      const auto& frames = image_strip.frames();
      ASSERT_LE(frames.size(), most);
      EXPECT_GE(2 * frames.size(), most);
      const Duration step = frames[1].stamp - frames[0].stamp;
      EXPECT_EQ(frames.front().stamp, at_image(0));
      for (std::size_t i = 1; i < frames.size(); ++i)
        EXPECT_NEAR(to_seconds(frames[i].stamp - frames[i - 1].stamp), to_seconds(step), 1e-6);
      EXPECT_LE(at_image(images - 1) - frames.back().stamp, step);
    }
  }
}

}  // namespace
}  // namespace waymark
