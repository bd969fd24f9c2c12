#include "workbench/live/arcos.hpp"

#include <numbers>

#include "waymark/core/angle.hpp"

namespace waymark::live {
namespace {

constexpr std::string_view kHeader("\xfa\xfb", 2);
constexpr std::size_t kLongestData = 205;  // of 207 bytes with the checksum
constexpr int kWrap = 4096;  // of x and y on the oldest controllers; newer ones wrap at multiples of it
constexpr Duration kAnswer = std::chrono::milliseconds(500);
constexpr Duration kPulse = std::chrono::seconds(1);

std::uint8_t byte(std::string_view bytes, std::size_t at) { return static_cast<std::uint8_t>(bytes[at]); }

std::uint16_t checksum(std::string_view data) {
  std::uint16_t sum = 0;
  for (std::size_t i = 0; i + 1 < data.size(); i += 2)
    sum = static_cast<std::uint16_t>(sum + 256U * byte(data, i) + byte(data, i + 1));
  if (data.size() % 2 == 1) sum ^= byte(data, data.size() - 1);
  return sum;
}

std::uint16_t word(std::string_view data, std::size_t at) {
  return static_cast<std::uint16_t>(byte(data, at) + 256U * byte(data, at + 1));
}

int wrapped_difference(std::uint16_t now, std::uint16_t before) {
  const int forward = (static_cast<int>(now) - static_cast<int>(before) + 16 * kWrap) % kWrap;
  return forward < kWrap / 2 ? forward : forward - kWrap;
}

}  // namespace

std::string arcos_packet(std::string_view data) {
  const std::uint16_t sum = checksum(data);
  std::string packet(kHeader);
  packet += static_cast<char>(data.size() + 2);
  packet += data;
  packet += static_cast<char>(sum >> 8U);
  packet += static_cast<char>(sum & 0xffU);
  return packet;
}

std::string arcos_command(ArcosCommand command) {
  return arcos_packet(std::string(1, static_cast<char>(command)));
}

std::optional<std::string> ArcosSplitter::next() {
  for (;;) {
    const std::size_t at = bytes_.find(kHeader);
    if (at == std::string::npos) {  // the first byte of a header may be the last
      bytes_.erase(0, bytes_.empty() || bytes_.back() != kHeader[0] ? bytes_.size() : bytes_.size() - 1);
      return std::nullopt;
    }
    bytes_.erase(0, at);
    if (bytes_.size() < 3) return std::nullopt;
    const std::size_t count = byte(bytes_, 2);
    if (count >= 3 && count <= kLongestData + 2) {
      if (bytes_.size() < 3 + count) return std::nullopt;
      const std::string data = bytes_.substr(3, count - 2);
      const auto sum = static_cast<std::uint16_t>(256U * byte(bytes_, count + 1) + byte(bytes_, count + 2));
      if (sum == checksum(data)) {
        bytes_.erase(0, 3 + count);
        return data;
      }
    }
    ++damaged_;
    bytes_.erase(0, kHeader.size());
  }
}

std::optional<OdometryPose> ArcosOdometry::add(std::string_view data) {
  if (data.size() < 7 || (byte(data, 0) != 0x32 && byte(data, 0) != 0x33)) return std::nullopt;
  const Raw raw{word(data, 1), word(data, 3)};
  if (last_) {
    x_m_ += unit_m_ * wrapped_difference(raw.x, last_->x);
    y_m_ += unit_m_ * wrapped_difference(raw.y, last_->y);
  }
  last_ = raw;
  const auto heading = static_cast<std::int16_t>(word(data, 5));
  return OdometryPose{{x_m_, y_m_, wrap_angle(heading * 2.0 * std::numbers::pi / 4096.0)}};
}

void ArcosHandshake::heard(std::string_view data) {
  if (data.empty()) return;
  if (echoed_ < kSyncs && said_ > echoed_ && byte(data, 0) == echoed_) ++echoed_;
}

std::string ArcosHandshake::next(Stamp now) {
  const bool is_due = !last_ || now - *last_ >= (is_open() ? kPulse : kAnswer);
  if (is_open()) {
    if (!is_due) return "";
    last_ = now;
    return arcos_command(ArcosCommand::kPulse);
  }
  if (said_ > echoed_ && !is_due) return "";
  if (said_ > echoed_) said_ = echoed_ = 0;  // nobody answers: from the beginning
  last_ = now;
  if (echoed_ == kSyncs) {
    said_ = kSyncs + 1;
    return arcos_command(ArcosCommand::kOpen);
  }
  said_ = echoed_ + 1;
  return arcos_packet(std::string(1, static_cast<char>(echoed_)));
}

}  // namespace waymark::live
