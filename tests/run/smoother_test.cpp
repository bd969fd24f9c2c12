#include "workbench/run/smoother.hpp"

#include <cmath>

#include <gmock/gmock.h>

#include "workbench/run/config.hpp"

namespace waymark::smooth {
namespace {

using testing::HasSubstr;

struct LiveRun {
  Config config;
  Recording recording;
};

LiveRun drive(std::vector<std::string> assignments) {
  assignments.insert(assignments.end(), {"sim.laps=1", "smooth.run=true"});
  auto input = open_input("sim:study", {{}, assignments});
  EXPECT_TRUE(input.ok()) << input.error().message;
  auto recording = record(*input->source, input->config);
  EXPECT_TRUE(recording.ok()) << recording.error().message;
  return {input->config, *std::move(recording)};
}

double rms_m(const Trajectory& path, const Recording& recording) {
  double sum = 0.0;
  int count = 0;
  std::size_t i = 0;
  for (const auto& [stamp, truth] : recording.truth) {
    while (i < path.size() && path[i].stamp < stamp) ++i;
    if (i == path.size() || path[i].stamp != stamp) continue;
    const Eigen::Vector2d start(recording.truth.front().second.x_m, recording.truth.front().second.y_m);
    const double heading_rad = *recording.truth.front().second.theta_rad;
    const Eigen::Vector2d p = start + rotation_matrix(heading_rad) * path[i].pose.position();
    sum += (p - Eigen::Vector2d(truth.x_m, truth.y_m)).squaredNorm();
    ++count;
  }
  EXPECT_GT(count, 100);
  return std::sqrt(sum / count);
}

void expect_same_stamps(const Trajectory& a, const Trajectory& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) ASSERT_EQ(a[i].stamp, b[i].stamp);
  EXPECT_EQ(a.front().pose, b.front().pose);
}

TEST(Smoother, IsNearerToTheTruthThanTheFilters) {
  constexpr int kSeeds = 6;
  for (const char* filter : {"filter=ekf", "filter=fastslam"}) {
    double live_m = 0.0, smoothed_m = 0.0;
    for (int seed = 1; seed <= kSeeds; ++seed) {
      const LiveRun live = drive({filter, "seed=" + std::to_string(seed)});
      const auto smoothed = smooth(live.recording, live.config);
      ASSERT_TRUE(smoothed.ok()) << smoothed.error().message;
      expect_same_stamps(smoothed->trajectory, live.recording.trajectory);
      live_m += rms_m(live.recording.trajectory, live.recording) / kSeeds;
      smoothed_m += rms_m(smoothed->trajectory, live.recording) / kSeeds;
    }
    EXPECT_LT(smoothed_m, live_m) << filter;
  }
}

TEST(Smoother, TakesRunsThatSawRangesOrBearingsAlone) {
  for (const char* observe : {"observe=range", "observe=bearing"}) {
    const LiveRun live = drive({"filter=fastslam", observe});
    const auto smoothed = smooth(live.recording, live.config);
    ASSERT_TRUE(smoothed.ok()) << smoothed.error().message;
    expect_same_stamps(smoothed->trajectory, live.recording.trajectory);
    EXPECT_GT(smoothed->observations, 100U);
    EXPECT_EQ(smoothed->landmarks.size(), live.recording.filter->snapshot().landmarks.size());
  }
}

TEST(Smoother, PathBetweenObservationsIsThatOfTheOdometryBentToMeetThem) {
  const LiveRun live = drive({});
  const auto smoothed = smooth(live.recording, live.config).value();
  const RunGraph graph = graph_of(live.recording, live.config);
  ASSERT_GT(graph.steps.size(), 10U);
  ASSERT_LT(graph.steps.size(), live.recording.trajectory.size());
  for (std::size_t i = 1; i < smoothed.trajectory.size(); ++i) {
    const Pose2 moved = smoothed.trajectory[i - 1].pose.inverse() * smoothed.trajectory[i].pose;
    EXPECT_LT((moved.position() - live.recording.motions[i].increment.position()).norm(), 0.05) << i;
  }
}

TEST(Smoother, LeavesOutWhatIsSeenInShortIntervals) {
  const LiveRun live = drive({"smooth.keyframe_distance_m=0.3", "smooth.keyframe_turn_deg=20"});
  const RunGraph graph = graph_of(live.recording, live.config);
  ASSERT_GT(graph.steps.size(), 10U);
  for (const KeyframeInterval& interval : graph.graph.intervals) {
    const Pose2 moved = motion_of(interval, Calibration::Zero()).increment;
    EXPECT_TRUE(moved.position().norm() >= 0.3 || std::abs(moved.theta_rad) >= to_radians(20.0));
  }
  Config any = live.config;
  any.smooth.keyframe_distance_m = any.smooth.keyframe_turn_deg = 0.0;
  EXPECT_GT(graph_of(live.recording, any).steps.size(), 2 * graph.steps.size());
  EXPECT_EQ(graph_of(live.recording, any, {Calibration::Zero(), graph.steps}).steps, graph.steps);
}

TEST(Smoother, SaysWhatCannotBeSmoothed) {
  LiveRun live = drive({});
  live.recording.motions.clear();
  EXPECT_THAT(smooth(live.recording, live.config).error().message,
              HasSubstr("has no poses and observations to smooth"));
  live.config.observe = Observe::kPixel;
  EXPECT_THAT(smooth(live.recording, live.config).error().message, HasSubstr("not with pixels"));
}

}  // namespace
}  // namespace waymark::smooth
