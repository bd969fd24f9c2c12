#include "workbench/bags/identities.hpp"

#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "workbench/logs/text_lines.hpp"

namespace waymark::bag {
namespace {

constexpr std::string_view kDigits = "0123456789";

std::optional<std::int32_t> identity_of(double number) {
  constexpr double kLargest = std::numeric_limits<std::int32_t>::max();
  const bool is_one = number >= 0.0 && number <= kLargest && number == std::floor(number);
  return is_one ? std::optional(static_cast<std::int32_t>(number)) : std::nullopt;
}

/// Nothing where it is larger than an identity can be, or no number.
std::optional<std::int32_t> identity_in(std::string_view digits) {
  std::int32_t number = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  return error == std::errc{} ? std::optional(number) : std::nullopt;
}

std::string_view last_digits(std::string_view text) {
  const std::size_t last = text.find_last_of(kDigits);
  if (last == std::string_view::npos) return {};
  text = text.substr(0, last + 1);
  return text.substr(text.find_last_not_of(kDigits) + 1);  // npos + 1 is 0
}

}  // namespace

std::optional<std::int32_t> Identities::of_number(double number) {
  const auto identity = identity_of(number);
  return identity ? identity : refuse(std::isnan(number) ? "none" : fmt::format("{}", number));
}

std::optional<std::int32_t> Identities::of_text(std::string_view text) {
  const auto number = parse_number(text);
  const auto identity = number ? identity_of(*number) : identity_in(last_digits(text));
  if (!identity) return refuse(in_quotes(text));
  const auto [first, is_new] = texts_.try_emplace(*identity, text);
  if (is_new || first->second == text) return identity;
  return refuse(fmt::format("{}, whose number is that of {}", in_quotes(text), in_quotes(first->second)));
}

std::optional<std::int32_t> Identities::refuse(std::string example) {
  if (unusable_++ == 0) example_ = std::move(example);
  return std::nullopt;
}

}  // namespace waymark::bag
