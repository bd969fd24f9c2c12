#include "workbench/run/recording.hpp"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include "waymark/slam/pipeline.hpp"

#include "workbench/run/check_gyro.hpp"
#include "workbench/run/check_jumps.hpp"
#include "workbench/run/check_log.hpp"
#include "workbench/run/check_refusals.hpp"
#include "workbench/run/make_filter.hpp"

namespace waymark {
namespace {

/// Counts of the pipeline as lines for a person.
std::vector<std::string> describe_counts(const PipelineCounts& counts) {
  std::vector<std::string> lines;
  const auto note = [&lines](std::int64_t count, const char* what) {
    if (count > 0) lines.push_back(fmt::format("{} {}", count, what));
  };
  note(counts.late, "events dropped: later than pipeline.reorder_window_s allows");
  note(counts.unusable, "observations dropped: not finite or outside the sensor's range limits");
  note(counts.wrong_kind, "observations dropped: they do not measure what the key observe asks for");
  note(counts.other_odometry, "odometry events ignored: from a second kind of odometry or a second device");
  note(counts.other_robots, "events ignored: from another robot than the first");
  note(counts.robots_seen, "observations dropped: of other robots, which are not landmarks");
  note(counts.misfits, "images skipped: their size is not camera.width_px x camera.height_px");
  note(counts.repeats, "images skipped: same stamp or same pixels as the image before");
  note(counts.odometry_gaps, "gaps in the odometry longer than pipeline.max_hold_s");
  return lines;
}

std::vector<std::string> describe_refusals(const std::vector<Recording::TimedInnovation>& innovations) {
  std::vector<std::string> lines;
  for (const Outcome outcome :
       {Outcome::kGated, Outcome::kUnidentified, Outcome::kUnusable, Outcome::kAmbiguous, Outcome::kDuplicate,
        Outcome::kMapFull, Outcome::kNotInMap, Outcome::kDeferred, Outcome::kDistrusted}) {
    const auto count = std::ranges::count_if(
        innovations, [outcome](const auto& i) { return i.innovation.outcome == outcome; });
    if (count > 0)
      lines.push_back(fmt::format("{} observations not used by the filter: {}", count, describe(outcome)));
  }
  return lines;
}

std::vector<std::string> describe_unobservable(const Config& config) {
  if (!config.ekf.odometry.estimate || config.filter != FilterKind::kEkf ||
      observes_scale(config.observe, config.sensor.errors))
    return {};
  return {"motion.speed_scale was not estimated: it is not observable without ranges of known scale"};
}

/// Keeps what smoothing needs. Where pixels were looked for, innovations are not of given observations.
void keep_for_smoothing(Recording& recording, const Step& step) {
  if (step.correction == nullptr || step.correction->innovations.size() != step.observations.size()) return;
  for (std::size_t i = 0; i < step.observations.size(); ++i) {
    const Innovation& innovation = step.correction->innovations[i];
    recording.observations.push_back(
        {recording.trajectory.size() - 1, innovation.landmark, innovation.outcome, step.observations[i]});
  }
}

/// Keeps what the pipeline reports.
void keep(Recording& recording, const Step& step, const FrontEnd* front_end) {
  recording.trajectory.push_back({step.stamp, step.pose.T_world_robot, step.pose.covariance});
  recording.dead_reckoning.push_back({step.stamp, step.dead_reckoning, std::nullopt});
  recording.motions.push_back(step.motion);
  if (step.correction == nullptr) return;
  if (step.image != nullptr && front_end != nullptr)
    recording.image_strip.add(step.stamp, *step.image, front_end->search_records(),
                              step.correction->innovations);
  recording.steps.push_back({step.stamp, step.cpu});
  for (const Innovation& innovation : step.correction->innovations)
    recording.innovations.push_back({step.stamp, innovation});
}

Result<void> check_span(const TimeSpan& span) {
  if (span.from_s < span.to_s) return {};
  return Error{fmt::format("--to {} is not after --from {}", span.to_s, span.from_s)};
}

/// A span that begins after the log's end.
std::optional<Error> find_empty_span(const TimeSpan& span, double length_s) {
  if (span.from_s <= length_s) return std::nullopt;
  return Error{fmt::format("--from {}: the log is {:.1f} s long", span.from_s, length_s)};
}

/// Feeds the source's events within the span to `accept`; the reason if reading broke off.
std::optional<Error> read_all(Source& source, const TimeSpan& span,
                              const std::function<bool(double)>& keep_going,
                              const std::function<Result<void>(Event)>& accept) {
  constexpr int kEventsPerQuestion = 256;
  std::optional<Stamp> start;
  double elapsed_s = 0.0;
  for (std::int64_t count = 0;; ++count) {
    if (keep_going && count % kEventsPerQuestion == 0 && !keep_going(source.progress()))
      return Error{"stopped; the results so far are kept", Error::Kind::kFailed};
    auto event = source.next();
    if (!event) return event.error();
    if (!*event) return find_empty_span(span, elapsed_s);
    if (!start) start = (*event)->stamp;
    elapsed_s = to_seconds((*event)->stamp - *start);
    if (elapsed_s > span.to_s) return std::nullopt;
    if (elapsed_s < span.from_s) continue;
    if (auto accepted = accept(std::move(**event)); !accepted) return accepted.error();
  }
}

bool looks_into_images(Observe observe) { return observe == Observe::kPixel || observe == Observe::kMarkers; }

bool shows_pixels(const EventContent& content) {
  const auto* observations = std::get_if<Observations>(&content);
  return std::holds_alternative<Image>(content) || std::holds_alternative<MarkerOutlines>(content) ||
         (observations != nullptr && std::ranges::any_of(*observations, [](const Observation& each) {
            return std::holds_alternative<Pixel>(each.value);
          }));
}

/// Wheels, cars and cameras that nobody knows: what they measured cannot be understood.
Result<void> check_sensor_of(const Event& event, const Config& config) {
  if (std::holds_alternative<WheelAngles>(event.content)) return check(config.odometry.wheels);
  if (std::holds_alternative<Steering>(event.content)) return check(config.odometry.car);
  if (config.camera_known || !looks_into_images(config.observe) || !shows_pixels(event.content)) return {};
  return Error{
      "camera.fu_px: the camera is not calibrated: put its camera_info file, as `waymark calibrate camera "
      "PHOTOS` writes one, into the log as camera.yaml, or set camera.width_px, camera.height_px, "
      "camera.fu_px, camera.fv_px, camera.cu_px and camera.cv_px; for a bag set input.camera_file to the "
      "file"};
}

/// Truth goes to the record, the rest to the pipeline.
Result<void> route(Event event, Recording& recording, Pipeline& pipeline) {
  if (const auto* truth = std::get_if<Truth>(&event.content)) {
    recording.truth.emplace_back(event.stamp, *truth);
    return {};
  }
  pipeline.push(std::move(event));
  if (auto refusal = recording.filter->refusal()) return *std::move(refusal);
  return {};
}

/// Where every observation lacks what the mode asks for, dead reckoning would pass for a result.
std::optional<Error> find_wrong_mode(const Recording& recording, Observe observe) {
  if (observe == Observe::kMarkers && recording.counts.images == 0)
    return Error{
        "observe: markers need images, and this log has no image that can be used; `waymark check` lists "
        "what it has"};
  if (observe == Observe::kPixel && recording.counts.images == 0 && recording.innovations.empty())
    return Error{
        "observe: pixel needs images or pixel observations, and this log has no image and no pixel "
        "observation that can be used; `waymark check` lists what it has"};
  if (recording.counts.wrong_kind == 0 || recording.counts.unusable > 0 || !recording.innovations.empty())
    return std::nullopt;
  return Error{"observe: no observation of this log measures this; `waymark check` lists what it has"};
}

/// What cannot be right in the log, or in where its landmarks are.
std::vector<std::string> find_contradictions(const Recording& recording, const LogSample& sample,
                                             const Config& config) {
  std::vector<std::string> lines;
  if (recording.trajectory.empty()) return lines;
  const Stamp start = recording.trajectory.front().stamp;
  std::ranges::move(describe(recording.counts.odometry_jumps, start), std::back_inserter(lines));
  std::ranges::move(describe(recording.counts.gyro, start), std::back_inserter(lines));
  std::ranges::move(contradictions_in(sample, config), std::back_inserter(lines));
  if (config.observe != Observe::kPixel)  // whose landmarks come and go
    std::ranges::move(describe_refused_landmarks(recording.innovations, start), std::back_inserter(lines));
  return lines;
}

/// Where the robot never found itself there is no result.
std::optional<Error> find_unknown_pose(const Filter& filter) {
  if (filter.refusal() || filter.knows_pose()) return filter.refusal();
  return Error{"map: localisation failed: fewer than 3 landmarks of the map were observed"};
}

void finish_images(Recording& recording, const Config& config, const FrontEnd& front_end) {
  recording.patches = front_end.patches();
  recording.tracker = front_end.tracker_counts();
  if (config.observe == Observe::kPixel)
    recording.frame_budget = duration_from_seconds(1e-3 * config.tracker.budget.per_frame_ms);
  std::vector<Innovation> innovations;
  for (const auto& each : recording.innovations) innovations.push_back(each.innovation);
  std::ranges::move(front_end.notes(innovations), std::back_inserter(recording.notes));
}

/// Those of the filter and of what looks into images for it, by their names.
std::vector<FunctionBlocks::Row> blocks_of(const Filter& filter, const FrontEnd* front_end) {
  const auto of_filter = filter.blocks().rows();
  std::vector<FunctionBlocks::Row> rows(of_filter.begin(), of_filter.end());
  if (front_end == nullptr) return rows;
  const auto of_front_end = front_end->blocks();
  rows.insert(rows.end(), of_front_end.begin(), of_front_end.end());
  std::ranges::sort(rows, {}, &FunctionBlocks::Row::name);
  return rows;
}

}  // namespace

Result<Recording> record(Source& source, const Config& config, const TimeSpan& span,
                         const std::function<bool(double)>& keep_going) {
  if (auto valid = check_span(span); !valid) return valid.error();
  const auto start_map = read_start_map(config);
  if (!start_map) return start_map.error();
  auto system = make_filter_system(config, *start_map);
  if (!system) return system.error();
  Recording recording;
  LogSample sample;
  recording.filter = std::move(system->filter);
  FrontEnd* const front_end = system->front_end.get();
  Pipeline pipeline(
      *recording.filter, config.pipeline, config.odometry, config.sensor, config.observe,
      [&](const Step& step) {
        if (!recording.filter->knows_pose()) return;
        keep(recording, step, front_end);
        if (config.observe == Observe::kMarkers) sample.add(step.stamp, step.observations, config.sensor);
        if (config.smooth.run) keep_for_smoothing(recording, step);
      },
      front_end);
  const auto start = std::chrono::steady_clock::now();
  Result<void> sensors_known;
  recording.error = read_all(source, span, keep_going, [&](Event event) {
    sample.add(event, config.sensor);
    sensors_known = check_sensor_of(event, config);
    return sensors_known ? route(std::move(event), recording, pipeline) : sensors_known;
  });
  pipeline.finish();
  recording.odometry = pipeline.odometry();
  // The robot would be taken to stand, which would pass for a result. A later part of a log may have none.
  if (!recording.error && !recording.odometry && span.from_s <= 0.0)
    return Error{describe_missing_odometry(source.info())};
  const bool broke_off = recording.error && sensors_known && !recording.trajectory.empty();
  if (!recording.error) recording.error = find_unknown_pose(*recording.filter);
  recording.wall = std::chrono::steady_clock::now() - start;
  recording.counts = pipeline.counts();
  recording.blocks = blocks_of(*recording.filter, front_end);
  if (!recording.error) recording.error = find_wrong_mode(recording, config.observe);
  if (recording.error && !broke_off) return *recording.error;
  recording.notes = source.notes();
  if (front_end != nullptr) finish_images(recording, config, *front_end);
  std::ranges::move(describe_counts(recording.counts), std::back_inserter(recording.notes));
  std::ranges::move(describe_unobservable(config), std::back_inserter(recording.notes));
  std::ranges::move(describe_refusals(recording.innovations), std::back_inserter(recording.notes));
  std::ranges::move(find_contradictions(recording, sample, config), std::back_inserter(recording.notes));
  return recording;
}

MapState save_map(const Recording& recording) {
  MapState map = recording.filter->save();
  if (!recording.trajectory.empty()) map.stamp = recording.trajectory.back().stamp;
  for (const LandmarkPatch& patch : recording.patches)
    if (std::ranges::find(map.ids, patch.id) != map.ids.end()) map.patches.push_back(patch);
  return map;
}

}  // namespace waymark
