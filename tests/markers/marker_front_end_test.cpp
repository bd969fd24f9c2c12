#include "waymark/markers/marker_front_end.hpp"

#include <stdexcept>
#include <system_error>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/no_more_threads.hpp"

#include "markers/drawn_marker.hpp"
#include "workbench/run/recording.hpp"

namespace waymark {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double kSize_m = 0.2;

markers::MarkerOptions marker_options(bool own_thread = true) {
  return {.dictionary = "4x4_50", .size_m = kSize_m, .own_thread = own_thread};
}

markers::MarkerPose at(double x_m, double depth_m) {
  markers::MarkerPose pose;
  pose.p_camera_marker = {x_m, 0.0, depth_m};
  return pose;
}

/// What to draw, and where.
struct Drawn {
  int number;
  markers::MarkerPose pose;
};

MarkerFrontEnd::SharedImage image_of(const std::vector<Drawn>& all) {
  GreyImage image(640, 480, 120);
  for (const Drawn& each : all)
    test::draw_marker(image, Camera(test::marker_camera()), each.pose, kSize_m, each.number);
  return std::make_shared<const GreyImage>(std::move(image));
}

std::span<const Observation> observed(const FrontEnd::Seen& seen) {
  return std::get<std::span<const Observation>>(seen);
}

std::vector<std::int32_t> seen_in(MarkerFrontEnd& front_end, const MarkerFrontEnd::SharedImage& image) {
  front_end.announce(image);
  std::vector<std::int32_t> numbers;
  for (const Observation& each : observed(front_end.see(image))) numbers.push_back(each.id->number);
  return numbers;
}

/// Throws at images that begin dark.
class FearsTheDark final : public markers::MarkerDetector {
 public:
  std::vector<markers::Marker> detect(const ImageView& image) override {
    if (image.data[0] == 0) throw std::runtime_error("too dark");
    return {MarkerOutline{7, {{{1.0, 1.0}, {6.0, 1.0}, {6.0, 6.0}, {1.0, 6.0}}}}};
  }
};

MarkerFinder::SharedImage plain(std::uint8_t grey) { return std::make_shared<const GreyImage>(8, 8, grey); }

TEST(MarkerFinder, ThrowsWhatTheDetectorThrewToWhoeverTakesTheImage) {
  for (const bool own_thread : {true, false}) {
    MarkerFinder finder(std::make_unique<FearsTheDark>(), own_thread);
    const auto light = plain(200), dark = plain(0);
    for (const auto& image : {light, dark}) finder.announce(image);
    EXPECT_EQ(finder.take(light).markers.at(0).id, 7);
    EXPECT_THROW(static_cast<void>(finder.take(dark)), std::runtime_error);
  }
}

TEST(MarkerFinder, DropsAnImageAtWhichTheDetectorThrew) {
  const auto dark = plain(0);
  MarkerFinder finder(std::make_unique<FearsTheDark>(), true);
  finder.announce(dark);
  finder.drop(dark);
  EXPECT_THROW(static_cast<void>(finder.take(dark)), std::runtime_error);
}

TEST(MarkerFinder, ThatCannotStartItsThreadSaysSo) {
  const test::NoMoreThreads none;
  EXPECT_THROW(MarkerFinder(std::make_unique<FearsTheDark>(), true), std::system_error);
}

TEST(MarkerFrontEnd, SeesEveryMarkerOnce) {
  for (const bool own_thread : {true, false}) {
    const auto front_end = *MarkerFrontEnd::make(marker_options(own_thread), Camera(test::marker_camera()));
    EXPECT_THAT(seen_in(*front_end, image_of({{3, at(-0.3, 2.0)}, {7, at(0.3, 1.5)}})), ElementsAre(3, 7));
    EXPECT_THAT(front_end->notes({}), IsEmpty());
    EXPECT_EQ(front_end->blocks()[0].calls, 1);
    EXPECT_GT(front_end->blocks()[0].total.count(), 0);
  }
}

TEST(MarkerFrontEnd, TrustsNeitherOfTwoWithOneNumber) {
  const auto front_end = *MarkerFrontEnd::make(marker_options(), Camera(test::marker_camera()));
  EXPECT_THAT(seen_in(*front_end, image_of({{3, at(-0.4, 2.0)}, {3, at(0.4, 2.0)}, {5, at(0.0, 2.0)}})),
              ElementsAre(5));
  EXPECT_THAT(front_end->notes({}), testing::Contains(HasSubstr("marker 3 appears twice in 1 images")));
}

TEST(MarkerFrontEnd, BelievesAnIdentityWhenItLasts) {
  markers::MarkerOptions options = marker_options();
  options.confirm = 3;
  const auto front_end = *MarkerFrontEnd::make(options, Camera(test::marker_camera()));
  const auto with = image_of({{1, at(0.0, 2.0)}, {2, at(0.4, 2.0)}}), without = image_of({{1, at(0.0, 2.0)}});
  EXPECT_THAT(seen_in(*front_end, with), IsEmpty());
  EXPECT_THAT(seen_in(*front_end, without), IsEmpty());
  EXPECT_THAT(seen_in(*front_end, without), ElementsAre(1));
  for (int i = 0; i < 20; ++i) EXPECT_THAT(seen_in(*front_end, without), ElementsAre(1));
  EXPECT_THAT(seen_in(*front_end, with), ElementsAre(1));  // 2 begins anew
  EXPECT_THAT(front_end->notes({}), ElementsAre(HasSubstr("marker 2 was found in too few images")));
}

TEST(MarkerFrontEnd, ImagesMayBeAnnouncedLongBeforeAndDropped) {
  const auto front_end = *MarkerFrontEnd::make(marker_options(), Camera(test::marker_camera()));
  const auto first = image_of({{1, at(0.0, 2.0)}}), second = image_of({{2, at(0.0, 2.0)}});
  for (const auto& image : {first, second, first}) front_end->announce(image);
  front_end->drop(first);
  EXPECT_EQ(observed(front_end->see(second))[0].id->number, 2);
  EXPECT_EQ(observed(front_end->see(first))[0].id->number, 1);
}

TEST(MarkerFrontEnd, TakesCornersThatOthersFound) {
  const Camera camera(test::marker_camera());
  const auto front_end = *MarkerFrontEnd::make(marker_options(), camera);
  const auto image = image_of({{7, at(0.3, 1.5)}, {3, at(-0.3, 2.0)}});
  front_end->announce(image);
  const auto own = observed(front_end->see(image));
  const std::vector<Observation> seen(own.begin(), own.end());
  MarkerOutlines outlines =
      (*markers::make_marker_detector(markers::marker_set(marker_options())->dictionary))
          ->detect(image->view());
  std::ranges::reverse(outlines);
  const auto told = front_end->see(outlines);
  ASSERT_EQ(told.size(), seen.size());
  for (std::size_t i = 0; i < seen.size(); ++i) {
    EXPECT_EQ(told[i].id, seen[i].id);
    const auto& a = std::get<RangeBearing>(told[i].value);
    const auto& b = std::get<RangeBearing>(seen[i].value);
    const Eigen::Matrix2d S = *told[i].covariance + *seen[i].covariance;
    EXPECT_LT(std::abs(a.range_m - b.range_m), 4.0 * std::sqrt(S(0, 0)));
    EXPECT_LT(std::abs(a.bearing_rad - b.bearing_rad), 4.0 * std::sqrt(S(1, 1)));
    EXPECT_GT((*told[i].covariance)(0, 0), (*seen[i].covariance)(0, 0));
  }
}

TEST(MarkerFrontEnd, RefusesCornersOfMarkersOfUnknownSize) {
  markers::MarkerOptions options = marker_options();
  options.size_m = 0.0;
  options.sizes_m = "3: 0.2";
  const auto front_end = *MarkerFrontEnd::make(options, Camera(test::marker_camera()));
  const MarkerOutline square{5, {{{100.0, 100.0}, {150.0, 100.0}, {150.0, 150.0}, {100.0, 150.0}}}};
  EXPECT_THAT(front_end->see(MarkerOutlines{square}), IsEmpty());
  EXPECT_THAT(front_end->notes({}), testing::Contains(HasSubstr("their size is unknown")));
}

TEST(MarkerFrontEnd, EndsWhileImagesWait) {
  const auto image = image_of({{1, at(0.0, 2.0)}});
  const auto front_end = *MarkerFrontEnd::make(marker_options(), Camera(test::marker_camera()));
  for (int i = 0; i < 20; ++i) front_end->announce(image);
  EXPECT_TRUE(front_end->fits(*image));
  EXPECT_FALSE(front_end->fits(GreyImage(320, 240)));
}

TEST(MarkerFrontEnd, SaysWhatItNeeds) {
  const auto front_end = MarkerFrontEnd::make({}, Camera());
  ASSERT_FALSE(front_end.ok());
  EXPECT_THAT(front_end.error().message, HasSubstr("markers.dictionary"));
}

TEST(MarkerFrontEnd, NoticesJumpsWhereAFifthOfTheObservationsIsRefused) {
  const auto innovation = [](std::int32_t number, Outcome outcome) {
    return Innovation{{LandmarkId::Family::kMarker, number}, outcome, 2, 0.0, 0.0};
  };
  std::vector<Innovation> all;
  for (int i = 0; i < 40; ++i) {
    all.push_back(innovation(1, Outcome::kMatched));
    all.push_back(innovation(2, i % 4 == 0 ? Outcome::kGated : Outcome::kMatched));
    all.push_back(innovation(3, i % 20 == 0 ? Outcome::kGated : Outcome::kMatched));
  }
  const auto front_end = *MarkerFrontEnd::make(marker_options(), Camera(test::marker_camera()));
  const auto lines = front_end->notes(all);
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_THAT(lines[0], HasSubstr("marker 2 was 10 times of 40 outside its gate"));
}

/// The first seconds of a drive through a rendered room.
Result<Recording> drive(const std::vector<std::string>& assignments, double seconds = 4.0,
                        const std::string& scenario = "marker-room", bool own_thread = true) {
  auto opened = open_input("sim:" + scenario, {{}, assignments});
  if (!opened) return opened.error();
  opened->config.markers.own_thread = own_thread;
  return record(*opened->source, opened->config, {0.0, seconds});
}

TEST(MarkerFrontEnd, PutsTheMarkersOfARoomOnTheMap) {
  for (const char* filter : {"ekf", "fastslam"}) {
    const auto recording = drive({std::string("filter=") + filter});
    ASSERT_TRUE(recording.ok());
    EXPECT_EQ(recording->counts.images, 61);
    const auto survey = open_input("sim:marker-room", {})->source->info().landmarks;
    const auto map = recording->filter->snapshot().landmarks;
    EXPECT_GE(map.size(), 2U);
    for (const LandmarkEstimate& each : map) {
      ASSERT_GE(each.id.number, 0);
      ASSERT_LT(each.id.number, 12);
      EXPECT_EQ(each.id.family, LandmarkId::Family::kMarker);
    }
    EXPECT_EQ(survey.size(), 12U);
    EXPECT_GT(survey[0].z_m, 0.0);
  }
}

TEST(MarkerFrontEnd, AThreadOfItsOwnChangesNothing) {
  const auto with = drive({}, 3.0, "marker-room", true), without = drive({}, 3.0, "marker-room", false);
  ASSERT_TRUE(with.ok() && without.ok());
  ASSERT_EQ(with->trajectory.size(), without->trajectory.size());
  for (std::size_t i = 0; i < with->trajectory.size(); ++i) {
    EXPECT_EQ(with->trajectory[i].pose.x_m, without->trajectory[i].pose.x_m);
    EXPECT_EQ(with->trajectory[i].pose.theta_rad, without->trajectory[i].pose.theta_rad);
  }
}

TEST(MarkerFrontEnd, BlocksStandInTheTableOfTheRun) {
  const auto recording = drive({}, 1.0);
  ASSERT_TRUE(recording.ok());
  std::vector<std::string> names;
  for (const auto& row : recording->blocks) names.emplace_back(row.name);
  EXPECT_THAT(names, testing::IsSupersetOf({"find markers", "measure markers", "FB6 estimate"}));
}

TEST(MarkerFrontEnd, ALogWithoutImagesIsAnError) {
  const auto recording =
      drive({"observe=markers", "markers.dictionary=4x4_50", "markers.size_m=0.2"}, 4.0, "study");
  ASSERT_FALSE(recording.ok());
  EXPECT_THAT(recording.error().message, HasSubstr("markers need images"));
}

TEST(MarkerConfig, WhoNamesMarkersWantsThemObserved) {
  const auto opened = open_input("sim:room", {{}, {"markers.dictionary=4x4_50", "markers.size_m=0.1"}});
  ASSERT_TRUE(opened.ok());
  EXPECT_EQ(opened->config.observe, Observe::kMarkers);
  const auto other = open_input("sim:room", {{}, {"markers.size_m=0.1", "observe=pixel"}});
  ASSERT_TRUE(other.ok());
  EXPECT_EQ(other->config.observe, Observe::kPixel);
}

TEST(MarkerConfig, TheCameraIsTheLandmarkSensor) {
  const auto opened = open_input("sim:marker-room", {{}, {"sim.camera_x_m=0.2", "sim.camera_yaw_deg=15"}});
  ASSERT_TRUE(opened.ok());
  EXPECT_EQ(opened->config.observe, Observe::kMarkers);
  EXPECT_EQ(opened->config.sensor.x_m, 0.2);
  EXPECT_EQ(opened->config.sensor.yaw_deg, 15.0);
}

TEST(MarkerConfig, WithoutDictionaryNothingRuns) {
  const auto recording = drive({"observe=markers"}, 1.0, "room");
  ASSERT_FALSE(recording.ok());
  EXPECT_THAT(recording.error().message, HasSubstr("markers.dictionary is not set"));
}

}  // namespace
}  // namespace waymark
