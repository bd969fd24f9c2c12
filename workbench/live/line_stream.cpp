#include "workbench/live/line_stream.hpp"

#include <poll.h>
#include <unistd.h>

#include <array>
#include <cstddef>
#include <utility>

#include "workbench/logs/json_event.hpp"

namespace waymark::live {
namespace {

class WheelDecoder final : public LineDecoder {
 public:
  WheelDecoder(double ticks_per_turn, std::uint16_t device) : counter_(ticks_per_turn), device_(device) {}

  std::optional<Event> decode(std::string_view line, Stamp arrived, StreamState& state) override {
    const auto read = parse_wheel_line(line);
    if (!read) {
      state.count_bad();
      return std::nullopt;
    }
    const WheelCounter::Reading reading = counter_.add(*read);
    if (reading.lost > 0) state.count_lost(reading.lost);
    const Stamp stamp = clocks_.map(reading.clock, arrived);
    state.set_clock_steps(clocks_.steps());
    return Event(stamp, {0, device_}, reading.angles);
  }

 private:
  WheelCounter counter_;
  ClockMap clocks_;
  std::uint16_t device_;
};

class JsonDecoder final : public LineDecoder {
 public:
  explicit JsonDecoder(std::uint16_t device) : device_(device) {}

  std::optional<Event> decode(std::string_view line, Stamp arrived, StreamState& state) override {
    auto read = parse_json_event(line);
    if (!read) {
      state.count_bad();
      return std::nullopt;
    }
    const std::size_t kind = kind_of(read->content);
    const Stamp stamp = read->stamp ? clocks_[kind].map(read->stamp->since_epoch, arrived) : arrived;
    state.set_clock_steps(clocks_[0].steps() + clocks_[1].steps() + clocks_[2].steps());
    const auto device = static_cast<std::uint16_t>(device_ + kind);
    return Event(stamp, {0, device}, std::move(read->content));
  }

 private:
  static std::size_t kind_of(const EventContent& content) {
    if (std::holds_alternative<Observations>(content)) return 1;
    return std::holds_alternative<YawRate>(content) ? 2 : 0;
  }

  std::array<ClockMap, kJsonStreams> clocks_;
  std::uint16_t device_;
};

}  // namespace

std::unique_ptr<LineDecoder> decode_wheel_lines(double ticks_per_turn, std::uint16_t device) {
  return std::make_unique<WheelDecoder>(ticks_per_turn, device);
}

std::unique_ptr<LineDecoder> decode_json_lines(std::uint16_t device) {
  return std::make_unique<JsonDecoder>(device);
}

void LineStream::begin(const Descriptor& /*connection*/) { lines_.forget(); }

bool LineStream::take(std::string_view bytes, Stamp arrived, const Sink& sink) {
  const auto take_line = [&](std::string_view line) {
    if (auto event = decoder_->decode(line, arrived, state())) give(*std::move(event), arrived, sink);
  };
  const std::int64_t passed_over = lines_.passed_over();
  lines_.add(bytes, take_line);
  if (address().kind == Address::Kind::kUdp) lines_.add("\n", take_line);
  state().count_bad(lines_.passed_over() - passed_over);
  return true;
}

}  // namespace waymark::live
