#pragma once

#include <string_view>

#include "workbench/live/descriptor.hpp"
#include "workbench/live/stream.hpp"

namespace waymark::live {

/// Bytes from a serial port, a socket, a FIFO, a file or standard input, connected again whenever that breaks
/// off.
class ConnectedStream : public Stream {
 public:
  explicit ConnectedStream(Address address) : Stream(address.text), address_(std::move(address)) {}

  void run(const std::stop_token& stop, const SessionClock& clock, const Sink& sink) final;

 protected:
  /// A connection was made, on which may be written. Nothing of the one before goes on.
  virtual void begin(const Descriptor& /*connection*/) {}
  /// What arrived, in one piece where they are datagrams. False: the connection is of no use, for a reason
  /// that was told to state().
  [[nodiscard]] virtual bool take(std::string_view bytes, Stamp arrived, const Sink& sink) = 0;
  /// Twenty times a second and oftener.
  virtual void tick(const Descriptor& /*connection*/, Stamp /*now*/) {}
  /// The connection is about to be given up.
  virtual void end(const Descriptor& /*connection*/) {}

  [[nodiscard]] const Address& address() const { return address_; }
  void give(Event event, Stamp arrived, const Sink& sink);

 private:
  void read(const Descriptor& from, const std::stop_token& stop, const SessionClock& clock, const Sink& sink);

  Address address_;
};

}  // namespace waymark::live
