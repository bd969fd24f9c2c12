#include "waymark/slam/pipeline.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "support/stamps.hpp"
#include "waymark/core/function_blocks.hpp"

namespace waymark {
namespace {

using test::at;

/// Notes what the pipeline asks of a filter.
class Recorder final : public Filter {
 public:
  void predict(const Motion& motion) override { pose_ = propagate(pose_, motion); }
  const Correction& correct(std::span<const Observation> observations) override {
    batches.emplace_back(observations.begin(), observations.end());
    poses.push_back(pose_.T_world_robot);
    return correction_;
  }
  [[nodiscard]] PoseEstimate pose() const override { return pose_; }
  [[nodiscard]] Snapshot snapshot() const override { return {}; }
  [[nodiscard]] MapState save() const override { return {}; }
  [[nodiscard]] const FunctionBlocks& blocks() const override { return blocks_; }

  std::vector<std::vector<Observation>> batches;
  std::vector<Pose2> poses;  ///< where each batch was seen from

 private:
  PoseEstimate pose_;
  Correction correction_;
  FunctionBlocks blocks_{};
};

struct Fixture {
  explicit Fixture(PipelineOptions options = {}, LandmarkSensor sensor = {},
                   Observe observe = Observe::kRangeBearing, OdometryOptions odometry = {})
      : pipeline(filter, options, odometry, sensor, observe,
                 [this](const Step& step) { stamps.push_back(step.stamp); }) {}

  void push(std::vector<Event> events) {
    for (auto& event : events) pipeline.push(std::move(event));
    pipeline.finish();
  }

