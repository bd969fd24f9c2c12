#include "workbench/calibrate/name_groups.hpp"

#include <algorithm>
#include <cctype>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace waymark::calibrate {
namespace {

constexpr std::size_t kMaxRanges = 4;

/// What stands before and after the parts in which names differ.
struct Pattern {
  std::string before;
  std::string after;

  [[nodiscard]] bool matches(const std::string& name) const {
    return name.size() >= before.size() + after.size() && name.starts_with(before) && name.ends_with(after);
  }
};

std::string common_start(const std::vector<std::string>& names) {
  std::string start = names.front();
  for (const std::string& name : names) start.erase(std::ranges::mismatch(start, name).in1, start.end());
  return start;
}

Pattern common_pattern(std::vector<std::string> names) {
  Pattern pattern{.before = common_start(names), .after = {}};
  for (std::string& name : names) {
    name.erase(0, pattern.before.size());
    std::ranges::reverse(name);
  }
  pattern.after = common_start(names);
  std::ranges::reverse(pattern.after);
  return pattern;
}

/// Is there a letter in it, the extension aside?
bool has_word(const Pattern& pattern) {
  const auto dot = pattern.after.rfind('.');
  const std::string text = pattern.before + (dot == std::string::npos ? "" : pattern.after.substr(0, dot));
  return std::ranges::any_of(text, [](unsigned char c) { return std::isalpha(c) != 0; });
}

/// Nothing where others match it, or where it has no word, as for frames that are named by their times.
std::optional<Pattern> own_pattern(const std::vector<std::string>& names,
                                   const std::vector<bool>& is_member) {
  std::vector<std::string> own;
  for (std::size_t i = 0; i < names.size(); ++i)
    if (is_member[i]) own.push_back(names[i]);
  if (own.size() < 2) return std::nullopt;
  const Pattern pattern = common_pattern(std::move(own));
  for (std::size_t i = 0; i < names.size(); ++i)
    if (!is_member[i] && pattern.matches(names[i])) return std::nullopt;
  return has_word(pattern) ? std::optional(pattern) : std::nullopt;
}

std::vector<std::string> ranges_of(const std::vector<std::string>& names,
                                   const std::vector<bool>& is_member) {
  std::vector<std::string> ranges;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!is_member[i]) continue;
    std::size_t last = i;
    while (last + 1 < names.size() && is_member[last + 1]) ++last;
    ranges.push_back(last == i ? names[i] : fmt::format("{} to {}", names[i], names[last]));
    i = last;
  }
  return ranges;
}

}  // namespace

std::string describe_members(const std::vector<std::string>& names, const std::vector<bool>& is_member) {
  const auto pattern = own_pattern(names, is_member);
  if (pattern) return pattern->before + "*" + pattern->after;
  auto ranges = ranges_of(names, is_member);
  if (ranges.size() <= kMaxRanges) return fmt::format("{}", fmt::join(ranges, ", "));
  ranges.resize(kMaxRanges);
  return fmt::format("{}, ...", fmt::join(ranges, ", "));
}

}  // namespace waymark::calibrate
