#include "workbench/run/recording.hpp"

#include <algorithm>
#include <filesystem>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "waymark/core/angle.hpp"
#include "waymark/core/sensor_bias.hpp"

#include "slam/images.hpp"
#include "workbench/logs/event_list.hpp"
#include "workbench/logs/map_files.hpp"
#include "workbench/run/make_filter.hpp"

namespace waymark {
namespace {

Result<Recording> record_study(std::vector<std::string> settings, const TimeSpan& span = {},
                               const std::function<bool(double)>& keep_going = {}) {
  auto opened = open_input("sim:study", {{}, std::move(settings)});
  if (!opened) return opened.error();
  return record(*opened->source, opened->config, span, keep_going);
}

class BothFilters : public testing::TestWithParam<std::string> {};

TEST_P(BothFilters, GiveTheSameBitsForOneAndTwoThreads) {
  const std::vector<std::string> settings{"filter=" + GetParam(), "sim.laps=1", "fastslam.particles=600"};
  auto two_threads = settings;
  two_threads.emplace_back("threads=2");
  const auto one = record_study(settings);
  const auto two = record_study(two_threads);
  ASSERT_TRUE(one.ok() && two.ok());
  ASSERT_EQ(one->trajectory.size(), two->trajectory.size());
  for (std::size_t i = 0; i < one->trajectory.size(); ++i) {
    ASSERT_EQ(one->trajectory[i].pose, two->trajectory[i].pose);
    ASSERT_EQ(one->trajectory[i].covariance, two->trajectory[i].covariance);
  }
}

/// How far from the truth the robot believes to be at the end.
double final_miss_m(const Recording& run, const Trajectory& estimate) {
  const Truth& start = run.truth.front().second;
  const Truth& end = run.truth.back().second;
  const Pose2 T_world_start{start.x_m, start.y_m, *start.theta_rad};
  return ((T_world_start * estimate.back().pose).position() - Eigen::Vector2d(end.x_m, end.y_m)).norm();
}

TEST_P(BothFilters, FollowTheStudyBetterThanTheWheelsAlone) {
  double filter_m = 0.0;
  double wheels_m = 0.0;
  for (int seed = 1; seed <= 8; ++seed) {
    const auto run = record_study({"filter=" + GetParam(), "seed=" + std::to_string(seed)});
    ASSERT_TRUE(run.ok());
    EXPECT_FALSE(run->error.has_value());
    EXPECT_GT(run->innovations.size(), 1000U);
    filter_m += final_miss_m(*run, run->trajectory);
    wheels_m += final_miss_m(*run, run->dead_reckoning);
  }
  EXPECT_LT(filter_m, 0.5 * wheels_m);
}

TEST_P(BothFilters, SayWhenTheRobotWasLostAndFound) {
  const auto run = record_study({"filter=" + GetParam(), "sim.laps=4", "sim.robot_carried_at_s=70",
                                 "sim.robot_carried_m=2", "sim.robot_carried_deg=90"});
  ASSERT_TRUE(run.ok());
  const auto& lost = run->losses.lost();
  ASSERT_FALSE(lost.empty());
  const Stamp start = run->trajectory.front().stamp;
  EXPECT_GT(to_seconds(lost[0].from - start), 70.0);
  ASSERT_TRUE(lost[0].found.has_value());
  EXPECT_LT(to_seconds(*lost[0].found - start), 100.0);
  EXPECT_TRUE(std::ranges::any_of(run->notes, [](const std::string& line) {
    return line.find("the robot was lost from") != std::string::npos;
  }));
}

INSTANTIATE_TEST_SUITE_P(Filters, BothFilters, testing::Values("ekf", "fastslam"));

TEST(Recording, KeepsWhatWasDoneWhenStopped) {
  const auto run = record_study({}, {}, [](double fraction) { return fraction < 0.3; });
  ASSERT_TRUE(run.ok());
  ASSERT_TRUE(run->error.has_value());
  EXPECT_EQ(run->error->kind, Error::Kind::kFailed);
  EXPECT_GT(run->trajectory.size(), 100U);
}

TEST(Recording, UsesThePartOfTheLogThatIsAskedFor) {
  const auto run = record_study({}, {.from_s = 10.0, .to_s = 20.0});
  ASSERT_TRUE(run.ok());
  EXPECT_NEAR(to_seconds(run->trajectory.front().stamp), 10.0, 0.1);
  EXPECT_NEAR(to_seconds(run->trajectory.back().stamp), 20.0, 0.1);
}

TEST(Recording, RefusesASpanThatIsNotInTheLog) {
  const auto beyond = record_study({"sim.laps=1"}, {.from_s = 1000.0});
  ASSERT_FALSE(beyond.ok());
  EXPECT_TRUE(beyond.error().message.starts_with("--from 1000: the log is ")) << beyond.error().message;
  const auto backwards = record_study({}, {.from_s = 20.0, .to_s = 10.0});
  ASSERT_FALSE(backwards.ok());
  EXPECT_EQ(backwards.error().message, "--to 10 is not after --from 20");
}

TEST(Recording, WheelsOfUnknownSizeGiveNoResultAndNameTheKey) {
  const auto run = record_study({"wheels.track_m=0"});
  ASSERT_FALSE(run.ok());
  EXPECT_NE(run.error().message.find("wheels.track_m"), std::string::npos);
}

TEST(Recording, CountsObservationsThatWaitForOthers) {
  const auto run = record_study({"observe=bearing"}, {.to_s = 20.0});
  ASSERT_TRUE(run.ok());
  const std::string words =
      std::string("observations not used by the filter: ") + describe(Outcome::kDeferred);
  EXPECT_TRUE(
      std::ranges::any_of(run->notes, [&](const std::string& note) { return note.ends_with(words); }));
}

TEST(MakeFilter, RefusesAnAssociationThatDoesNotFit) {
  const auto ekf = record_study({"associate=ml"});
  ASSERT_FALSE(ekf.ok());
  EXPECT_NE(ekf.error().message.find("filter=fastslam"), std::string::npos) << ekf.error().message;
  const auto range = record_study({"associate=ml", "filter=fastslam", "observe=range"});
  ASSERT_FALSE(range.ok());
  EXPECT_NE(range.error().message.find("associate=known"), std::string::npos) << range.error().message;
  for (const std::string associate : {"nearest", "jcbb"}) {
    const auto fastslam = record_study({"associate=" + associate, "filter=fastslam"});
    ASSERT_FALSE(fastslam.ok());
    EXPECT_NE(fastslam.error().message.find("filter=ekf"), std::string::npos) << fastslam.error().message;
    const auto pixels = record_study({"associate=" + associate, "observe=pixel"});
    ASSERT_FALSE(pixels.ok());
    EXPECT_NE(pixels.error().message.find("associate=known"), std::string::npos) << pixels.error().message;
  }
}

TEST(MakeFilter, SaysThatParticlesTakeNoPixels) {
  const auto run = record_study({"observe=pixel", "filter=fastslam"});
  ASSERT_FALSE(run.ok());
  EXPECT_NE(run.error().message.find("filter=ekf"), std::string::npos) << run.error().message;
}

Result<Recording> record_room(std::vector<std::string> settings, const TimeSpan& span = {}) {
  auto opened = open_input("sim:room", {{}, std::move(settings)});
  if (!opened) return opened.error();
  return record(*opened->source, opened->config, span);
}

TEST(Recording, ImagesGiveTheSameBitsForOneAndTwoThreads) {
  const auto one = record_room({}, {.to_s = 4.0});
  const auto two = record_room({"threads=2"}, {.to_s = 4.0});
  ASSERT_TRUE(one.ok() && two.ok());
  ASSERT_EQ(one->trajectory.size(), two->trajectory.size());
  for (std::size_t i = 0; i < one->trajectory.size(); ++i)
    ASSERT_EQ(one->trajectory[i].pose, two->trajectory[i].pose);
  EXPECT_EQ(one->image_strip.frames().size(), two->image_strip.frames().size());
}

/// Observations used at stamps from..to, s.
std::int64_t matches_between(const Recording& run, double from_s, double to_s) {
  return std::ranges::count_if(run.innovations, [&](const auto& each) {
    const double t_s = to_seconds(each.stamp - Stamp{});
    return each.innovation.outcome == Outcome::kMatched && t_s >= from_s && t_s <= to_s;
  });
}

const TrajectoryPoint& point_at(const Recording& run, double t_s) {
  return *std::ranges::find_if(
      run.trajectory, [t_s](const TrajectoryPoint& point) { return point.stamp >= stamp_from_seconds(t_s); });
}

TEST(Recording, UnderACoverTheRobotGoesOnByDeadReckoningAndLooksAgainAfterwards) {
  const auto run = record_room({"sim.lens_covered_from_s=4", "sim.lens_covered_for_s=10"}, {.to_s = 16.0});
  ASSERT_TRUE(run.ok());
  EXPECT_GT(matches_between(*run, 3.0, 4.0), 0);
  EXPECT_EQ(matches_between(*run, 4.1, 13.9), 0);
  EXPECT_GT(matches_between(*run, 14.1, 16.0), 0);
  const auto variance = [&run](double t_s) { return point_at(*run, t_s).covariance->trace(); };
  for (double t_s = 4.5; t_s < 13.0; t_s += 1.0) EXPECT_GT(variance(t_s + 1.0), variance(t_s)) << t_s;
  const double moved_m = (point_at(*run, 13.0).pose.position() - point_at(*run, 5.0).pose.position()).norm();
  EXPECT_GT(moved_m, 2.0);
}

TEST(Recording, ACamerasMapIsGoneOnFrom) {
  const auto path = std::filesystem::path(testing::TempDir()) / "cameras_map.waymark";
  const std::vector<std::string> settings{"sim.laps=1"};
  const auto opened = [&](std::vector<std::string> more) {
    more.insert(more.end(), settings.begin(), settings.end());
    return open_input("sim:room", {{}, std::move(more)});
  };
  constexpr double kMiddle_s = 6.0, kEnd_s = 9.0;
  auto first = opened({});
  const auto before = record(*first->source, first->config, {0.0, kMiddle_s});
  ASSERT_TRUE(before.ok());
  const MapState map = save_map(*before);
  ASSERT_GT(map.ids.size(), 10U);
  EXPECT_EQ(map.patches.size(), map.ids.size());
  ASSERT_TRUE(write_map(path, map).ok());
  auto second = opened({"map.file=" + path.string()});
  const auto after = record(*second->source, second->config, {kMiddle_s, kEnd_s});
  ASSERT_TRUE(after.ok());
  const auto whole_source = opened({});
  const auto whole = record(*whole_source->source, whole_source->config, {0.0, kEnd_s});
  ASSERT_TRUE(whole.ok());
  const auto matched_at_once = std::ranges::count_if(after->innovations, [&](const auto& each) {
    return each.innovation.outcome == Outcome::kMatched &&
           to_seconds(each.stamp - after->innovations.front().stamp) < 0.2;
  });
  EXPECT_GT(matched_at_once, 20);
  const Pose2 here = after->trajectory.back().pose, there = whole->trajectory.back().pose;
  EXPECT_LT((here.position() - there.position()).norm(), 0.05);
}

TEST(Recording, LostImagesAreBridged) {
  const auto run = record_room({"sim.image_drop_probability=0.5"}, {.to_s = 6.0});
  ASSERT_TRUE(run.ok());
  EXPECT_FALSE(run->error.has_value());
  EXPECT_LT(run->counts.images, 130);
  EXPECT_GT(matches_between(*run, 5.0, 6.0), 0);
}

TEST(Recording, PixelsThatALogDoesNotHaveGiveNoResult) {
  const auto run = record_study({"observe=pixel"});
  ASSERT_FALSE(run.ok());
  EXPECT_NE(run.error().message.find("observe"), std::string::npos);
}

/// A log of a robot that stands, and one event by a camera that nobody knows, or else is set.
std::optional<Error> error_of(EventContent content, const std::vector<std::string>& settings) {
  Config config;
  config.observe = Observe::kPixel;
  Schema schema = describe(config);
  for (const std::string& setting : settings) EXPECT_TRUE(schema.set_assignment(setting, "test").ok());
  config.camera_known = schema.was_set("camera.fu_px");
  EventList log({.name = "log", .format = "made"},
                {{Stamp{}, Velocity{}}, {stamp_from_seconds(1.0), std::move(content)}});
  auto run = record(log, config);
  return run ? run->error : run.error();
}

TEST(Recording, ImagesAndPixelsOfACameraThatNobodyKnowsGiveNoResultAndSayWhatToDo) {
  const Observations pixels{{LandmarkId{LandmarkId::Family::kMarker, 1}, Pixel{100.0, 100.0}, std::nullopt}};
  for (const EventContent& content :
       {EventContent(test::taken(0.0, test::noise_image(1)).content), EventContent(pixels)}) {
    const auto error = error_of(content, {});
    ASSERT_TRUE(error.has_value());
    EXPECT_NE(error->message.find("camera.yaml, or set camera.width_px"), std::string::npos)
        << error->message;
    EXPECT_EQ(error->kind, Error::Kind::kBadInput);
    EXPECT_FALSE(error_of(content, {"camera.fu_px=277"}).has_value());
  }
}

/// A log of one landmark ahead of a robot that stands for 20 s. The landmark is carried after 10 s.
Result<Recording> record_standing(const std::vector<Event>& more) {
  std::vector<Event> events = more;
  for (int i = 0; i < 100; ++i)
    events.emplace_back(
        stamp_from_seconds(0.2 * i),
        Observations{
            {LandmarkId{LandmarkId::Family::kMarker, 4}, RangeBearing{2.0, 0.0}, {}},
            {LandmarkId{LandmarkId::Family::kMarker, 5}, RangeBearing{3.0, 1.0}, {}},
            {LandmarkId{LandmarkId::Family::kMarker, 3}, RangeBearing{2.0, i < 50 ? 0.5 : 2.5}, {}}});
  EventList log({.name = "log", .format = "made"}, std::move(events));
  return record(log, {});
}

TEST(Recording, ALogWithoutOdometryEndsAsCheckSays) {
  const auto run = record_standing({});
  ASSERT_FALSE(run.ok());
  EXPECT_TRUE(run.error().message.starts_with("nothing can be run: there is no odometry"));
  EXPECT_EQ(run.error().kind, Error::Kind::kBadInput);
}

TEST(Recording, NamesALandmarkThatWasCarried) {
  const auto run = record_standing({{Stamp{}, Velocity{}}});
  ASSERT_TRUE(run.ok() && !run->error);
  EXPECT_TRUE(
      std::ranges::any_of(run->notes, [](const auto& note) { return note.starts_with("landmark 3: "); }));
  EXPECT_FALSE(
      std::ranges::any_of(run->notes, [](const auto& note) { return note.starts_with("landmark 4: "); }));
}

TEST(Recording, SaysWhenTheOdometryJumps) {
  std::vector<Event> velocities;
  for (int i = 0; i < 200; ++i)
    velocities.emplace_back(stamp_from_seconds(0.1 * i), Velocity{i == 70 ? 50.0 : 0.0, 0.0});
  const auto run = record_standing(velocities);
  ASSERT_TRUE(run.ok() && !run->error);
  EXPECT_LT(run->dead_reckoning.back().pose.position().norm(), 1e-9);
  EXPECT_TRUE(std::ranges::any_of(
      run->notes, [](const auto& note) { return note.find("once, at 7.00 s") != std::string::npos; }));
}

/// Events as they are given, also out of order.
class Given final : public Source {
 public:
  Given(LogInfo info, std::vector<Event> events) : info_(std::move(info)), events_(std::move(events)) {}
  [[nodiscard]] const LogInfo& info() const override { return info_; }
  [[nodiscard]] Result<std::optional<Event>> next() override {
    return next_ < events_.size() ? std::optional(events_[next_++]) : std::nullopt;
  }

