#include "workbench/datasets/rounded_stamps.hpp"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "waymark/core/stamp.hpp"

namespace waymark {
namespace {

constexpr Duration kSecond = std::chrono::seconds(1);

struct Row {
  int line = 0;
  std::string_view cells;  ///< all but the stamp
};

struct Second {
  Stamp stamp;
  std::vector<Row> rows;
};

Result<Stamp> whole_second(const TextLines& lines, std::string_view cell) {
  const auto stamp = parse_stamp(cell);
  if (stamp && stamp->since_epoch % kSecond == Duration{0}) return *stamp;
  return lines.error(fmt::format("{} is not a whole number of seconds", in_quotes(cell)));
}

Result<std::vector<Second>> read_seconds(TextLines& lines) {
  std::vector<Second> seconds;
  for (bool is_first = true; lines.next(); is_first = false) {
    std::string_view cells = lines.line();
    const std::string_view first_cell = take_cell(cells);
    if (is_first && !parse_stamp(first_cell)) continue;  // the header
    const auto stamp = whole_second(lines, first_cell);
    if (!stamp) return stamp.error();
    if (!seconds.empty() && *stamp < seconds.back().stamp)
      return lines.error("goes back in time; rows must be sorted by time");
    if (seconds.empty() || *stamp != seconds.back().stamp) seconds.push_back({*stamp, {}});
    seconds.back().rows.push_back({lines.number(), cells});
  }
  return seconds;
}

/// The row after as many empty lines as bring it to the number that it has in its file, which errors name.
void write_row(Stamp stamp, const Row& row, int& lines_written, std::string& text) {
  text.append(static_cast<std::size_t>(row.line - 1 - lines_written), '\n');
  text += to_string(stamp) + ' ';
  std::ranges::replace_copy(row.cells, std::back_inserter(text), ',', ' ');
  text += '\n';
  lines_written = row.line;
}

}  // namespace

Result<TextLines> spread_rounded_stamps(TextLines lines) {
  const auto seconds = read_seconds(lines);
  if (!seconds) return seconds.error();
  std::string text;
  int lines_written = 0;
  for (std::size_t s = 1; s + 1 < seconds->size(); ++s) {
    const auto& [stamp, rows] = (*seconds)[s];
    const auto count = static_cast<Duration::rep>(rows.size());
    for (Duration::rep i = 0; i < count; ++i)
      write_row(stamp - kSecond / 2 + i * kSecond / count, rows[static_cast<std::size_t>(i)], lines_written,
                text);
  }
  return TextLines(std::move(text), lines.name());
}

}  // namespace waymark
