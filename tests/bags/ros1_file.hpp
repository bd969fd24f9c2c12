#pragma once

#include <cmath>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>

#include "bags/wire.hpp"

namespace waymark::bag::test {

/// A ROS 1 bag without chunks and index, as an interrupted recorder may leave it.
class Ros1File {
 public:
  Ros1File() { record({{"op", "\x03"}, {"index_pos", std::string(8, '\0')}}, ""); }

  /// A topic of a type with the standard definition; its number.
  std::uint32_t topic(const std::string& name, const std::string& type) {
    const std::string number = raw(topics_);
    record({{"op", "\x07"}, {"conn", number}, {"topic", name}},
           fields({{"topic", name}, {"type", type}, {"md5sum", "*"}, {"message_definition", ""}}));
    return topics_++;
  }

  void add(std::uint32_t topic, double recorded_s, const std::string& message) {
    const auto nanos = std::llround(recorded_s * 1e9);
    const auto seconds = static_cast<std::uint32_t>(nanos / 1'000'000'000);
    record({{"op", "\x02"},
            {"conn", raw(topic)},
            {"time", raw(seconds) + raw(static_cast<std::uint32_t>(nanos % 1'000'000'000))}},
           message);
  }

  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  using Fields = std::initializer_list<std::pair<std::string, std::string>>;

  static std::string raw(std::uint32_t number) { return Wire(Encoding::kRos1).add(number).bytes(); }
  static std::string fields(const Fields& all) {
    Wire wire(Encoding::kRos1);
    for (const auto& [name, value] : all) wire.text(std::string(name).append("=").append(value));
    return wire.bytes();
  }
  void record(const Fields& head, const std::string& data) {
    bytes_ += Wire(Encoding::kRos1).text(fields(head)).text(data).bytes();
  }

  std::string bytes_ = "#ROSBAG V2.0\n";
  std::uint32_t topics_ = 0;
};

}  // namespace waymark::bag::test
