#include "workbench/live/recorder.hpp"

#include <chrono>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "waymark/core/threads.hpp"

#include "workbench/live/ros2_messages.hpp"
#include "workbench/logs/image_file.hpp"
#include "workbench/logs/json_event.hpp"
#include "workbench/logs/json_text.hpp"

namespace waymark::live {
namespace {

using Json = nlohmann::ordered_json;

constexpr auto kFlush = std::chrono::milliseconds(500);
constexpr const char* kFrame = "camera";

/// The bytes of an image as a camera sent them; those of a simulated one as a PNG file.
Result<std::string> encoded(const Image& image) {
  if (image.encoded) return *image.encoded;
  if (!image.pixels) return Error{"an image has no pixels"};
  return encode_png(*image.pixels);
}

}  // namespace

Recorder::Recorder(McapWriter writer)
    : writer_(std::move(writer)),
      events_(
          writer_.add({"/waymark/events", "json", "waymark.Event", "jsonschema", R"({"type":"object"})"})),
      images_(writer_.add({"/camera/image/compressed", "cdr", "sensor_msgs/msg/CompressedImage", "ros2msg",
                           ros2::kCompressedImage})),
      poses_(writer_.add({"/waymark/pose", "cdr", "geometry_msgs/msg/PoseWithCovarianceStamped", "ros2msg",
                          ros2::kPoseWithCovarianceStamped})) {}

Result<std::unique_ptr<Recorder>> Recorder::open(const std::string& path, const std::string& session,
                                                 const std::string& config_yaml, Stamp now) {
  auto writer = McapWriter::open(path);
  if (!writer) return writer.error();
  std::unique_ptr<Recorder> recorder(new Recorder(*std::move(writer)));
  recorder->push_event(json_text(Json{{"session", session}, {"config", config_yaml}}), now);
  try {
    const auto work = [raw = recorder.get()] { raw->work(raw->stop_.get_token()); };
    recorder->thread_ = std::move(start_threads(1, work, [] {}).front());
  } catch (const std::system_error& error) {
    return Error{fmt::format("{}: {}", path, error.what()), Error::Kind::kFailed};
  }
  return recorder;
}

Recorder::~Recorder() { stop_thread(); }

void Recorder::hold(const Event& event, Stamp now) {
  write_until(now);
  const auto* image = std::get_if<Image>(&event.content);
  if (image == nullptr) {
    auto json = Json::parse(to_json_event(event.stamp, event.content), nullptr, false);
    if (json.is_discarded()) return;  // truth
    json["device"] = event.stream.device;
    return push_event(json_text(json), now);
  }
  auto bytes = encoded(*image);
  if (!bytes) return;  // the pipeline skips it, too
  push_event(json_text(Json{{"device", event.stream.device}, {"image", to_string(event.stamp)}}), now);
  push({images_, now, event.stamp, ros2::compressed_image(event.stamp, kFrame, *bytes)});
}

void Recorder::add(const StampedPose& pose) {
  push({poses_, pose.stamp, pose.stamp, ros2::pose_with_covariance(pose.stamp, "map", pose.estimate)});
}

/// Only the last of several before an event changes anything; what waits after the last event is processed at
/// the end anyhow.
void Recorder::write_until(Stamp now) {
  if (!until_) return;
  push_event(json_text(Json{{"until", to_string(*until_)}}), now);
  until_.reset();
}

void Recorder::push_event(std::string line, Stamp now) { push({events_, now, now, std::move(line)}); }

void Recorder::push(Message message) {
  {
    const std::lock_guard lock(mutex_);
    if (waiting_bytes_ + message.bytes.size() > kMostWaiting && fault_.empty())
      fault_ = "the disk is too slow: the recording is not whole";
    if (!fault_.empty()) return;
    waiting_bytes_ += message.bytes.size();
    waiting_.push_back(std::move(message));
  }
  pushed_.notify_one();
}

void Recorder::work(const std::stop_token& stop) {
  auto flush_at = std::chrono::steady_clock::now() + kFlush;
  for (;;) {
    std::deque<Message> messages;
    {
      std::unique_lock lock(mutex_);
      pushed_.wait_until(lock, stop, flush_at, [this] { return !waiting_.empty(); });
      messages.swap(waiting_);
      waiting_bytes_ = 0;
    }
    for (const Message& each : messages) writer_.write(each.channel, each.logged, each.published, each.bytes);
    if (std::chrono::steady_clock::now() >= flush_at || stop.stop_requested()) {
      const auto flushed = writer_.flush();
      const std::lock_guard lock(mutex_);
      bytes_written_ = writer_.bytes_written();
      if (!flushed && fault_.empty()) fault_ = flushed.error().message;
      flush_at = std::chrono::steady_clock::now() + kFlush;
    }
    if (stop.stop_requested() && messages.empty()) return;
  }
}

void Recorder::stop_thread() {
  if (!thread_.joinable()) return;
  stop_.request_stop();
  thread_.join();
}

Result<void> Recorder::close() {
  stop_thread();
  auto closed = writer_.close();
  bytes_written_ = writer_.bytes_written();
  if (!fault_.empty()) return Error{fault_, Error::Kind::kFailed};
  return closed;
}

std::string Recorder::fault() const {
  const std::lock_guard lock(mutex_);
  return fault_;
}

std::uint64_t Recorder::bytes_written() const {
  const std::lock_guard lock(mutex_);
  return bytes_written_;
}

}  // namespace waymark::live
