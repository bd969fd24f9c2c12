#include "waymark/slam/pipeline.hpp"

#include <algorithm>
#include <cmath>

namespace waymark {
namespace {

/// Images that wait for the next odometry may take so many bytes: half a minute of 640 x 480 at 30 Hz.
constexpr std::size_t kMostWaiting = 256'000'000;

std::size_t pixel_bytes(const Event& event) {
  const auto* image = std::get_if<Image>(&event.content);
  if (image == nullptr || !image->pixels) return 0;
  return static_cast<std::size_t>(image->pixels->width_px()) *
         static_cast<std::size_t>(image->pixels->height_px());
}

/// The part of a measurement that is asked for, or nothing if it is not there.
std::optional<Measurement> part(const Measurement& value, Observe observe) {
  const auto* both = std::get_if<RangeBearing>(&value);
  switch (observe) {
    case Observe::kRangeBearing:
      return both != nullptr ? std::optional(value) : std::nullopt;
    case Observe::kRange:
      if (both != nullptr) return Range{both->range_m};
      return std::holds_alternative<Range>(value) ? std::optional(value) : std::nullopt;
    case Observe::kBearing:
      if (both != nullptr) return Bearing{both->bearing_rad};
      return std::holds_alternative<Bearing>(value) ? std::optional(value) : std::nullopt;
    case Observe::kPixel:
      return std::holds_alternative<Pixel>(value) ? std::optional(value) : std::nullopt;
    case Observe::kMarkers:
      return std::nullopt;  // they are seen in images
  }
  return std::nullopt;
}

/// A covariance that came with range and bearing, cut down to the part that is used.
Eigen::Matrix2d part_covariance(const Observation& observation, const Measurement& used) {
  Eigen::Matrix2d R = *observation.covariance;
  if (std::holds_alternative<RangeBearing>(observation.value) && std::holds_alternative<Bearing>(used))
    R(0, 0) = R(1, 1);
  if (!std::holds_alternative<RangeBearing>(used)) R(0, 1) = R(1, 0) = R(1, 1) = 0.0;
  return R;
}

/// The limits of the sensor are not those of the camera, whose filter knows them.
bool can_be_used(const LandmarkSensor& sensor, const Measurement& value) {
  if (const auto* pixel = std::get_if<Pixel>(&value))
    return std::isfinite(pixel->u_px) && std::isfinite(pixel->v_px);
  return is_usable(sensor, value);
}

/// Pixels keep what they came with.
std::optional<Eigen::Matrix2d> used_covariance(const LandmarkSensor& sensor, const Observation& observation,
                                               const Measurement& used) {
  if (std::holds_alternative<Pixel>(used)) return observation.covariance;
  return observation.covariance ? part_covariance(observation, used) : noise_covariance(sensor, used);
}

}  // namespace

Pipeline::Pipeline(Filter& filter, const PipelineOptions& options, const OdometryOptions& odometry,
                   const LandmarkSensor& sensor, Observe observe, Sink sink, FrontEnd* front_end)
    : filter_(filter),
      sensor_(sensor),
      observe_(observe),
      sink_(std::move(sink)),
      front_end_(front_end),
      odometer_(odometry, options.max_hold_s),
      window_(duration_from_seconds(options.reorder_window_s)),
      delay_(duration_from_seconds(sensor.delay_s)),
      response_(duration_from_seconds(odometry.response_s)) {}

void Pipeline::push(Event event) {
  if (!accept(event)) return;
  insert(std::move(event));
  while (front_is_ready()) process_front_group();
}

/// Nothing comes before it any more, and the odometry that bridges it has come, unless that is too far away.
bool Pipeline::front_is_ready() const {
  if (waiting_.empty() || waiting_.front().stamp + window_ >= waiting_.back().stamp) return false;
  return odometer_.holds_speeds() || newest_odometry_ >= waiting_.front().stamp ||
         waiting_bytes_ > kMostWaiting;
}

void Pipeline::hold(Event event) {
  if (!accept(event)) return;
  horizon_.advance(event.stream, event.stamp);
  insert(std::move(event));
}

void Pipeline::process_until(Stamp stamp) {
  while (!waiting_.empty() && waiting_.front().stamp <= stamp) process_front_group();
}

/// Stamps an event with the moment that it is of. False: it is not used.
bool Pipeline::accept(Event& event) {
  if (!is_observed(event.content) && !measures_motion(event.content)) return false;
  if (event.stream.robot != robot_.value_or(event.stream.robot)) {
    ++counts_.other_robots;
    return false;
  }
  robot_ = event.stream.robot;
  event.stamp = event.stamp + shift_of(event.content);
  ++counts_.events;
  if (processed_ && event.stamp < *processed_) {
    ++counts_.late;
    return false;
  }
  announce(event);
  return true;
}

/// A gyro measures the motion itself, which follows what odometry reports of commands.
Duration Pipeline::shift_of(const EventContent& content) const {
  if (is_observed(content)) return -delay_;
  return is_odometry(content) ? response_ : Duration{0};
}

bool Pipeline::is_observed(const EventContent& content) const {
  return std::holds_alternative<Observations>(content) ||
         (front_end_ != nullptr && std::holds_alternative<Image>(content)) ||
         (front_end_ != nullptr && front_end_->takes_outlines() &&
          std::holds_alternative<MarkerOutlines>(content));
}

/// The front end may look into an image while that waits for its turn.
void Pipeline::announce(const Event& event) {
  const auto* image = std::get_if<Image>(&event.content);
  if (image != nullptr && front_end_ != nullptr && image->pixels && front_end_->fits(*image->pixels))
    front_end_->announce(image->pixels);
}

void Pipeline::finish() {
  while (!waiting_.empty()) process_front_group();
}

/// Behind all events that are not later: nearly always at the end.
void Pipeline::insert(Event event) {
  auto place = waiting_.end();
  while (place != waiting_.begin() && std::prev(place)->stamp > event.stamp) --place;
  if (may_follow(event)) newest_odometry_ = std::max(newest_odometry_, event.stamp);
  waiting_bytes_ += pixel_bytes(event);
  waiting_.insert(place, std::move(event));
}

/// The odometry that counts, or that will because it is the first.
bool Pipeline::may_follow(const Event& event) const {
  return is_odometry(event.content) && (!odometer_.kind() || odometer_.follows(event));
}

const Event* Pipeline::next_odometry() const {
  const auto found = std::ranges::find_if(waiting_, [this](const Event& event) { return may_follow(event); });
  return found == waiting_.end() ? nullptr : &*found;
}

const Event* Pipeline::next_yaw_rate() const {
  if (!odometer_.has_yaw_rate()) return nullptr;
  const auto found = std::ranges::find_if(waiting_, [this](const Event& event) {
    return std::holds_alternative<YawRate>(event.content) && odometer_.follows(event);
  });
  return found == waiting_.end() ? nullptr : &*found;
}

bool Pipeline::front_group_observes() const {
  const auto begins_next = [this](const Event& event) { return event.stamp != waiting_.front().stamp; };
  const auto end = std::ranges::find_if(waiting_, begins_next);
  return std::any_of(waiting_.begin(), end,
                     [this](const Event& event) { return is_observed(event.content); });
}

void Pipeline::process_front_group() {
  const Stamp stamp = waiting_.front().stamp;
  const bool observed = front_group_observes();
  if (observed) stopwatch_.start();
  predict(stamp);
  batch_.clear();
  for (; !waiting_.empty() && waiting_.front().stamp == stamp; waiting_.pop_front()) {
    const Event& event = waiting_.front();
    waiting_bytes_ -= pixel_bytes(event);
    if (const auto* observations = std::get_if<Observations>(&event.content)) {
      collect(*observations);
    } else if (const auto* outlines = std::get_if<MarkerOutlines>(&event.content)) {
      ++counts_.outlines;
      ++counts_.images;
      collect_seen(front_end_->see(*outlines));
    } else if (const auto* image = std::get_if<Image>(&event.content)) {
      take(*image);
    } else {
      odometry_seen_ = odometry_seen_ || is_odometry(event.content);
      counts_.other_odometry += odometer_.add(event) ? 0 : 1;
    }
  }
  const Correction* correction = correct();
  Step step{stamp, filter_.pose(), dead_reckoning_, motion_, batch_, correction, image_.get(), {}};
  if (observed) step.cpu = stopwatch_.stop();
  processed_ = stamp;
  sink_(step);
  if (image_) last_image_ = std::exchange(image_, nullptr);
}

/// Pixels that come as observations are a front end's work done elsewhere: they go before an image.
const Correction* Pipeline::correct() {
  if (image_ && front_end_->corrects_filter() && !batch_.empty()) image_.reset();
  const Correction* correction = image_ ? see_image() : nullptr;
  return batch_.empty() ? correction : &filter_.correct(batch_);
}

/// Puts what is seen into the batch, or returns what the filter made of it.
const Correction* Pipeline::see_image() {
  ++counts_.images;
  const FrontEnd::Seen seen = front_end_->see(image_);
  if (const auto* correction = std::get_if<const Correction*>(&seen)) {
    counts_.observations += std::ssize((*correction)->innovations);
    return *correction;
  }
  collect_seen(std::get<std::span<const Observation>>(seen));
  last_image_ = std::exchange(image_, nullptr);
  return nullptr;
}

void Pipeline::collect_seen(std::span<const Observation> seen) {
  for (const Observation& observation : seen) {
    ++counts_.observations;
    if (is_usable(sensor_, observation.value))
      batch_.push_back(observation);
    else
      ++counts_.unusable;
  }
}

void Pipeline::predict(Stamp stamp) {
  motion_ = odometer_.advance(stamp, next_odometry(), next_yaw_rate());
  if (is_still(motion_)) return;
  dead_reckoning_ = dead_reckoning_ * motion_.increment;
  filter_.predict(motion_);
}

void Pipeline::collect(const Observations& observations) {
  for (const Observation& observation : observations) {
    ++counts_.observations;
    counts_.before_odometry += odometry_seen_ ? 0 : 1;
    if (observation.id && observation.id->family == LandmarkId::Family::kRobot) {
      ++counts_.robots_seen;
      continue;
    }
    const Measurement value = rectify(sensor_, observation.value);
    const auto used = part(value, observe_);
    if (!used) {
      ++counts_.wrong_kind;
    } else if (!can_be_used(sensor_, value)) {
      ++counts_.unusable;
    } else {
      batch_.push_back({observation.id, *used, used_covariance(sensor_, observation, *used)});
    }
  }
}

/// A camera that hangs gives one image again and again, under new stamps: believing it would stop the
/// robot.
void Pipeline::take(const Image& image) {
  if (!image.pixels || !front_end_->fits(*image.pixels)) {
    ++counts_.misfits;
  } else if (image_ || (last_image_ && *last_image_ == *image.pixels)) {
    ++counts_.repeats;
    front_end_->drop(image.pixels);
  } else {
    image_ = image.pixels;
  }
}

PipelineCounts Pipeline::counts() const {
  PipelineCounts counts = counts_;
  counts.odometry_gaps = odometer_.gaps().all();
  counts.odometry_jumps = odometer_.jumps();
  counts.gyro = odometer_.gyro();
  return counts;
}

}  // namespace waymark