  Recorder filter;
  std::vector<Stamp> stamps;
  Pipeline pipeline;
};

Observation landmark_observation(int number, Measurement value = RangeBearing{2.0, 0.5}) {
  return {LandmarkId{LandmarkId::Family::kMarker, number}, value, std::nullopt};
}

Event seen(double seconds, std::vector<Observation> observations) {
  return {at(seconds), Observations(std::move(observations))};
}
Event speed(double seconds, double v_mps) { return {at(seconds), Velocity{v_mps, 0.0}}; }

TEST(Pipeline, PutsLateEventsInTheirPlace) {
  Fixture f;
  f.push({speed(0.0, 1.0), speed(1.0, 0.0), seen(0.6, {landmark_observation(1)}), speed(2.0, 0.0)});
  ASSERT_EQ(f.filter.poses.size(), 1U);
  EXPECT_NEAR(f.filter.poses[0].x_m, 0.6, 1e-9);
  EXPECT_TRUE(std::ranges::is_sorted(f.stamps));
}

TEST(Pipeline, DropsAndCountsWhatComesTooLate) {
  Fixture f({.reorder_window_s = 0.2});
  f.push({speed(0.0, 1.0), speed(1.0, 0.0), speed(2.0, 0.0), seen(0.5, {landmark_observation(1)})});
  EXPECT_TRUE(f.filter.batches.empty());
  EXPECT_EQ(f.pipeline.counts().late, 1);
}

TEST(Pipeline, TimesTheStepsInWhichSomethingWasObserved) {
  Recorder filter;
  std::vector<Duration> corrected, others;
  Pipeline pipeline(filter, {}, {}, {}, Observe::kRangeBearing, [&](const Step& step) {
    (step.correction != nullptr ? corrected : others).push_back(step.cpu);
  });
  for (Event& event :
       std::vector<Event>{speed(0.0, 1.0), seen(0.5, {landmark_observation(1)}), speed(1.0, 1.0)})
    pipeline.push(std::move(event));
  pipeline.finish();
  ASSERT_EQ(corrected.size(), 1U);
  EXPECT_GT(corrected[0], Duration{0});
  EXPECT_EQ(others, std::vector<Duration>(2, Duration{0}));
}

TEST(Pipeline, TreatsObservationsOfOneStampAsOneBatch) {
  Fixture f;
  f.push({speed(0.0, 1.0), seen(0.5, {landmark_observation(1)}),
          seen(0.5, {landmark_observation(2), landmark_observation(3)}), speed(1.0, 1.0)});
  ASSERT_EQ(f.filter.batches.size(), 1U);
  EXPECT_EQ(f.filter.batches[0].size(), 3U);
}

TEST(Pipeline, MovesToTheMomentOfTheObservationNotOfItsStamp) {
  LandmarkSensor sensor;
  sensor.delay_s = 0.2;
  Fixture f({}, sensor);
  f.push({speed(0.0, 1.0), seen(0.5, {landmark_observation(1)}), speed(1.0, 1.0)});
  EXPECT_NEAR(f.filter.poses.at(0).x_m, 0.3, 1e-9);
}

TEST(Pipeline, MovesWhenTheRobotFollowsItsCommand) {
  OdometryOptions odometry;
  odometry.response_s = 0.2;
  Fixture f({}, {}, Observe::kRangeBearing, odometry);
  f.push({speed(0.0, 1.0), seen(0.5, {landmark_observation(1)}), speed(1.0, 1.0)});
  EXPECT_NEAR(f.filter.poses.at(0).x_m, 0.3, 1e-9);
}

TEST(Pipeline, GivesTheSensorsNoiseToObservationsThatBringNone) {
  LandmarkSensor sensor;
  sensor.range_sigma_m = 0.1;
  sensor.range_sigma_ratio = 0.05;
  sensor.bearing_sigma_deg = 2.0;
  Fixture f({}, sensor);
  Observation own = landmark_observation(2);
  own.covariance = Eigen::Matrix2d::Identity();
  f.push({seen(0.0, {landmark_observation(1), own})});
  const auto& batch = f.filter.batches.at(0);
  EXPECT_NEAR((*batch[0].covariance)(0, 0), 0.2 * 0.2, 1e-12);
  EXPECT_NEAR((*batch[0].covariance)(1, 1), to_radians(2.0) * to_radians(2.0), 1e-12);
  EXPECT_EQ(*batch[1].covariance, Eigen::Matrix2d::Identity());
}

TEST(Pipeline, LeavesPixelsAsTheyCome) {
  Fixture f({}, {}, Observe::kPixel);
  Observation own = landmark_observation(2, Pixel{3.0, 4.0});
  own.covariance = Eigen::Matrix2d{{1.0, 0.5}, {0.5, 4.0}};
  f.push({seen(0.0, {landmark_observation(1, Pixel{1.0, 2.0}), own,
                     landmark_observation(3, Pixel{std::nan(""), 1.0}), landmark_observation(4)})});
  const auto& batch = f.filter.batches.at(0);
  ASSERT_EQ(batch.size(), 2U);
  EXPECT_FALSE(batch[0].covariance.has_value());
  EXPECT_EQ(*batch[1].covariance, *own.covariance);
  EXPECT_EQ(f.pipeline.counts().unusable, 1);
  EXPECT_EQ(f.pipeline.counts().wrong_kind, 1);
}

TEST(Pipeline, UsesThePartThatIsAskedFor) {
  Fixture f({}, {}, Observe::kBearing);
  Observation own = landmark_observation(2);
  own.covariance = Eigen::Matrix2d{{1.0, 0.5}, {0.5, 4.0}};
  f.push({seen(0.0, {own, landmark_observation(1, Range{3.0})})});
  ASSERT_EQ(f.filter.batches.at(0).size(), 1U);
  const auto& used = f.filter.batches[0][0];
  EXPECT_EQ(std::get<Bearing>(used.value).bearing_rad, 0.5);
  EXPECT_EQ(*used.covariance, (Eigen::Matrix2d{{4.0, 0.0}, {0.0, 0.0}}));
  EXPECT_EQ(f.pipeline.counts().wrong_kind, 1);
}

TEST(Pipeline, HandsOnDistancesInsteadOfRanges) {
  LandmarkSensor sensor;
  sensor.range_scale = 1.1;
  sensor.range_offset_m = 0.5;
  Fixture f({}, sensor, Observe::kRange);
  f.push({speed(0.0, 1.0), seen(0.5, {landmark_observation(1, Range{1.1 * 4.0 + 0.5})})});
  ASSERT_EQ(f.filter.batches.size(), 1U);
  EXPECT_NEAR(std::get<Range>(f.filter.batches[0][0].value).range_m, 4.0, 1e-12);
}

TEST(Pipeline, DropsAndCountsWhatTheSensorCannotHaveSeen) {
  LandmarkSensor sensor;
  sensor.max_range_m = 5.0;
  Fixture f({}, sensor);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  f.push({seen(
      0.0, {landmark_observation(1, RangeBearing{6.0, 0.0}), landmark_observation(1, RangeBearing{-1.0, 0.0}),
            landmark_observation(1, RangeBearing{nan, 0.0}), landmark_observation(1, RangeBearing{1.0, nan}),
            landmark_observation(1)})});
  EXPECT_EQ(f.filter.batches.at(0).size(), 1U);
  EXPECT_EQ(f.pipeline.counts().unusable, 4);
}

TEST(Pipeline, CarriesOnOverAGapInTheOdometry) {
  Fixture f({.max_hold_s = 1.0});
  f.push({speed(0.0, 1.0), speed(30.0, 1.0), seen(31.0, {landmark_observation(1)})});
  EXPECT_NEAR(f.filter.poses.at(0).x_m, 2.0, 1e-9);
  const std::vector<OdometryGap> gaps{{at(0.0), at(30.0)}};
  EXPECT_EQ(f.pipeline.counts().odometry_gaps, gaps);
}

Event pose(double seconds, double x_m) { return {at(seconds), OdometryPose{{x_m, 0.0, 0.0}}}; }

TEST(Pipeline, WaitsForTheOdometryBehindAnObservationHoweverFarItIs) {
  Fixture f({.max_hold_s = 60.0});
  f.push({pose(0.0, 0.0), seen(0.5, {landmark_observation(1)}), seen(9.0, {landmark_observation(1)}),
          pose(10.0, 4.0), seen(10.5, {landmark_observation(1)})});
  ASSERT_EQ(f.filter.poses.size(), 3U);
  EXPECT_NEAR(f.filter.poses[0].x_m, 0.2, 1e-9);
  EXPECT_NEAR(f.filter.poses[1].x_m, 3.6, 1e-9);
}

double variance_at_the_end(std::vector<Event> events) {
  Fixture f({.max_hold_s = 2.0});
  f.push(std::move(events));
  return f.filter.pose().covariance(0, 0);
}

TEST(Pipeline, IsNotSureWhereTheRobotIsWhenItsOdometryBeginsLateOrEndsEarly) {
  const auto observation = [](double seconds) { return seen(seconds, {landmark_observation(1)}); };
  EXPECT_EQ(variance_at_the_end({observation(0.0), pose(1.0, 0.0), pose(2.0, 0.0), observation(2.5)}), 0.0);
  EXPECT_GT(variance_at_the_end({observation(0.0), pose(9.0, 0.0)}), 1.0);
  EXPECT_GT(variance_at_the_end({pose(0.0, 0.0), pose(1.0, 0.0), observation(9.0)}), 1.0);
}

constexpr StreamId kWheelDevice{0, 1};
constexpr StreamId kCameraDevice{0, 2};

Event of(StreamId stream, Event event) {
  event.stream = stream;
  return event;
}

TEST(Pipeline, ProcessesLiveEventsAsSoonAsEveryStreamHasToldOfThem) {
  LandmarkSensor sensor;
  sensor.delay_s = 0.2;
  Fixture f({}, sensor);
  Pipeline& pipeline = f.pipeline;
  pipeline.horizon().expect(kCameraDevice, Duration{0});
  pipeline.hold(of(kWheelDevice, speed(0.0, 1.0)));
  EXPECT_EQ(pipeline.horizon().stamp(), std::nullopt);
  pipeline.hold(of(kWheelDevice, speed(1.0, 0.0)));
  pipeline.hold(of(kCameraDevice, seen(0.8, {landmark_observation(1)})));
  pipeline.process_until(pipeline.horizon().stamp().value());
  ASSERT_EQ(f.filter.poses.size(), 1U);
  EXPECT_NEAR(f.filter.poses[0].x_m, 0.6, 1e-9);
  EXPECT_EQ(f.stamps, (std::vector<Stamp>{at(0.0), at(0.6)}));
}

TEST(Pipeline, HeldEventsThatComeAfterTheirMomentAreLate) {
  Fixture f;
  f.pipeline.hold(speed(0.0, 1.0));
  f.pipeline.hold(speed(1.0, 1.0));
  f.pipeline.process_until(at(1.0));
  f.pipeline.hold(seen(0.5, {landmark_observation(1)}));
  f.pipeline.finish();
  EXPECT_TRUE(f.filter.batches.empty());
  EXPECT_EQ(f.pipeline.counts().late, 1);
}

TEST(Pipeline, FollowsOneRobotAndCountsTheEventsOfOthers) {
  Fixture f;
  f.push({of({3, 0}, speed(0.0, 1.0)), of({4, 0}, speed(0.1, 9.0)),
          of({3, 0}, seen(0.5, {landmark_observation(1)})), of({3, 0}, speed(1.0, 1.0))});
  EXPECT_NEAR(f.filter.poses.at(0).x_m, 0.5, 1e-9);
  EXPECT_EQ(f.pipeline.counts().other_robots, 1);
}

TEST(Pipeline, ARobotThatIsSeenIsNoLandmark) {
  Fixture f;
  Observation robot = landmark_observation(2);
  robot.id->family = LandmarkId::Family::kRobot;
  f.push({seen(0.0, {landmark_observation(1), robot})});
  EXPECT_EQ(f.filter.batches.at(0).size(), 1U);
  EXPECT_EQ(f.pipeline.counts().robots_seen, 1);
}

/// Three seconds in which odometry and gyro turn alike, after which the gyro is trusted, and one in which
/// they tell these rates; something is seen at the end.
std::vector<Event> turns(double odometry_radps, double gyro_radps) {
  std::vector<Event> events;
  for (int i = 0; i <= 40; ++i) {
    const double t_s = 0.1 * i;
    events.emplace_back(at(t_s), Velocity{1.0, i < 30 ? 0.5 : odometry_radps});
    const double noise_radps = i % 2 == 0 ? 1e-4 : -1e-4;  // without any it would be stuck
    events.emplace_back(at(t_s), YawRate{(i < 30 ? 0.5 : gyro_radps) + noise_radps});
  }
  events.push_back(seen(4.0, {landmark_observation(1)}));
  return events;
}

TEST(Pipeline, TurnsByAGyroFromReadingToReading) {
  Fixture f;
  f.push(turns(0.4, 0.2));
  EXPECT_NEAR(f.filter.poses.at(0).theta_rad, 1.7, 0.03);
}

TEST(Pipeline, TheResponseToCommandsMovesNoGyro) {
  OdometryOptions odometry;
  odometry.response_s = 0.4;
  Fixture f({}, {}, Observe::kRangeBearing, odometry);
  f.push(turns(0.1, 0.1));
  EXPECT_NEAR(f.filter.poses.at(0).theta_rad, 1.4, 0.05);  // 1.56 by the odometry
}

TEST(Pipeline, ReportsOneStepPerStamp) {
  Fixture f;
  f.push({speed(0.0, 1.0),
          speed(0.5, 1.0),
          seen(0.5, {landmark_observation(1)}),
          {at(0.7), Truth{}},
          {at(0.8), Image{}},
          speed(1.0, 0.0)});
  EXPECT_EQ(f.stamps, (std::vector<Stamp>{at(0.0), at(0.5), at(1.0)}));
}

}  // namespace
}  // namespace waymark
