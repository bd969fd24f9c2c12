#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "waymark/core/event.hpp"

namespace waymark::live {

/// ARCOS, also P2OS: what the controllers of Pioneer robots speak (Pioneer 3 Operations Manual, chapter 6).
/// A packet is FA FB, the number of bytes that follow, data, and a checksum of the data: the sum of its
/// big-endian 16-bit words, a last odd byte by exclusive or.
[[nodiscard]] std::string arcos_packet(std::string_view data);

/// Commands that a listener sends. ENABLE, which lets the motors run, is not among them.
enum class ArcosCommand : std::uint8_t { kPulse = 0, kOpen = 1, kClose = 2 };
[[nodiscard]] std::string arcos_command(ArcosCommand command);

/// Cuts bytes, as they come in, into the data of packets.
class ArcosSplitter {
 public:
  void add(std::string_view bytes) { bytes_.append(bytes); }
  /// The data of the next packet that is complete and right.
  [[nodiscard]] std::optional<std::string> next();
  [[nodiscard]] std::int64_t damaged() const { return damaged_; }

 private:
  std::string bytes_;
  std::int64_t damaged_ = 0;
};

/// Follows the pose in server information packets (SIP): two bytes each of x and y in units of distance,
/// which wrap, and of the heading in 4096ths of a turn, behind an identity of 0x32 (standing) or 0x33
/// (moving).
class ArcosOdometry {
 public:
  /// mm per unit of x and y: DistConvFactor of the robot's parameter file, 0.485 for a P3-DX.
  explicit ArcosOdometry(double unit_mm) : unit_m_(1e-3 * unit_mm) {}

  /// Nothing where the data are of another packet.
  [[nodiscard]] std::optional<OdometryPose> add(std::string_view data);

 private:
  struct Raw {
    std::uint16_t x;
    std::uint16_t y;
  };

  double unit_m_;
  std::optional<Raw> last_;
  double x_m_ = 0.0;
  double y_m_ = 0.0;
};

/// What is to be said to a robot so that it tells where it is: SYNC0, SYNC1, SYNC2, each when the one before
/// was echoed, then OPEN, and PULSE every second, without which its watchdog stops it. Begins anew where
/// nothing is answered within half a second.
class ArcosHandshake {
 public:
  /// A packet came from the robot.
  void heard(std::string_view data);
  /// What is to be sent now, if anything.
  [[nodiscard]] std::string next(Stamp now);
  [[nodiscard]] bool is_open() const { return said_ > kSyncs; }

 private:
  static constexpr int kSyncs = 3;

  int echoed_ = 0;  // of the three
  int said_ = 0;    // 0 to 3: that many SYNCs; 4: OPEN
  std::optional<Stamp> last_;
};

}  // namespace waymark::live
