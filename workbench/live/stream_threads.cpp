#include "workbench/live/stream_threads.hpp"

#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "waymark/core/threads.hpp"

namespace waymark::live {

Result<void> StreamThreads::start(Stream& stream, const SessionClock& clock, Stream::Sink sink) {
  const auto work = [&stream, &clock, sink = std::move(sink), stop = stop_.get_token()] {
    stream.run(stop, clock, sink);
  };
  try {
    threads_.push_back(std::move(start_threads(1, work, [] {}).front()));
  } catch (const std::system_error& error) {
    return Error{fmt::format("{}: {}", stream.state().summary({}).name, error.what()), Error::Kind::kFailed};
  }
  return {};
}

StreamThreads::~StreamThreads() {
  stop_.request_stop();
  for (std::thread& thread : threads_) thread.join();
}

}  // namespace waymark::live
