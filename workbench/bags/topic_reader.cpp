#include "workbench/bags/topic_reader.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

namespace waymark::bag {

std::optional<Stamp> TopicReader::stamp() const {
  if (!has_header) return std::nullopt;
  constexpr std::uint32_t kNanosPerSecond = 1'000'000'000;
  const double whole_s = decoder.number(0);
  const std::uint32_t nanos = decoder.size(1);
  if (!(std::abs(whole_s) < 9e9) || nanos >= kNanosPerSecond || (whole_s == 0.0 && nanos == 0))
    return std::nullopt;
  return Stamp{std::chrono::seconds(static_cast<std::int64_t>(whole_s)) + Duration(nanos)};
}

std::vector<std::string> TopicReader::notes() const {
  std::vector<std::string> all = content_notes ? content_notes() : std::vector<std::string>{};
  if (!decoder.note().empty()) all.insert(all.begin(), decoder.note());
  return all;
}

std::vector<std::string> after_stamp(std::vector<std::string> numbers) {
  std::vector<std::string> all{"header.stamp.sec", "header.stamp.nanosec"};
  std::ranges::move(numbers, std::back_inserter(all));
  return all;
}

std::vector<std::string> below(std::string_view path, std::initializer_list<std::string_view> names) {
  std::vector<std::string> paths;
  for (const auto name : names) paths.push_back(fmt::format("{}.{}", path, name));
  return paths;
}

}  // namespace waymark::bag
