#include "workbench/live/connected_stream.hpp"

#include <poll.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <thread>
#include <utility>

#include "waymark/slam/odometer.hpp"

namespace waymark::live {
namespace {

constexpr int kPoll_ms = 50;
constexpr auto kReconnect = std::chrono::milliseconds(500);

void wait(const std::stop_token& stop, std::chrono::milliseconds time) {
  const auto end = std::chrono::steady_clock::now() + time;
  while (!stop.stop_requested() && std::chrono::steady_clock::now() < end)
    std::this_thread::sleep_for(std::chrono::milliseconds(kPoll_ms));
}

}  // namespace

void ConnectedStream::run(const std::stop_token& stop, const SessionClock& clock, const Sink& sink) {
  while (!stop.stop_requested()) {
    if (const auto opened = open_for_reading(address_)) {
      state().connect();
      begin(*opened);
      read(*opened, stop, clock, sink);
      end(*opened);
      if (stop.stop_requested() || !address_.may_come_back()) break;
    } else {
      state().fail(opened.error().message);
    }
    wait(stop, kReconnect);
  }
  state().end();
}

void ConnectedStream::read(const Descriptor& from, const std::stop_token& stop, const SessionClock& clock,
                           const Sink& sink) {
  const bool datagrams = address_.kind == Address::Kind::kUdp;
  std::array<char, 65536> buffer;
  while (!stop.stop_requested()) {
    pollfd ready{from.get(), POLLIN, 0};
    const bool is_ready = poll(&ready, 1, kPoll_ms) > 0;
    tick(from, clock.now());
    if (!is_ready) continue;
    const ssize_t count = ::read(from.get(), buffer.data(), buffer.size());
    const Stamp arrived = clock.now();
    if (count < 0 && (errno == EAGAIN || errno == EINTR)) continue;
    if (count <= 0 && !datagrams)
      return state().fail(count < 0 ? std::strerror(errno) : "the other end has closed");
    if (count > 0 && !take({buffer.data(), static_cast<std::size_t>(count)}, arrived, sink)) return;
  }
}

void ConnectedStream::give(Event event, Stamp arrived, const Sink& sink) {
  state().count_arrival(event.stamp, arrived, measures_motion(event.content));
  sink({std::move(event), arrived});
}

}  // namespace waymark::live
