#include "workbench/live/mjpeg_splitter.hpp"

#include <algorithm>
#include <cctype>

namespace waymark::live {
namespace {

constexpr std::string_view kStart("\xff\xd8\xff", 3);
constexpr std::size_t kHeader = 4096;  // of the text between images that is kept

std::uint8_t byte(std::string_view bytes, std::size_t at) { return static_cast<std::uint8_t>(bytes[at]); }

bool is_restart(std::uint8_t marker) { return marker >= 0xd0 && marker <= 0xd7; }

/// The number behind the last "X-Timestamp:" of a part's header, in seconds.
std::optional<Duration> stamp_in(std::string_view text) {
  constexpr std::string_view kName = "x-timestamp:";
  const auto same = [](char a, char b) { return std::tolower(static_cast<unsigned char>(a)) == b; };
  const auto found = std::find_end(text.begin(), text.end(), kName.begin(), kName.end(), same);
  if (found == text.end()) return std::nullopt;
  std::string_view number = text.substr(static_cast<std::size_t>(found - text.begin()) + kName.size());
  number = number.substr(0, number.find_first_of("\r\n"));
  number.remove_prefix(std::min(number.find_first_not_of(' '), number.size()));
  const auto stamp = parse_stamp(number);
  return stamp ? std::optional(stamp->since_epoch) : std::nullopt;
}

}  // namespace

std::optional<MjpegSplitter::Frame> MjpegSplitter::next() {
  while (find_start()) {
    const auto end = find_end();
    if (!end) {
      if (started_ && bytes_.size() <= kLargest) return std::nullopt;
      if (started_) give_up_image();
      continue;
    }
    Frame frame{bytes_.substr(0, *end), stamp_};
    bytes_.erase(0, *end);
    started_ = false;
    stamp_.reset();
    return frame;
  }
  return std::nullopt;
}

/// Puts the start of an image to the front.
bool MjpegSplitter::find_start() {
  if (started_) return true;
  const std::size_t at = bytes_.find(kStart);
  const std::string_view before = std::string_view(bytes_).substr(0, at);
  if (const auto stamp = stamp_in(before)) stamp_ = stamp;
  if (at == std::string::npos) {
    if (bytes_.size() > kHeader) bytes_.erase(0, bytes_.size() - kHeader);
    return false;
  }
  bytes_.erase(0, at);
  position_ = 2;
  in_scan_ = false;
  return started_ = true;
}

void MjpegSplitter::give_up_image() {
  ++damaged_;
  bytes_.erase(0, std::max<std::size_t>(position_, 2));
  started_ = false;
  stamp_.reset();
}

/// Walks over segments. Nothing: more has to come, or, not `started_` any more, the image is damaged.
std::optional<std::size_t> MjpegSplitter::find_end() {
  for (;;) {
    if (in_scan_) {
      position_ = std::min(bytes_.find('\xff', position_), bytes_.size());
      if (position_ + 1 >= bytes_.size()) return std::nullopt;
      const std::uint8_t next = byte(bytes_, position_ + 1);
      if (next == 0x00 || is_restart(next)) {
        position_ += 2;
        continue;
      }
      in_scan_ = false;
    }
    if (position_ + 1 >= bytes_.size()) return std::nullopt;
    const std::uint8_t marker = byte(bytes_, position_ + 1);
    if (byte(bytes_, position_) != 0xff || marker == 0xd8) {
      give_up_image();
      return std::nullopt;
    }
    if (marker == 0xd9) return position_ + 2;
    if (marker == 0xff) {  // a fill byte
      ++position_;
      continue;
    }
    if (position_ + 3 >= bytes_.size()) return std::nullopt;
    const std::size_t length = 256U * byte(bytes_, position_ + 2) + byte(bytes_, position_ + 3);
    if (length < 2 || position_ + 2 + length > bytes_.size()) {
      if (length >= 2) return std::nullopt;
      give_up_image();
      return std::nullopt;
    }
    position_ += 2 + length;
    in_scan_ = marker == 0xda;
  }
}

void MjpegSplitter::forget() {
  damaged_ += started_ ? 1 : 0;
  bytes_.clear();
  started_ = false;
  stamp_.reset();
}

}  // namespace waymark::live
