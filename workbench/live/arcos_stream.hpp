#pragma once

#include <cstdint>

#include "workbench/live/arcos.hpp"
#include "workbench/live/connected_stream.hpp"

namespace waymark::live {

/// The odometry of a Pioneer robot, on its serial port or through a TCP server. It only listens: the robot is
/// asked for its information packets, and never told to move. A packet has no stamp: it is of its arrival.
class ArcosStream final : public ConnectedStream {
 public:
  ArcosStream(Address address, std::uint16_t device, double unit_mm)
      : ConnectedStream(std::move(address)), device_(device), odometry_(unit_mm) {}

 protected:
  void begin(const Descriptor& connection) override;
  [[nodiscard]] bool take(std::string_view bytes, Stamp arrived, const Sink& sink) override;
  void tick(const Descriptor& connection, Stamp now) override;
  void end(const Descriptor& connection) override;

 private:
  std::uint16_t device_;
  ArcosOdometry odometry_;
  ArcosSplitter packets_;
  ArcosHandshake handshake_;
};

}  // namespace waymark::live
