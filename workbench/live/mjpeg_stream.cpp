#include "workbench/live/mjpeg_stream.hpp"

#include <memory>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace waymark::live {

void MjpegStream::begin(const Descriptor& /*connection*/) {
  const std::int64_t damaged = frames_.damaged();
  frames_.forget();
  state().count_bad(frames_.damaged() - damaged);
  answered_ = false;
}

bool MjpegStream::take(std::string_view bytes, Stamp arrived, const Sink& sink) {
  if (!std::exchange(answered_, true) && bytes.starts_with("HTTP/") && bytes.substr(8, 5) != " 200 ") {
    state().fail(fmt::format("{}: the server answers{}", address().text, bytes.substr(8, 4)));
    return false;
  }
  const std::int64_t damaged = frames_.damaged();
  frames_.add(bytes);
  std::optional<MjpegSplitter::Frame> newest;
  while (auto frame = frames_.next()) {
    if (newest) state().count_replaced();
    newest = std::move(frame);
  }
  state().count_bad(frames_.damaged() - damaged);
  if (!newest) return true;
  auto pixels = decode_image(newest->jpeg, address().text, expected_);
  if (!pixels) {
    state().count_bad();
    state().fail(pixels.error().message);
    return true;
  }
  const Stamp stamp = newest->stamp ? clocks_.map(*newest->stamp, arrived) : arrived - latency_;
  state().set_clock_steps(clocks_.steps());
  Image image{"", std::make_shared<const GreyImage>(*std::move(pixels)),
              std::make_shared<const std::string>(std::move(newest->jpeg))};
  give(Event(stamp, {0, device_}, std::move(image)), arrived, sink);
  return true;
}

}  // namespace waymark::live
