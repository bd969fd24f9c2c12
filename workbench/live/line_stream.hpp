#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>

#include "workbench/live/clock_map.hpp"
#include "workbench/live/connected_stream.hpp"
#include "workbench/live/line_splitter.hpp"
#include "workbench/live/wheel_line.hpp"

namespace waymark::live {

/// Makes events of lines of text. One per stream; called by its thread.
class LineDecoder {
 public:
  LineDecoder() = default;
  LineDecoder(const LineDecoder&) = delete;
  LineDecoder& operator=(const LineDecoder&) = delete;
  virtual ~LineDecoder() = default;

  /// Nothing where the line tells nothing that can be used, which it counts.
  [[nodiscard]] virtual std::optional<Event> decode(std::string_view line, Stamp arrived,
                                                    StreamState& state) = 0;
};

/// The wheels' serial protocol (WheelLine); `device` is the number of its stream.
[[nodiscard]] std::unique_ptr<LineDecoder> decode_wheel_lines(double ticks_per_turn, std::uint16_t device);

/// Lines of JSON (JsonEvent). Odometry, gyro, observations are streams of their own, numbered from `device`:
/// they come at different paces.
[[nodiscard]] std::unique_ptr<LineDecoder> decode_json_lines(std::uint16_t device);

/// How many numbers of streams decode_json_lines() takes.
inline constexpr std::uint16_t kJsonStreams = 3;

/// Lines of text from any address.
class LineStream final : public ConnectedStream {
 public:
  LineStream(Address address, std::unique_ptr<LineDecoder> decoder)
      : ConnectedStream(std::move(address)), decoder_(std::move(decoder)) {}

 protected:
  void begin(const Descriptor& connection) override;
  [[nodiscard]] bool take(std::string_view bytes, Stamp arrived, const Sink& sink) override;

 private:
  std::unique_ptr<LineDecoder> decoder_;
  LineSplitter lines_;
};

}  // namespace waymark::live
