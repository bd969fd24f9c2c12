#include "workbench/live/arcos_stream.hpp"

#include <unistd.h>

namespace waymark::live {
namespace {

/// What the port does not take now is asked for again when it was due.
void send(const Descriptor& connection, const std::string& bytes) {
  if (!bytes.empty()) static_cast<void>(write(connection.get(), bytes.data(), bytes.size()));
}

}  // namespace

void ArcosStream::begin(const Descriptor& /*connection*/) {
  packets_ = {};
  handshake_ = {};
}

bool ArcosStream::take(std::string_view bytes, Stamp arrived, const Sink& sink) {
  const std::int64_t damaged = packets_.damaged();
  packets_.add(bytes);
  while (const auto data = packets_.next()) {
    handshake_.heard(*data);
    if (const auto pose = odometry_.add(*data)) give(Event(arrived, {0, device_}, *pose), arrived, sink);
  }
  state().count_bad(packets_.damaged() - damaged);
  return true;
}

void ArcosStream::tick(const Descriptor& connection, Stamp now) { send(connection, handshake_.next(now)); }

void ArcosStream::end(const Descriptor& connection) { send(connection, arcos_command(ArcosCommand::kClose)); }

}  // namespace waymark::live
