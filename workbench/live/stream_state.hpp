#pragma once

#include <array>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>

#include "waymark/core/stamp.hpp"

namespace waymark::live {

/// What a stream has brought so far, and how it does now.
struct StreamSummary {
  std::string name;
  std::int64_t received = 0;
  std::int64_t bad = 0;       ///< that could not be read: checksum, damage, no number
  std::int64_t lost = 0;      ///< by the sender's count
  std::int64_t replaced = 0;  ///< images that a newer one came for before their turn
  std::int64_t dropped = 0;   ///< for which there was no room
  std::int64_t reconnects = 0;
  int clock_steps = 0;
  double rate_hz = 0.0;    ///< over the last events
  double age_p50_s = 0.0;  ///< from stamp to arrival
  double age_p99_s = 0.0;
  std::optional<double> silent_s;  ///< since the last event; empty: none came yet
  std::string fault;               ///< why it brings nothing; empty: all is well
  bool ended = false;
  bool brings_motion = false;  ///< odometry or a gyro, maybe with something else
};

/// The counts of one stream. Its own thread writes, others ask.
class StreamState {
 public:
  explicit StreamState(std::string name);

  void count_arrival(Stamp stamp, Stamp arrived, bool is_motion = false);
  void count_bad(std::int64_t count = 1);
  void count_lost(std::int64_t count);
  void count_replaced();
  void count_dropped();
  void set_clock_steps(int steps);
  void fail(std::string fault);
  void connect();
  void end();

  [[nodiscard]] StreamSummary summary(Stamp now) const;
  [[nodiscard]] bool has_ended() const;

 private:
  /// Ages by powers of 2^(1/4) from 10 us on.
  static constexpr std::size_t kAges = 80;
  [[nodiscard]] double age_quantile_s(double part) const;

  mutable std::mutex mutex_;
  StreamSummary summary_;
  std::array<std::int64_t, kAges> ages_{};
  std::optional<Stamp> last_arrival_;
  std::optional<double> period_s_;  // averaged over about ten
  bool was_connected_ = false;
};

}  // namespace waymark::live
