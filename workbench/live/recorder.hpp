#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>

#include "waymark/core/event.hpp"

#include "workbench/live/mcap_writer.hpp"
#include "workbench/live/pose_of_now.hpp"

namespace waymark::live {

/// Writes a session into an MCAP file, on a thread of its own, so that `waymark run` of it gives the same
/// path and map. What decides stands on the topic /waymark/events, as lines of JSON in the order in which the
/// filter was given it:
///
///     {"session":"<name>","config":"<YAML>"}   the first
///     {"device":3, ...}                        an event (logs/json_event.hpp)
///     {"device":1,"image":"<stamp_s>"}         the next message of /camera/image/compressed
///     {"until":"<stamp_s>"}                    all up to this stamp was processed
///
/// Images (sensor_msgs/CompressedImage) and poses of now (geometry_msgs/PoseWithCovarianceStamped,
/// /waymark/pose) are messages of ROS 2. A chunk ends twice a second: what a crash can cost. The recorder
/// never holds the filter up: what it cannot write in time is dropped, and the recording then says that it is
/// not whole; so does one whose disk is full.
class Recorder {
 public:
  static constexpr std::size_t kMostWaiting = 64'000'000;  ///< bytes

  [[nodiscard]] static Result<std::unique_ptr<Recorder>> open(const std::string& path,
                                                              const std::string& session,
                                                              const std::string& config_yaml, Stamp now);
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// The filter was given an event.
  void hold(const Event& event, Stamp now);
  /// All up to a stamp was processed.
  void process_until(Stamp until) { until_ = until; }
  /// From any thread.
  void add(const StampedPose& pose);

  /// Writes what waits, and ends the file. An error: why the recording is not whole.
  [[nodiscard]] Result<void> close();

  /// Why the recording is not whole; empty: it is so far.
  [[nodiscard]] std::string fault() const;
  [[nodiscard]] std::uint64_t bytes_written() const;

 private:
  struct Message {
    std::uint16_t channel;
    Stamp logged;
    Stamp published;
    std::string bytes;
  };

  explicit Recorder(McapWriter writer);
  void push(Message message);
  void push_event(std::string line, Stamp now);
  void write_until(Stamp now);
  void work(const std::stop_token& stop);
  void stop_thread();

  McapWriter writer_;
  std::uint16_t events_;
  std::uint16_t images_;
  std::uint16_t poses_;
  std::optional<Stamp> until_;  // processed, and not yet told
  mutable std::mutex mutex_;    // of all below
  std::condition_variable_any pushed_;
  std::deque<Message> waiting_;
  std::size_t waiting_bytes_ = 0;
  std::uint64_t bytes_written_ = 0;
  std::string fault_;
  std::stop_source stop_;
  std::thread thread_;
};

}  // namespace waymark::live
