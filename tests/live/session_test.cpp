#include "workbench/live/session.hpp"

#include <cmath>
#include <thread>

#include <gtest/gtest.h>

#include "workbench/eval/evaluate.hpp"
#include "workbench/live/replay_stream.hpp"
#include "workbench/run/config.hpp"
#include "workbench/study/scored_run.hpp"

namespace waymark::live {
namespace {

/// A session over a simulated log at so many times its pace.
struct Replayed {
  study::ScoredRun run;
  SessionFigures figures;
  PipelineCounts counts;
  std::vector<StampedPose> poses_of_now;
};

Replayed replay(const std::string& input, const UserSettings& user, double speed) {
  auto opened = open_input(input, user).value();
  auto stream = std::make_unique<ReplayStream>(*opened.source);
  const SessionClock clock(*stream->first().value(), speed);
  std::vector<std::unique_ptr<Stream>> streams;
  streams.push_back(std::move(stream));
  const auto run = FilterRun::make(opened.config).value();
  std::vector<StampedPose> poses;
  Session session(*run, opened.config, clock, std::move(streams),
                  {[&](const StampedPose& pose) { poses.push_back(pose); }, {}});
  EXPECT_TRUE(session.run([] { return true; }).ok());
  const SessionFigures figures = session.figures();
  const PipelineCounts counts = run->counts();
  auto recording = run->finish(opened.source->info(), {}, std::nullopt, true);
  return {study::score_run(input, opened.config, opened.source->info(), *std::move(recording)), figures,
          counts, poses};
}

TEST(Session, IsAsExactAsTheSameLogOffline) {
  const UserSettings user{{}, {"sim.laps=1", "seed=3"}};
  const auto offline = study::run_and_score("sim:study", user).value();
  const Replayed live = replay("sim:study", user, 50.0);
  EXPECT_EQ(live.counts.events, offline.recording.counts.events);
  EXPECT_LT(live.counts.late, live.counts.events / 50);
  EXPECT_LT(*live.run.evaluation->path.position_rmse_m,
            1.3 * *offline.evaluation->path.position_rmse_m + 0.01);
  EXPECT_GT(live.figures.correction_latencies.count(), 100);
  EXPECT_EQ(live.figures.streams[0].dropped, 0);
}

TEST(Session, TellsAPoseOfNowThatTheFilterLaterAgreesWith) {
  const Replayed live = replay("sim:study", {{}, {"sim.laps=1"}}, 50.0);
  ASSERT_GT(live.poses_of_now.size(), 1000U);
  double squared = 0.0;
  int compared = 0;
  std::size_t next = 0;
  for (const StampedPose& pose : live.poses_of_now) {
    const Trajectory& trajectory = live.run.recording.trajectory;
    while (next < trajectory.size() && trajectory[next].stamp < pose.stamp) ++next;
    if (next == trajectory.size() || trajectory[next].stamp != pose.stamp) continue;
    squared += difference(trajectory[next].pose, pose.estimate.T_world_robot).head<2>().squaredNorm();
    ++compared;
  }
  ASSERT_GT(compared, 500);
  EXPECT_LT(std::sqrt(squared / compared), 0.05);
}

/// Brings odometry and then nothing more, without end.
class FallsSilent final : public Stream {
 public:
  explicit FallsSilent(std::uint16_t device, int events)
      : Stream("silent"), device_(device), events_(events) {}

  void run(const std::stop_token& stop, const SessionClock& clock, const Sink& sink) override {
    for (int i = 0; !stop.stop_requested(); ++i) {
      const Stamp now = clock.now();
      if (i < events_) sink({Event(now, {0, device_}, Velocity{0.5, 0.0}), now});
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    state().end();
  }

 private:
  std::uint16_t device_;
  int events_;
};

TEST(Session, WaitsForNoStreamThatFellSilent) {
  Config config;
  const auto run = FilterRun::make(config).value();
  std::vector<std::unique_ptr<Stream>> streams;
  streams.push_back(std::make_unique<FallsSilent>(1, 1 << 20));
  streams.push_back(std::make_unique<FallsSilent>(2, 3));
  const SessionClock clock(Stamp{}, 1.0);
  Session session(*run, config, clock, std::move(streams), {});
  ASSERT_TRUE(session.run([&] { return to_seconds(clock.now()) < 0.6; }).ok());
  ASSERT_FALSE(run->recording().trajectory.empty());
  EXPECT_GT(to_seconds(run->recording().trajectory.back().stamp), 0.4);
}

}  // namespace
}  // namespace waymark::live
