#include "workbench/study/axis.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "workbench/logs/text_lines.hpp"
#include "workbench/run/config.hpp"

namespace waymark::study {
namespace {

constexpr std::size_t kValuesMax = 100000;

/// "3..7" as (3, 7).
std::optional<std::pair<int, int>> parse_span(std::string_view text) {
  const std::size_t dots = text.find("..");
  if (dots == std::string_view::npos) return std::nullopt;
  const auto first = parse_integer(text.substr(0, dots));
  const auto last = parse_integer(text.substr(dots + 2));
  if (!first || !last) return std::nullopt;
  return std::pair(*first, *last);
}

Error bad_axis(std::string_view what) { return {fmt::format("--axis: {}", what)}; }

/// Adds what one part between commas stands for.
Result<void> add_values(std::string_view part, Axis& axis) {
  const auto span = parse_span(part);
  if (!span) {
    axis.values.emplace_back(part);
    return {};
  }
  const std::int64_t count = std::int64_t{span->second} - span->first + 1;
  if (count < 1) return bad_axis(fmt::format("{}: {} decreases; write it from low to high", axis.key, part));
  if (axis.values.size() + static_cast<std::size_t>(count) > kValuesMax)
    return bad_axis(fmt::format("{} has more than {} values", axis.key, kValuesMax));
  for (int value = span->first; value < span->second; ++value) axis.values.push_back(std::to_string(value));
  axis.values.push_back(std::to_string(span->second));
  return {};
}

Result<void> check(const Axis& axis) {
  Config config;
  Schema schema = describe(config);
  if (!schema.has(axis.key)) {
    const auto close = schema.close_keys(axis.key, 3);
    return bad_axis(close.empty()
                        ? fmt::format("unknown key {}; `waymark config --all` lists all keys", axis.key)
                        : fmt::format("unknown key {}; close keys: {}", axis.key, fmt::join(close, ", ")));
  }
  std::vector<std::string> sorted = axis.values;
  std::ranges::sort(sorted);
  if (const auto twice = std::ranges::adjacent_find(sorted); twice != sorted.end())
    return bad_axis(fmt::format("{} has the value {} twice", axis.key, *twice));
  for (const auto& value : axis.values)
    if (auto done = schema.set(axis.key, value, "--axis"); !done) return done;
  return {};
}

}  // namespace

Result<Axis> parse_axis(std::string_view text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos || equals == 0 || equals + 1 == text.size())
    return bad_axis(fmt::format("{} is not of the form KEY=VALUE,VALUE or KEY=FIRST..LAST", in_quotes(text)));
  Axis axis{std::string(text.substr(0, equals)), {}};
  for (std::string_view rest = text.substr(equals + 1); !rest.empty();)
    if (auto done = add_values(take_cell(rest), axis); !done) return done.error();
  if (auto done = check(axis); !done) return done.error();
  return axis;
}

}  // namespace waymark::study
