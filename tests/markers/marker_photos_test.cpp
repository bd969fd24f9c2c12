#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/data_dir.hpp"
#include "waymark/markers/marker_detector.hpp"

#include "workbench/logs/image_file.hpp"

// The photographs of marker-photos, whose README lists what is in them.

namespace waymark::markers {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::ElementsAreArray;
using testing::IsSupersetOf;

std::vector<Marker> detect_in(const fs::path& file, std::string_view dictionary) {
  const auto image = read_image(file);
  EXPECT_TRUE(image.ok()) << file;
  if (!image.ok()) return {};
  return (*make_marker_detector(*find_marker_dictionary(dictionary)))->detect(*image);
}

std::vector<Marker> detect(const std::string& name, std::string_view dictionary) {
  return detect_in(test::data_path("marker-photos/" + name), dictionary);
}

std::vector<std::int32_t> ids(const std::vector<Marker>& markers) {
  std::vector<std::int32_t> all;
  for (const Marker& each : markers) all.push_back(each.id);
  return all;
}

std::vector<std::int32_t> range(std::int32_t first, std::int32_t last) {
  std::vector<std::int32_t> all;
  for (std::int32_t id = first; id <= last; ++id) all.push_back(id);
  return all;
}

class ArucoPhotos : public testing::Test {
 protected:
  void SetUp() override { WAYMARK_REQUIRE_DATA("marker-photos"); }
};

TEST_F(ArucoPhotos, SingleMarkers) {
  EXPECT_THAT(ids(detect("singlemarkersoriginal.jpg", "6x6_250")), ElementsAre(23, 40, 62, 98, 124, 203));
}

TEST_F(ArucoPhotos, CharucoBoard) {
  EXPECT_THAT(ids(detect("choriginal.jpg", "6x6_250")), ElementsAreArray(range(0, 16)));
}

TEST_F(ArucoPhotos, OccludedCharucoBoardHasNoFalseIdentity) {
  const auto found = ids(detect("chocclusion.jpg", "6x6_250"));
  EXPECT_THAT(found, IsSupersetOf({9, 12, 15}));
  EXPECT_TRUE(std::ranges::all_of(found, [](int id) { return id <= 16; }));
}

TEST_F(ArucoPhotos, CeilingMarkers) {
  EXPECT_THAT(ids(detect("tag_01_d7_14cm.png", "5x5_1000")), ElementsAre(1));
  EXPECT_THAT(ids(detect("tag_245-246_d7_14cm.png", "5x5_1000")), ElementsAre(245, 246));
}

TEST_F(ArucoPhotos, GridBoard) {
  auto expected = range(10, 34);
  expected.insert(expected.begin(), {0, 5, 6});
  EXPECT_THAT(ids(detect("arucoboard.png", "6x6_1000")), ElementsAreArray(expected));
}

/// The bag is not compressed: its one JPEG file lies in it as it is.
TEST_F(ArucoPhotos, ImageInABag) {
  std::ifstream bag(test::data_path("marker-photos/aruco_images.bag"), std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(bag), {}};
  const auto begin = bytes.find("\xFF\xD8\xFF");
  ASSERT_NE(begin, std::string::npos);
  const fs::path file = fs::path(testing::TempDir()) / "waymark_aruco_images.jpg";
  std::ofstream(file, std::ios::binary) << bytes.substr(begin, bytes.rfind("\xFF\xD9") + 2 - begin);
  EXPECT_THAT(ids(detect_in(file, "5x5_1000")), ElementsAre(100, 103, 106, 107, 110, 111, 112));
  fs::remove(file);
}

/// Clockwise in the image, as seen by somebody in front of the marker.
TEST_F(ArucoPhotos, CornersGoClockwise) {
  for (const Marker& marker : detect("choriginal.jpg", "6x6_250")) {
    const auto& c = marker.corners_px;
    for (std::size_t i = 0; i < 4; ++i) {
      const Eigen::Vector2d a = c[(i + 1) % 4] - c[i], b = c[(i + 2) % 4] - c[(i + 1) % 4];
      EXPECT_GT(a.x() * b.y() - a.y() * b.x(), 0.0);
    }
  }
}

class AprilTagPhotos : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    WAYMARK_REQUIRE_DATA("marker-photos");
    if (!can_detect(MarkerKind::kAprilTag)) GTEST_SKIP() << "built without libapriltag";
  }
};

/// One tag per line of "id, (x y), (x y), (x y), (x y)", counter-clockwise from the lower left, pixel edges.
std::vector<Marker> expected_tags(const fs::path& file) {
  std::vector<Marker> all;
  std::ifstream text(file);
  for (std::string line; std::getline(text, line);) {
    std::ranges::replace_if(
        line, [](char c) { return c == ',' || c == '(' || c == ')'; }, ' ');
    std::istringstream numbers(line);
    Marker tag;
    numbers >> tag.id;
    for (std::size_t i = 4; i-- > 0;) numbers >> tag.corners_px[i].x() >> tag.corners_px[i].y();
    for (auto& corner : tag.corners_px) corner.array() -= 0.5;
    if (numbers) all.push_back(tag);
  }
  return all;
}

double largest_distance_px(const Marker& a, const Marker& b) {
  double largest_px = 0.0;
  for (std::size_t i = 0; i < 4; ++i)
    largest_px = std::max(largest_px, (a.corners_px[i] - b.corners_px[i]).norm());
  return largest_px;
}

TEST_P(AprilTagPhotos, CornersAreThoseOfTheAuthors) {
  const std::string name = GetParam();
  const auto expected = expected_tags(test::data_path("marker-photos/" + name + ".txt"));
  const auto found = detect(name + ".jpg", "apriltag_36h11");
  ASSERT_FALSE(expected.empty());
  EXPECT_EQ(found.size(), expected.size());
  for (const Marker& tag : expected) {
    double nearest_px = 1e9;
    for (const Marker& each : found)
      if (each.id == tag.id) nearest_px = std::min(nearest_px, largest_distance_px(each, tag));
    EXPECT_LT(nearest_px, 0.5) << tag.id << " at " << tag.corners_px[0].transpose();
  }
}

INSTANTIATE_TEST_SUITE_P(Nasa, AprilTagPhotos,
                         testing::Values("33369213973_9d9bb4cc96_c", "34085369442_304b6bafd9_c"),
                         [](const auto& each) { return std::string(each.param).substr(0, 11); });

}  // namespace
}  // namespace waymark::markers
