#include "workbench/live/session.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "workbench/live/stream_threads.hpp"

namespace waymark::live {
namespace {

constexpr auto kTick = std::chrono::milliseconds(5);
constexpr Duration kSlack = std::chrono::milliseconds(5);  // by which a thread may wake late
constexpr auto kQuestion = std::chrono::milliseconds(100);

}  // namespace

Session::Session(FilterRun& run, const Config& config, const SessionClock& clock,
                 std::vector<std::unique_ptr<Stream>> streams, Listeners listeners)
    : run_(run),
      clock_(clock),
      streams_(std::move(streams)),
      listeners_(std::move(listeners)),
      delay_(duration_from_seconds(config.sensor.delay_s)),
      response_(duration_from_seconds(config.odometry.response_s)),
      pose_of_now_(config.odometry, config.pipeline.max_hold_s) {
  run_.listen([this](const Step& step) { take(step); });
}

Result<void> Session::run(const std::function<bool()>& keep_going) {
  StreamThreads threads;
  for (const auto& stream : streams_) {
    auto started = threads.start(
        *stream, clock_, [this, &stream = *stream](Arrival arrival) { receive(stream, std::move(arrival)); });
    if (!started) return started;
  }
  std::vector<Arrival> arrivals;
  arrivals.reserve(Inbox::kMost);
  auto asked = std::chrono::steady_clock::now();
  for (;;) {
    const bool ended = have_all_ended();  // before what they left is taken
    const auto now = std::chrono::steady_clock::now();
    inbox_.take(arrivals, ended ? now : now + kTick);
    if (auto processed = process(arrivals); !processed) return processed;
    if (ended && arrivals.empty()) return {};
    if (now - asked < kQuestion) continue;
    asked = now;
    if (!keep_going()) return {};
  }
}

/// On the stream's thread.
void Session::receive(Stream& stream, Arrival arrival) {
  if (measures_motion(arrival.event.content)) {
    const Stamp arrived = arrival.arrived;
    if (const auto pose = pose_of_now_.add(arrival.event)) {
      if (listeners_.pose_of_now) listeners_.pose_of_now(*pose);
      const std::lock_guard lock(pose_latency_mutex_);
      pose_latencies_.add(to_seconds(clock_.now() - arrived));
    }
  }
  const Inbox::Outcome outcome = inbox_.push(std::move(arrival));
  if (outcome == Inbox::Outcome::kReplaced) stream.state().count_replaced();
  if (outcome == Inbox::Outcome::kDropped) stream.state().count_dropped();
}

/// When what it tells of happened, as the pipeline has it.
Stamp Session::moment_of(const Event& event) const {
  if (is_odometry(event.content)) return event.stamp + response_;
  return measures_motion(event.content) ? event.stamp : event.stamp - delay_;
}

void Session::note_arrival(const Arrival& arrival) {
  const Stamp moment = moment_of(arrival.event);
  lateness_.try_emplace(arrival.event.stream, clock_.span(kSlack)).first->second.add(moment, arrival.arrived);
  if (measures_motion(arrival.event.content))
    corrections_.odometry_arrived(moment, arrival.arrived);
  else
    corrections_.observation_arrived(moment, arrival.arrived);
}

Result<void> Session::process(const std::vector<Arrival>& arrivals) {
  for (const Arrival& arrival : arrivals) {
    if (!std::holds_alternative<Truth>(arrival.event.content)) note_arrival(arrival);
    if (listeners_.held) listeners_.held(arrival.event);
    if (auto held = run_.hold(arrival.event); !held) return held;
  }
  advance_horizon(clock_.now());
  const auto until = run_.horizon().stamp();
  last_step_.reset();
  if (until) {
    if (auto processed = run_.process_until(*until); !processed) return processed;
    if (listeners_.processed) listeners_.processed(*until);
  }
  if (last_step_) pose_of_now_.correct(*last_step_);
  return {};
}

void Session::advance_horizon(Stamp now) {
  for (const auto& [stream, lateness] : lateness_) run_.horizon().advance(stream, lateness.all_until(now));
}

void Session::take(const Step& step) {
  last_step_ = StampedPose{step.stamp, step.pose};
  if (step.correction != nullptr) corrections_.corrected(step.stamp, clock_.now());
  if (listeners_.step) listeners_.step(step);
}

bool Session::have_all_ended() const {
  return std::ranges::all_of(streams_, [](const auto& stream) { return stream->state().has_ended(); });
}

std::vector<StreamSummary> Session::stream_summaries() const {
  std::vector<StreamSummary> summaries;
  const Stamp now = clock_.now();
  for (const auto& stream : streams_) summaries.push_back(stream->state().summary(now));
  return summaries;
}

SessionFigures Session::figures() const {
  const std::lock_guard lock(pose_latency_mutex_);
  return {corrections_.waits(), corrections_.latencies(), pose_latencies_, stream_summaries()};
}

}  // namespace waymark::live
