#pragma once

#include <stop_token>
#include <thread>
#include <vector>

#include "waymark/core/result.hpp"

#include "workbench/live/stream.hpp"

namespace waymark::live {

/// Runs each stream on a thread of its own, and ends them all with this object.
class StreamThreads {
 public:
  StreamThreads() = default;
  ~StreamThreads();
  StreamThreads(const StreamThreads&) = delete;
  StreamThreads& operator=(const StreamThreads&) = delete;

  /// `stream` and `clock` must outlive this. An error: the system has no thread for it.
  [[nodiscard]] Result<void> start(Stream& stream, const SessionClock& clock, Stream::Sink sink);

 private:
  std::stop_source stop_;
  std::vector<std::thread> threads_;
};

}  // namespace waymark::live
