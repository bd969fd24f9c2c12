#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace waymark::bag {

/// The identities that one detector tells, as numbers, and a count of the observations whose identity cannot
/// be used. Memory grows with the number of different texts.
class Identities {
 public:
  /// A whole number from 0 to 2^31 - 1; nothing, and counted, for others: some detectors tell -1 of what they
  /// could not read.
  [[nodiscard]] std::optional<std::int32_t> of_number(double number);

  /// The number that a text ends in or has last: 12 of "12", "tag_12", "tag36h11:12" and "tag_12_left".
  /// Nothing, and counted, where there is none, where it is out of range or below 0, and for another text
  /// with the number of one before: two landmarks must not become one.
  [[nodiscard]] std::optional<std::int32_t> of_text(std::string_view text);

  [[nodiscard]] std::int64_t unusable() const { return unusable_; }
  /// The first that could not be used, in words.
  [[nodiscard]] const std::string& example() const { return example_; }

 private:
  std::optional<std::int32_t> refuse(std::string example);

  std::map<std::int32_t, std::string> texts_;  // by their number
  std::int64_t unusable_ = 0;
  std::string example_;
};

}  // namespace waymark::bag
