#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "waymark/core/event.hpp"
#include "waymark/core/result.hpp"

namespace waymark {

/// A surveyed landmark, world frame of the truth.
struct TrueLandmark {
  LandmarkId id;
  double x_m = 0.0;
  double y_m = 0.0;
  double z_m = 0.0;
};

/// One of the streams that a recording consists of, used or not.
struct LogTopic {
  std::string name;
  std::string type;
  std::int64_t messages = 0;
  std::string use;  ///< "odometry", ...; empty: it is not used
};

/// What a log says about itself before its first event.
struct LogInfo {
  std::string name;
  std::string format;  ///< "log folder", "MRCLAM", "simulation", ...
  /// Config keys that the log knows about its robot (wheels, mounts, noise): they rank above the defaults and
  /// below what the user says.
  std::vector<std::pair<std::string, std::string>> settings;
  std::vector<TrueLandmark> landmarks;
  bool identities = true;    ///< some observation says which landmark it is of
  bool only_pixels = false;  ///< what it observes is pixels alone: given ones, or images of a known camera
  std::optional<Eigen::Vector2d>
      truth_sensor_m;                 ///< where on the robot the truth was measured; empty: its origin
  std::vector<LogTopic> topics = {};  ///< of a bag; other logs have none
  double recorded_s = 0.0;            ///< from the first to the last message of all topics
};

/// Anything that produces events: a reader, the simulator, a robot. Who reads it cannot tell which.
class Source {
 public:
  Source() = default;
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;
  virtual ~Source() = default;

  [[nodiscard]] virtual const LogInfo& info() const = 0;

  /// The next event, nothing at the end, or why reading cannot go on. Events of one kind come in the log's
  /// order.
  [[nodiscard]] virtual Result<std::optional<Event>> next() = 0;

  /// How events were processed in a session that is replayed.
  struct Replay {
    /// Up to here between the event that next() gave last and the one before; empty: nothing.
    std::optional<Stamp> until;
  };
  /// Nothing where the log does not say: its events are put in order as they come.
  [[nodiscard]] virtual std::optional<Replay> replay() const { return std::nullopt; }

  /// What was skipped, mended or odd so far, one line each, with counts.
  [[nodiscard]] virtual std::vector<std::string> notes() const { return {}; }

  /// Fraction of the log that has been read, for a progress bar.
  [[nodiscard]] virtual double progress() const { return 0.0; }
};

}  // namespace waymark
