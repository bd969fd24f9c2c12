#pragma once

#include <memory>
#include <optional>

#include "workbench/live/stream.hpp"
#include "workbench/logs/source.hpp"

namespace waymark::live {

/// A log at its pace, in place of a robot: each event comes at its stamp by the session's clock, which began
/// with the log's first.
class ReplayStream final : public Stream {
 public:
  explicit ReplayStream(Source& source) : Stream(source.info().name), source_(source) {}

  /// The stamp of the log's first event, which run() then begins with.
  [[nodiscard]] Result<std::optional<Stamp>> first();

  void run(const std::stop_token& stop, const SessionClock& clock, const Sink& sink) override;

 private:
  Source& source_;
  std::optional<Event> first_;
};

}  // namespace waymark::live
