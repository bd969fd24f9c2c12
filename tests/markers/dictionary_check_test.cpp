#include "waymark/markers/dictionary_check.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/data_dir.hpp"

#include "workbench/logs/image_file.hpp"

namespace waymark::markers {
namespace {

using testing::HasSubstr;

std::shared_ptr<const GreyImage> photograph(const char* name) {
  return std::make_shared<const GreyImage>(*read_image(test::data_path("marker-photos") / name));
}

/// Shows one image ten times to a check of that dictionary.
std::optional<std::string> verdict(const char* name, const char* dictionary) {
  const auto image = photograph(name);
  DictionaryCheck check(*find_marker_dictionary(dictionary));
  const auto detector = make_marker_detector(*find_marker_dictionary(dictionary));
  for (int i = 0; i < 10; ++i) {
    std::vector<std::int32_t> ids;
    for (const Marker& marker : (*detector)->detect(*image)) ids.push_back(marker.id);
    check.add(image, ids);
  }
  return check.verdict();
}

class DictionaryCheckPhotos : public testing::Test {
 protected:
  void SetUp() override { WAYMARK_REQUIRE_DATA("marker-photos"); }
};

TEST_F(DictionaryCheckPhotos, SaysNothingOfTheRightDictionary) {
  EXPECT_EQ(verdict("singlemarkersoriginal.jpg", "6x6_250"), std::nullopt);
  EXPECT_EQ(verdict("tag_245-246_d7_14cm.png", "5x5_1000"), std::nullopt);
}

TEST_F(DictionaryCheckPhotos, NamesTheRightDictionary) {
  const auto line = verdict("choriginal.jpg", "5x5_100");
  ASSERT_TRUE(line.has_value());
  EXPECT_THAT(*line, HasSubstr("markers.dictionary: 5x5_100 found 0 markers"));
  EXPECT_THAT(*line, HasSubstr("6x6_50 finds"));  // identities 0 to 16
}

TEST_F(DictionaryCheckPhotos, NamesAprilTags) {
  if (!can_detect(MarkerKind::kAprilTag)) GTEST_SKIP() << "built without libapriltag";
  const auto line = verdict("33369213973_9d9bb4cc96_c.jpg", "4x4_50");
  ASSERT_TRUE(line.has_value());
  EXPECT_THAT(*line, HasSubstr("apriltag_36h11 finds"));
}

TEST_F(DictionaryCheckPhotos, SaysThatIdentitiesComeAndGo) {
  DictionaryCheck check(*find_marker_dictionary("4x4_50"));
  const auto image = photograph("singlemarkersoriginal.jpg");
  for (std::int32_t i = 0; i < 10; ++i) check.add(image, std::vector<std::int32_t>{i});
  const auto line = check.verdict();
  ASSERT_TRUE(line.has_value());
  EXPECT_THAT(*line, HasSubstr("10 markers of 10 identities in 10 images"));
  EXPECT_THAT(*line, HasSubstr("6x6_250 finds"));
}

TEST(DictionaryCheck, WithoutImagesSaysNothing) {
  EXPECT_EQ(DictionaryCheck(*find_marker_dictionary("4x4_50")).verdict(), std::nullopt);
}

TEST(DictionaryCheck, WithoutAnyMarkerSaysSo) {
  DictionaryCheck check(*find_marker_dictionary("4x4_50"));
  const auto wall = std::make_shared<const GreyImage>(320, 240, 100);
  for (int i = 0; i < 100; ++i) check.add(wall, {});
  EXPECT_THAT(check.verdict().value_or(""),
              HasSubstr("4x4_50 found 0 markers of 0 identities in 100 images"));
}

}  // namespace
}  // namespace waymark::markers
