#include "workbench/live/probe.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <set>
#include <thread>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "workbench/live/stream_threads.hpp"

namespace waymark::live {
namespace {

/// What an event is, for a person.
struct Describe {
  std::string operator()(const WheelAngles& /*wheels*/) const { return "wheel angles"; }
  std::string operator()(const Velocity& /*velocity*/) const { return "velocities"; }
  std::string operator()(const Steering& /*steering*/) const { return "speeds and steering angles"; }
  std::string operator()(const OdometryPose& /*pose*/) const { return "poses of odometry"; }
  std::string operator()(const YawRate& /*rate*/) const { return "yaw rates"; }
  std::string operator()(const Image& image) const {
    if (!image.pixels) return "images";
    return fmt::format("images of {} x {}", image.pixels->width_px(), image.pixels->height_px());
  }
  std::string operator()(const MarkerOutlines& /*outlines*/) const { return "corners of markers"; }
  std::string operator()(const Observations& /*observations*/) const { return "observations"; }
  std::string operator()(const Truth& /*truth*/) const { return "true poses"; }
};

/// What arrives of one stream.
class Tally {
 public:
  void add(const Arrival& arrival) {
    const std::lock_guard lock(mutex_);
    brings_.insert(std::visit(Describe{}, arrival.event.content));
    if (last_) {
      const double period_ms = 1e3 * to_seconds(arrival.arrived - *last_);
      ++periods_;
      sum_ms_ += period_ms;
      squares_ms2_ += period_ms * period_ms;
    }
    last_ = arrival.arrived;
  }

  [[nodiscard]] Probed result(const StreamSummary& summary) const {
    const std::lock_guard lock(mutex_);
    const double mean_ms = periods_ > 0 ? sum_ms_ / periods_ : 0.0;
    const double variance_ms2 = periods_ > 0 ? squares_ms2_ / periods_ - mean_ms * mean_ms : 0.0;
    return {summary, {brings_.begin(), brings_.end()}, std::sqrt(std::max(variance_ms2, 0.0))};
  }

 private:
  mutable std::mutex mutex_;
  std::set<std::string> brings_;
  std::optional<Stamp> last_;
  double periods_ = 0.0;
  double sum_ms_ = 0.0;
  double squares_ms2_ = 0.0;
};

/// A stream, and what came of it.
struct Listened {
  Stream* stream;
  std::unique_ptr<Tally> tally;
};

}  // namespace

Result<std::vector<Probed>> probe(const std::vector<std::unique_ptr<Stream>>& streams,
                                  const SessionClock& clock, double for_s,
                                  const std::function<bool()>& keep_going) {
  std::vector<Listened> listened;
  for (const auto& stream : streams) listened.push_back({stream.get(), std::make_unique<Tally>()});
  {
    StreamThreads threads;
    for (const auto& [stream, tally] : listened) {
      auto started =
          threads.start(*stream, clock, [to = tally.get()](const Arrival& arrival) { to->add(arrival); });
      if (!started) return started.error();
    }
    const Stamp end = clock.now() + duration_from_seconds(for_s);
    while (clock.now() < end && keep_going()) std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  std::vector<Probed> probed;
  for (const auto& [stream, tally] : listened)
    probed.push_back(tally->result(stream->state().summary(clock.now())));
  return probed;
}

std::string to_text(const std::vector<Probed>& streams) {
  std::string text;
  for (const auto& [summary, brings, jitter_ms] : streams) {
    text += fmt::format("{}: ", summary.name);
    if (brings.empty()) {
      text += fmt::format("nothing came{}{}\n", summary.fault.empty() ? "" : ": ", summary.fault);
      if (summary.bad > 0)
        text += fmt::format("  {} damaged: is it of this kind, and the baud rate right?\n", summary.bad);
      continue;
    }
    text +=
        fmt::format("{}, {:.1f} Hz, jitter {:.1f} ms, age {:.1f} ms (99 %: {:.1f} ms), {} lost, {} damaged\n",
                    fmt::join(brings, ", "), summary.rate_hz, jitter_ms, 1e3 * summary.age_p50_s,
                    1e3 * summary.age_p99_s, summary.lost, summary.bad);
  }
  return text;
}

}  // namespace waymark::live