 private:
  LogInfo info_;
  std::vector<Event> events_;
  std::size_t next_ = 0;
};

std::shared_ptr<const GreyImage> saturated(GreyImage image) {
  for (int i = 0; i < image.width_px() * image.height_px(); ++i)
    image.data()[i] = image.data()[i] > 20 ? 255 : 0;
  return std::make_shared<const GreyImage>(std::move(image));
}

/// What becomes of image `number` of a camera that fails in every way, seven times of ten.
void damage(int number, Event event, std::vector<Event>& events) {
  auto& pixels = std::get<Image>(event.content).pixels;
  const int kind = number > 60 && number <= 180 ? number % 10 : 0;
  if (kind == 1) pixels = test::plain_image(0);
  if (kind == 2) pixels = test::plain_image(255);
  if (kind == 3) pixels = saturated(*pixels);
  if (kind == 4) pixels = test::noise_image(1, 640, 480);
  if (kind == 5) pixels = nullptr;
  if (kind == 6) events.push_back(event);
  if (kind == 7) event.stamp = event.stamp - duration_from_seconds(2.0);
  if (kind != 8) events.push_back(std::move(event));
}

std::vector<Event> damaged_room(Source& room) {
  std::vector<Event> events;
  int images = 0;
  for (auto event = room.next(); event && *event && (*event)->stamp <= stamp_from_seconds(6.5);
       event = room.next()) {
    if (std::holds_alternative<Image>((*event)->content))
      damage(++images, std::move(**event), events);
    else
      events.push_back(std::move(**event));
  }
  return events;
}

TEST(Recording, DamagedImagesOfEveryKindAreSkippedAndNamed) {
  auto opened = open_input("sim:room", {});
  ASSERT_TRUE(opened.ok());
  Given log(opened->source->info(), damaged_room(*opened->source));
  const auto run = record(log, opened->config);
  ASSERT_TRUE(run.ok());
  EXPECT_FALSE(run->error.has_value());
  EXPECT_EQ(run->tracker.unusable, 36);
  EXPECT_EQ(run->counts.misfits, 24);
  EXPECT_EQ(run->counts.repeats, 12);
  EXPECT_EQ(run->counts.late, 12);
  EXPECT_GT(matches_between(*run, 6.0, 6.5), 0);
  EXPECT_TRUE(run->filter->pose().covariance.allFinite());
}

TEST(MakeFilter, RefusesAModeThatTheFilterDoesNotHave) {
  const auto run = record_study({"associate=ml"});
  ASSERT_FALSE(run.ok());
  EXPECT_NE(run.error().message.find("associate"), std::string::npos);
  for (const std::string filter : {"ekf", "fastslam"}) {
    const auto article = record_study({"pixel.article=true", "filter=" + filter});
    ASSERT_FALSE(article.ok()) << filter;
    EXPECT_NE(article.error().message.find("pixel.article"), std::string::npos) << article.error().message;
  }
}

Recording record_start(const std::string& input, std::vector<std::string> settings, double to_s) {
  auto opened = open_input(input, {{}, std::move(settings)}).value();
  return record(*opened.source, opened.config, {0.0, to_s}).value();
}

TEST(MakeFilter, TakesThePriorOfTheOdometryFromTheKeysOfTheSmoother) {
  const auto run = record_start("sim:study",
                                {"ekf.calibrate_odometry=true", "motion.speed_scale_sigma=0.01",
                                 "motion.turn_scale_sigma=0.02", "motion.turn_bias_sigma_degps=0.3"},
                                0.5);
  const auto prior = run.filter->calibration().value().prior_sigmas;
  EXPECT_EQ(prior[kSpeedScale], 0.01);
  EXPECT_EQ(prior[kTurnScale], 0.02);
  EXPECT_EQ(prior[kTurnBias], to_radians(0.3));
}

TEST(MakeFilter, GivesFilterAndFrontEndTheSameNumberOfCandidates) {
  // Too few images for any candidate to become a landmark.
  const auto candidates = [](const std::string& most) {
    return record_start("sim:room", {"pixel.max_candidates=" + most}, 0.2).patches.size();
  };
  EXPECT_EQ(candidates("1"), 1U);
  EXPECT_GT(candidates("16"), 8U);
}

TEST(MakeFilter, LetsTheCameraShakePixelsAsItShakesMarkers) {
  const auto covariance = [](const std::string& jitter_deg) {
    return record_start("sim:room", {"camera.jitter_deg=" + jitter_deg}, 1.0).filter->pose().covariance;
  };
  EXPECT_LT(covariance("0.05").determinant(), covariance("1").determinant());
}

TEST(Recording, HasTheBlocksOfFilterAndFrontEndInOneTable) {
  auto opened = open_input("sim:room", {});
  ASSERT_TRUE(opened.ok());
  const auto recording = record(*opened->source, opened->config, {0.0, 0.5});
  ASSERT_TRUE(recording.ok());
  const auto& blocks = recording->blocks;
  ASSERT_EQ(blocks.size(), 9U);
  for (std::size_t i = 0; i < blocks.size(); ++i)
    EXPECT_TRUE(blocks[i].name.starts_with("FB" + std::to_string(i + 1) + " ")) << blocks[i].name;
  EXPECT_GT(blocks[1].calls, 0);
}

}  // namespace
}  // namespace waymark
