#pragma once

#include <functional>
#include <stop_token>
#include <string>

#include "workbench/live/inbox.hpp"
#include "workbench/live/session_clock.hpp"
#include "workbench/live/stream_state.hpp"

namespace waymark::live {

/// Something that brings events: a camera, wheels, a socket. run() is called on a thread of its own.
class Stream {
 public:
  using Sink = std::function<void(Arrival)>;

  explicit Stream(std::string name) : state_(std::move(name)) {}
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;
  virtual ~Stream() = default;

  /// Reads, and gives what arrives to `sink`, until a stop is asked for or nothing can come any more. Opens
  /// again what breaks off. Answers a stop within a tenth of a second.
  virtual void run(const std::stop_token& stop, const SessionClock& clock, const Sink& sink) = 0;

  [[nodiscard]] StreamState& state() { return state_; }
  [[nodiscard]] const StreamState& state() const { return state_; }

 private:
  StreamState state_;
};

}  // namespace waymark::live
