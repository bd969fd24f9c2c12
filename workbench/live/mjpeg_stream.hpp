#pragma once

#include <cstdint>

#include "workbench/live/clock_map.hpp"
#include "workbench/live/connected_stream.hpp"
#include "workbench/live/mjpeg_splitter.hpp"
#include "workbench/logs/image_file.hpp"

namespace waymark::live {

/// A camera that sends motion JPEG: from a web server (mjpg-streamer, ustreamer, ffmpeg), a TCP server, a
/// FIFO or a file. Images are unpacked on the stream's thread; where several have come at once only the
/// newest is. An image of another size than expected, or that cannot be unpacked, counts as damaged.
class MjpegStream final : public ConnectedStream {
 public:
  /// Where the sender stamps nothing, an image is of `latency` before its arrival.
  MjpegStream(Address address, std::uint16_t device, Duration latency, std::optional<ImageSize> expected)
      : ConnectedStream(std::move(address)), device_(device), latency_(latency), expected_(expected) {}

 protected:
  void begin(const Descriptor& connection) override;
  [[nodiscard]] bool take(std::string_view bytes, Stamp arrived, const Sink& sink) override;

 private:
  std::uint16_t device_;
  Duration latency_;
  std::optional<ImageSize> expected_;
  MjpegSplitter frames_;
  ClockMap clocks_;
  bool answered_ = false;  // the first bytes have come
};

}  // namespace waymark::live
