#include "waymark/slam/release_horizon.hpp"

#include <algorithm>

namespace waymark {

void ReleaseHorizon::expect(StreamId stream, Duration lateness) { streams_[stream].lateness = lateness; }

void ReleaseHorizon::advance(StreamId stream, Stamp stamp) {
  Stream& known = streams_[stream];
  known.newest = std::max(known.newest.value_or(stamp), stamp);
  known.silent = false;
}

void ReleaseHorizon::release(StreamId stream) { streams_[stream].silent = true; }

std::optional<Stamp> ReleaseHorizon::stamp() const {
  std::optional<Stamp> earliest;
  for (const auto& [id, stream] : streams_) {
    if (stream.silent) continue;
    if (!stream.newest) return std::nullopt;
    const Stamp horizon = *stream.newest - stream.lateness;
    earliest = std::min(earliest.value_or(horizon), horizon);
  }
  return earliest;
}

}  // namespace waymark
