// The detector against OpenCV's: in every image it finds at least as much, and no more that is not there.

#include <gtest/gtest.h>

#include "support/data_dir.hpp"
#include "waymark/markers/aruco_codes.hpp"
#include "waymark/markers/aruco_detector.hpp"
#include "waymark/markers/black_border.hpp"

#include "drawn_marker.hpp"
#include "opencv_aruco.hpp"
#include "workbench/logs/image_file.hpp"
#include "workbench/sim/simulation.hpp"

namespace waymark::markers {
namespace {

/// The same dictionary, read by both.
struct Both {
  explicit Both(std::string_view name)
      : dictionary(*find_marker_dictionary(name)),
        ours(make_aruco_detector(dictionary)),
        opencv(dictionary) {}

  MarkerDictionary dictionary;
  std::unique_ptr<MarkerDetector> ours;
  test::OpenCvAruco opencv;
};

bool has(const std::vector<Marker>& markers, const Marker& marker) {
  return std::ranges::any_of(markers,
                             [&](const Marker& each) { return test::OpenCvAruco::are_one(each, marker); });
}

/// What OpenCV finds of identities up to the last, and the detector does not.
std::vector<std::int32_t> missed(Both& both, const ImageView& image, std::int32_t last) {
  const auto found = both.ours->detect(image);
  std::vector<std::int32_t> ids;
  for (const Marker& marker : both.opencv.detect(image))
    if (marker.id <= last && !has(found, marker)) ids.push_back(marker.id);
  return ids;
}

std::int64_t count_beyond(const std::vector<Marker>& markers, std::int32_t last) {
  return std::ranges::count_if(markers, [&](const Marker& marker) { return marker.id > last; });
}

TEST(ArucoAgainstOpenCv, DictionariesAreTheSame) {
  for (const MarkerDictionary& dictionary : marker_dictionaries()) {
    if (dictionary.kind != MarkerKind::kAruco) continue;
    const auto theirs = test::opencv_dictionary(dictionary);
    const int bits = dictionary.bits_per_side;
    ASSERT_EQ(theirs->bytesList.rows, dictionary.size) << dictionary.name;
    ASSERT_EQ(theirs->markerSize, bits) << dictionary.name;
    for (int number = 0; number < dictionary.size; ++number) {
      const cv::Mat cells =
          cv::aruco::Dictionary::getBitsFromByteList(theirs->bytesList.rowRange(number, number + 1), bits);
      std::uint64_t code = 0;
      for (int i = 0; i < bits * bits; ++i) code = code << 1 | cells.at<std::uint8_t>(i / bits, i % bits);
      ASSERT_EQ(aruco_code(dictionary, number), code) << dictionary.name << ' ' << number;
    }
  }
}

TEST(ArucoAgainstOpenCv, FindsAllInPhotographs) {
  WAYMARK_REQUIRE_DATA("marker-photos");
  for (const auto& [file, dictionary] :
       {std::pair("singlemarkersoriginal.jpg", "6x6_250"), std::pair("choriginal.jpg", "6x6_250"),
        std::pair("chocclusion.jpg", "6x6_250"), std::pair("tag_01_d7_14cm.png", "5x5_1000"),
        std::pair("tag_245-246_d7_14cm.png", "5x5_1000"), std::pair("arucoboard.png", "6x6_1000")}) {
    Both both(dictionary);
    const auto image = read_image(test::data_path("marker-photos") / file);
    ASSERT_TRUE(image) << file;
    EXPECT_FALSE(both.opencv.detect(*image).empty()) << file;
    EXPECT_TRUE(missed(both, *image, both.dictionary.size).empty()) << file;
  }
}

/// Identities in a room are 0 to 11; posters and bricks look a little like others.
TEST(ArucoAgainstOpenCv, FindsAllInRoomsAndNoFalseIdentityMore) {
  constexpr std::int32_t kLast = 11;
  sim::SimOptions options = *sim::scenario("marker-room");
  options.camera_simulator.rate_hz = 0.75;
  Both both("4x4_50");
  std::int64_t false_ours = 0, false_opencv = 0, found = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const auto room = sim::Simulation::make("room", options, seed);
    ASSERT_TRUE(room);
    for (auto event = (*room)->next(); event && *event; event = (*room)->next()) {
      const auto* image = std::get_if<Image>(&(*event)->content);
      if (image == nullptr) continue;
      EXPECT_TRUE(missed(both, *image->pixels, kLast).empty())
          << "seed " << seed << " at " << to_seconds((*event)->stamp) << " s";
      const auto ours = both.ours->detect(*image->pixels);
      found += std::ssize(ours);
      false_ours += count_beyond(ours, kLast);
      false_opencv += count_beyond(both.opencv.detect(*image->pixels), kLast);
    }
  }
  EXPECT_GT(found, 150);
  EXPECT_LE(false_ours, std::max<std::int64_t>(1, false_opencv));
}

/// 1 to 3.5 m away, tilted by up to 70 degrees, with the noise of a camera.
TEST(ArucoAgainstOpenCv, FindsAllAtASlant) {
  Both both("4x4_50");
  const Camera camera(test::marker_camera());
  RandomStream random(4, StreamPurpose::kWorld);
  int found_by_opencv = 0;
  for (int i = 0; i < 60; ++i) {
    const MarkerPose pose = test::random_marker_pose(random, 70.0 * M_PI / 180.0);
    GreyImage image(640, 480, 120);
    test::draw_marker(image, camera, pose, 0.2, i % sim::kMarkerPatterns);
    for (int v = 0; v < 480; ++v)
      for (int u = 0; u < 640; ++u)
        image(u, v) = static_cast<std::uint8_t>(
            std::lround(image(u, v) + std::clamp(2.0 * random.normal(), -9.0, 9.0)));
    EXPECT_TRUE(missed(both, image, both.dictionary.size).empty()) << i;
    for (const Marker& marker : both.ours->detect(image)) EXPECT_EQ(marker.id, i % sim::kMarkerPatterns);
    found_by_opencv += static_cast<int>(both.opencv.detect(image).size());
  }
  EXPECT_GT(found_by_opencv, 45);
}

TEST(ArucoAgainstOpenCv, FindsNoMoreWhereThereIsNone) {
  WAYMARK_REQUIRE_DATA("gray-images");
  std::vector<GreyImage> images;
  for (const char* file : {"blox.jpg", "box.png", "box_in_scene.png", "building.jpg", "graf1.png",
                           "graf3.png", "home.jpg", "leuvenA.jpg", "leuvenB.jpg", "rubberwhale1.png"})
    images.push_back(*read_image(test::data_path("gray-images") / file));
  for (const char* name : {"4x4_50", "4x4_1000", "5x5_1000", "6x6_1000", "7x7_1000", "aruco_original"}) {
    Both both(name);
    std::size_t ours = 0, opencv = 0;
    for (const GreyImage& image : images) {
      ours += both.ours->detect(image).size();
      opencv += both.opencv.detect(image).size();
    }
    EXPECT_LE(ours, opencv) << name;
  }
}

}  // namespace
}  // namespace waymark::markers
