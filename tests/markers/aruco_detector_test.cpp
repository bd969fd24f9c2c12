#include "waymark/markers/aruco_detector.hpp"

#include <gtest/gtest.h>

#include "waymark/markers/aruco_codes.hpp"

#include "drawn_marker.hpp"

namespace waymark::markers {
namespace {

constexpr int kCell_px = 6;

/// A marker on its paper, turned by quarters clockwise; the upper left of the paper at (u, v).
void print(GreyImage& image, const MarkerDictionary& dictionary, int number, int turns, int u, int v) {
  const int bits = dictionary.bits_per_side, side = bits + 4;
  const std::uint64_t code = aruco_code(dictionary, number);
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column) {
      const int depth = std::min(std::min(column, row), std::min(side - 1 - column, side - 1 - row));
      const int place = bits * bits - 1 - bits * (row - 2) - (column - 2);
      const bool is_white = depth == 0 || (depth > 1 && (code >> place & 1) != 0);
      int x = column, y = row;
      for (int i = 0; i < turns; ++i) std::tie(x, y) = std::pair(side - 1 - y, x);
      for (int dv = 0; dv < kCell_px; ++dv)
        for (int du = 0; du < kCell_px; ++du)
          image(u + kCell_px * x + du, v + kCell_px * y + dv) = is_white ? 220 : 30;
    }
}

/// Which dictionaries are the beginning of no other.
std::vector<MarkerDictionary> largest_dictionaries() {
  std::vector<MarkerDictionary> all;
  for (const char* name : {"4x4_1000", "5x5_1000", "6x6_1000", "7x7_1000", "aruco_original"})
    all.push_back(*find_marker_dictionary(name));
  return all;
}

/// 48 to an image, each turned otherwise than the last.
TEST(ArucoDetector, ReadsEveryMarkerOfEveryDictionary) {
  constexpr int kColumns = 8, kRows = 6, kPitch_px = 80;
  for (const MarkerDictionary& dictionary : largest_dictionaries()) {
    const auto detector = make_aruco_detector(dictionary);
    for (int first = 0; first < dictionary.size; first += kColumns * kRows) {
      GreyImage image(kColumns * kPitch_px, kRows * kPitch_px, 120);
      const int count = std::min(kColumns * kRows, dictionary.size - first);
      for (int i = 0; i < count; ++i)
        print(image, dictionary, first + i, i % 4, kPitch_px * (i % kColumns) + 7,
              kPitch_px * (i / kColumns) + 7);
      const auto found = detector->detect(image);
      ASSERT_EQ(found.size(), static_cast<std::size_t>(count)) << dictionary.name << ' ' << first;
      if (dictionary.name == "aruco_original") continue;  // some of its patterns are others, turned
      for (int i = 0; i < count; ++i)
        EXPECT_EQ(found[static_cast<std::size_t>(i)].id, first + i) << dictionary.name;
    }
  }
}

TEST(ArucoDetector, CornersBeginAtTheUpperLeftOfThePattern) {
  const MarkerDictionary dictionary = *find_marker_dictionary("6x6_50");
  const auto detector = make_aruco_detector(dictionary);
  const double near = 10 + kCell_px - 0.5, far = near + 8 * kCell_px;
  const Corners upright{{{near, near}, {far, near}, {far, far}, {near, far}}};
  for (int turns = 0; turns < 4; ++turns) {
    GreyImage image(100, 100, 120);
    print(image, dictionary, 5, turns, 10, 10);
    const auto found = detector->detect(image);
    ASSERT_EQ(found.size(), 1U) << turns;
    for (std::size_t i = 0; i < 4; ++i)
      EXPECT_LT((found[0].corners_px[i] - upright[(i + static_cast<std::size_t>(turns)) % 4]).norm(), 0.7)
          << turns << ' ' << i;
  }
}

TEST(ArucoDetector, TellsTwoOfOneIdentityApart) {
  const MarkerDictionary dictionary = *find_marker_dictionary("4x4_50");
  GreyImage image(200, 100, 120);
  print(image, dictionary, 3, 0, 10, 10);
  print(image, dictionary, 3, 1, 110, 20);
  EXPECT_EQ(make_aruco_detector(dictionary)->detect(image).size(), 2U);
}

TEST(ArucoDetector, ReadsNoMarkerOfOtherCells) {
  for (const auto& [printed, read] : {std::pair("6x6_50", "4x4_1000"), std::pair("4x4_50", "5x5_1000")}) {
    const MarkerDictionary dictionary = *find_marker_dictionary(printed);
    const auto detector = make_aruco_detector(*find_marker_dictionary(read));
    for (int number = 0; number < dictionary.size; ++number) {
      GreyImage image(100, 100, 120);
      print(image, dictionary, number, 0, 10, 10);
      EXPECT_TRUE(detector->detect(image).empty()) << read << ' ' << number;
    }
  }
}

TEST(ArucoDetector, NeedsNoMoreThanTheView) {
  const MarkerDictionary dictionary = *find_marker_dictionary("4x4_50");
  GreyImage image(300, 200, 120);
  print(image, dictionary, 9, 2, 120, 60);
  const auto detector = make_aruco_detector(dictionary);
  const auto of_all = detector->detect(image),
             of_part = detector->detect(image.view().part(100, 50, 120, 90));
  ASSERT_EQ(of_all.size(), 1U);
  ASSERT_EQ(of_part.size(), 1U);
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_LT((of_all[0].corners_px[i] - of_part[0].corners_px[i] - Eigen::Vector2d(100, 50)).norm(), 1e-4);
}

}  // namespace
}  // namespace waymark::markers
