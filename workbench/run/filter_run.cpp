#include "workbench/run/filter_run.hpp"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include "workbench/run/check_gaps.hpp"
#include "workbench/run/check_gyro.hpp"
#include "workbench/run/check_jumps.hpp"
#include "workbench/run/check_log.hpp"
#include "workbench/run/check_refusals.hpp"

namespace waymark {
namespace {

constexpr std::size_t kInnovationsPerPoint = 4;

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

/// Keeps what the pipeline reports of the path; `motion` is that since the point before.
void keep_point(Recording& recording, const Step& step, const Motion& motion) {
  recording.trajectory.push_back({step.stamp, step.pose.T_world_robot, step.pose.covariance});
  recording.dead_reckoning.push_back({step.stamp, step.dead_reckoning, std::nullopt});
  recording.motions.push_back(motion);
}

/// Keeps what it reports of a correction.
void keep_correction(Recording& recording, const Step& step, const FrontEnd* front_end) {
  if (step.image != nullptr && front_end != nullptr)
    recording.image_strip.add(step.stamp, *step.image, front_end->search_records(),
                              step.correction->innovations);
  recording.losses.add(step.stamp, recording.filter->health());
  recording.steps.push_back({step.stamp, step.cpu});
  for (const Innovation& innovation : step.correction->innovations)
    recording.innovations.push_back({step.stamp, innovation});
}

/// Leaves every second.
template <class Value>
void halve(std::vector<Value>& values) {
  for (std::size_t i = 0; 2 * i + 1 < values.size(); ++i) values[i] = std::move(values[2 * i + 1]);
  values.resize(values.size() / 2);
}

/// Leaves the later half where there are too many.
template <class Value>
void forget_old(std::vector<Value>& values, std::size_t most) {
  if (values.size() >= most)
    values.erase(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(most / 2));
}

void halve_path(Recording& recording) {
  auto& motions = recording.motions;
  for (std::size_t i = 0; i + 1 < motions.size(); i += 2)
    motions[i + 1] = compose(motions[i], motions[i + 1]);
  halve(motions);
  halve(recording.trajectory);
  halve(recording.dead_reckoning);
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
  std::ranges::move(describe(recording.counts.odometry_gaps, start, config.pipeline.max_hold_s),
                    std::back_inserter(lines));
  std::ranges::move(describe(recording.counts.odometry_jumps, start), std::back_inserter(lines));
  std::ranges::move(describe(recording.counts.gyro, start), std::back_inserter(lines));
  std::ranges::move(describe(recording.losses, start), std::back_inserter(lines));
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

FilterRun::FilterRun(const Config& config, FilterSystem system)
    : config_(config), front_end_(std::move(system.front_end)), start_(std::chrono::steady_clock::now()) {
  recording_.filter = std::move(system.filter);
  pipeline_.emplace(
      *recording_.filter, config_.pipeline, config_.odometry, config_.sensor, config_.observe,
      [this](const Step& step) { keep(step); }, front_end_.get());
}

Result<std::unique_ptr<FilterRun>> FilterRun::make(const Config& config) {
  const auto start_map = read_start_map(config);
  if (!start_map) return start_map.error();
  auto system = make_filter_system(config, *start_map);
  if (!system) return system.error();
  return std::unique_ptr<FilterRun>(new FilterRun(config, *std::move(system)));
}

Result<void> FilterRun::push(Event event) {
  const auto expected = expect(event);
  if (!expected || !*expected) return expected ? Result<void>{} : expected.error();
  pipeline_->push(std::move(event));
  return refusal();
}

Result<void> FilterRun::hold(Event event) {
  const auto expected = expect(event);
  if (!expected || !*expected) return expected ? Result<void>{} : expected.error();
  pipeline_->hold(std::move(event));
  return {};
}

Result<void> FilterRun::process_until(Stamp stamp) {
  pipeline_->process_until(stamp);
  return refusal();
}

/// Whether it is for the pipeline: truth goes to the record. An error: its sensor is not known.
Result<bool> FilterRun::expect(const Event& event) {
  sample_.add(event, config_.sensor);
  if (auto known = check_sensor_of(event, config_); !known) {
    sensors_known_ = false;
    return known.error();
  }
  const auto* truth = std::get_if<Truth>(&event.content);
  if (truth != nullptr) recording_.truth.emplace_back(event.stamp, *truth);
  return truth == nullptr;
}

Result<void> FilterRun::refusal() const {
  if (auto refusal = recording_.filter->refusal()) return *std::move(refusal);
  return {};
}

void FilterRun::keep(const Step& step) {
  if (!recording_.filter->knows_pose()) return;
  const auto motion = most_points_ ? thinner_.add(step.motion) : std::optional(step.motion);
  if (motion) keep_point(recording_, step, *motion);
  if (step.correction != nullptr) keep_correction(recording_, step, front_end_.get());
  if (most_points_) limit_memory(*most_points_);
  if (config_.observe == Observe::kMarkers) sample_.add(step.stamp, step.observations, config_.sensor);
  if (config_.smooth.run) keep_for_smoothing(recording_, step);
  if (listener_) listener_(step);
}

void FilterRun::limit_memory(std::size_t most) {
  if (recording_.trajectory.size() >= most) {
    halve_path(recording_);
    thinner_.double_stride();
  }
  if (recording_.truth.size() >= most) halve(recording_.truth);
  forget_old(recording_.steps, most);
  forget_old(recording_.innovations, kInnovationsPerPoint * most);
}

Result<Recording> FilterRun::finish(const LogInfo& log, std::vector<std::string> notes,
                                    std::optional<Error> broke_off, bool whole_log) {
  recording_.error = std::move(broke_off);
  pipeline_->finish();
  recording_.odometry = pipeline_->odometry();
  // The robot would be taken to stand, which would pass for a result. A later part of a log may have none.
  if (!recording_.error && !recording_.odometry && whole_log) return Error{describe_missing_odometry(log)};
  const bool has_result = recording_.error && sensors_known_ && !recording_.trajectory.empty();
  if (!recording_.error) recording_.error = find_unknown_pose(*recording_.filter);
  recording_.wall = std::chrono::steady_clock::now() - start_;
  recording_.counts = pipeline_->counts();
  recording_.blocks = blocks_of(*recording_.filter, front_end_.get());
  if (!recording_.error) recording_.error = find_wrong_mode(recording_, config_.observe);
  if (recording_.error && !has_result) return *recording_.error;
  recording_.notes = std::move(notes);
  if (front_end_) finish_images(recording_, config_, *front_end_);
  std::ranges::move(describe_counts(recording_.counts), std::back_inserter(recording_.notes));
  std::ranges::move(describe_unobservable(config_), std::back_inserter(recording_.notes));
  std::ranges::move(describe_refusals(recording_.innovations), std::back_inserter(recording_.notes));
  std::ranges::move(find_contradictions(recording_, sample_, config_), std::back_inserter(recording_.notes));
  return std::move(recording_);
}

}  // namespace waymark
