#pragma once

#include <map>
#include <optional>

#include "waymark/core/event.hpp"

namespace waymark {

/// Up to which stamp all streams have told everything, so that it can be processed without waiting any
/// longer. Each stream has a horizon of its own: its newest stamp, less the time by which its events may come
/// out of order.
class ReleaseHorizon {
 public:
  /// A stream that holds the horizon back from now on, before its first event too. Its events may be stamped
  /// up to `lateness` before the newest one.
  void expect(StreamId stream, Duration lateness);

  /// A stream has told of this moment. One that nobody expected is taken to come in order.
  void advance(StreamId stream, Stamp stamp);

  /// A stream that fell silent: it holds nobody up until it tells something again.
  void release(StreamId stream);

  /// Empty: a stream that is expected has not told anything yet, or no stream has. O(streams).
  [[nodiscard]] std::optional<Stamp> stamp() const;

 private:
  struct Stream {
    Duration lateness{0};
    std::optional<Stamp> newest = std::nullopt;
    bool silent = false;
  };

  std::map<StreamId, Stream> streams_;
};

}  // namespace waymark
