#include "workbench/live/stream_threads.hpp"

#include <system_error>
#include <utility>

#include <fmt/format.h>

namespace waymark::live {

Result<void> StreamThreads::start(Stream& stream, const SessionClock& clock, Stream::Sink sink) {
  try {
    threads_.emplace_back([&stream, &clock, sink = std::move(sink)](const std::stop_token& stop) {
      stream.run(stop, clock, sink);
    });
  } catch (const std::system_error& error) {
    return Error{fmt::format("{}: its thread cannot be started: {}", stream.state().summary({}).name,
                             error.code().message()),
                 Error::Kind::kFailed};
  }
  return {};
}

/// All are asked before the first is waited for.
StreamThreads::~StreamThreads() {
  for (std::jthread& thread : threads_) thread.request_stop();
}

}  // namespace waymark::live
