#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "workbench/live/monitor.hpp"
#include "workbench/live/monitor_state.hpp"
#include "workbench/live/session.hpp"

namespace waymark::live {

/// Tells a monitor how a session does. All on the filter's thread, and as little as nobody notices: what is
/// costly only while someone is looking.
class MonitorFeed {
 public:
  MonitorFeed(Monitor& monitor, const SessionClock& clock)
      : monitor_(monitor), clock_(clock), start_(clock.now()) {}

  /// The filter has processed a stamp.
  void add(const Step& step);
  /// It is about to be given an event: images are shown as they came, at most five a second.
  void hold(const Event& event);

  /// What the rest of the program knows.
  struct Surroundings {
    std::string recording;
    std::optional<double> free_mb;
    int marks = 0;
  };
  /// Ten times a second.
  void update(const Session& session, const FilterRun& run, const Surroundings& around);

 private:
  Monitor& monitor_;
  SessionClock clock_;
  Stamp start_;
  Trail trail_;
  std::optional<Stamp> supported_;  // when a landmark of the map was last observed
  std::optional<Stamp> last_trail_;
  std::optional<Stamp> last_image_;
  std::optional<Stamp> last_map_;
  std::uint64_t images_ = 0;
};

}  // namespace waymark::live
