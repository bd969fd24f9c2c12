#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "waymark/core/result.hpp"

#include "workbench/live/stream.hpp"

namespace waymark::live {

/// What a stream brought while it was listened to.
struct Probed {
  StreamSummary summary;
  std::vector<std::string> brings;  ///< "wheel angles", "images of 640 x 480", ...
  double jitter_ms = 0.0;           ///< standard deviation of the time between arrivals
};

/// Listens to streams for some seconds of the session's clock, as long as `keep_going` says so. An error: a
/// thread cannot be started.
[[nodiscard]] Result<std::vector<Probed>> probe(const std::vector<std::unique_ptr<Stream>>& streams,
                                                const SessionClock& clock, double for_s,
                                                const std::function<bool()>& keep_going);

/// A line for each, and what it lacks.
[[nodiscard]] std::string to_text(const std::vector<Probed>& streams);

}  // namespace waymark::live
