#include "workbench/live/monitor_feed.hpp"

#include <utility>

#include "workbench/logs/image_file.hpp"

namespace waymark::live {
namespace {

constexpr Duration kTrail = std::chrono::milliseconds(200);
constexpr Duration kImage = std::chrono::milliseconds(200);
constexpr Duration kMap = std::chrono::seconds(1);

/// Whether so much time has passed; then it begins anew.
bool is_due(std::optional<Stamp>& last, Stamp now, Duration period) {
  if (last && now - *last < period) return false;
  last = now;
  return true;
}

}  // namespace

void MonitorFeed::add(const Step& step) {
  if (step.correction != nullptr && step.correction->count(Outcome::kMatched) > 0) supported_ = step.stamp;
  if (is_due(last_trail_, step.stamp, kTrail)) trail_.add(step.pose.T_world_robot);
}

void MonitorFeed::hold(const Event& event) {
  const auto* const image = std::get_if<Image>(&event.content);
  if (image == nullptr || !monitor_.is_watched() || !is_due(last_image_, event.stamp, kImage)) return;
  if (image->encoded) {
    monitor_.show_image(image->encoded);
  } else if (image->pixels) {
    auto png = encode_png(*image->pixels);
    if (!png) return;
    monitor_.show_image(std::make_shared<const std::string>(*std::move(png)));
  }
  ++images_;
}

void MonitorFeed::update(const Session& session, const FilterRun& run, const Surroundings& around) {
  const Stamp now = clock_.now();
  const bool shows_map = is_due(last_map_, now, kMap);
  if (shows_map) monitor_.show_past("{\"trail\":" + trail_.to_json() + "}");
  if (!monitor_.is_watched()) {
    last_map_.reset();
    return;
  }
  MonitorState state;
  state.streams = session.stream_summaries();
  const FilterHealth health = run.recording().filter->health();
  state.light = judge_now(state.streams, health,
                          supported_ ? std::optional(to_seconds(now - *supported_)) : std::nullopt);
  state.since_start_s = to_seconds(now - start_);
  state.pose = session.pose_of_now();
  state.corrections = &session.correction_latencies();
  state.late = run.counts().late;
  state.image = images_;
  state.recording = around.recording;
  state.free_mb = around.free_mb;
  state.marks = around.marks;
  Snapshot snapshot;
  if (shows_map) {
    snapshot = run.recording().filter->snapshot();
    state.landmarks = &snapshot.landmarks;
  }
  monitor_.show(to_json(state));
}

}  // namespace waymark::live
