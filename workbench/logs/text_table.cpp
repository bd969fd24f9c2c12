#include "workbench/logs/text_table.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "waymark/core/names.hpp"

#include "workbench/logs/stamp_unit.hpp"

namespace waymark {
namespace {

constexpr std::size_t kNowhere = static_cast<std::size_t>(-1);

std::vector<std::string> split_names(std::string_view names) {
  std::vector<std::string> all;
  while (!names.empty()) all.emplace_back(take_cell(names));
  return all;
}

/// A whole number, also as programs write those of a column that has gaps: 3.0.
std::optional<int> parse_whole_number(std::string_view text) {
  if (const auto integer = parse_integer(text)) return integer;
  using Limits = std::numeric_limits<int>;
  const auto number = parse_number(text);
  if (!number || std::trunc(*number) != *number || *number < Limits::min() || *number > Limits::max())
    return std::nullopt;
  return static_cast<int>(*number);
}

/// What to do about a stamp that is too large for seconds.
std::string mend_of_stamp(std::string_view text) {
  const auto count = parse_number(text);
  const auto unit = count && std::isfinite(*count) ? unit_of_large_stamp(*count) : std::nullopt;
  if (!unit) return "";
  return fmt::format(": is it in {}? Divide the column by 1e{}", name_of(*unit), places_of(*unit));
}

}  // namespace

TextTable::TextTable(TextLines lines, const TableLayout& layout)
    : lines_(std::move(lines)),
      separator_(layout.separator),
      columns_(split_names(layout.columns)),
      in_file_(columns_) {}

Result<TextTable> TextTable::open(const std::filesystem::path& path, const TableLayout& layout) {
  auto lines = TextLines::open(path);
  if (!lines) return lines.error();
  return from(*std::move(lines), layout);
}

Result<TextTable> TextTable::from(TextLines lines, const TableLayout& layout) {
  TextTable table(std::move(lines), layout);
  if (layout.separator == TableLayout::Separator::kComma)
    if (auto done = table.read_header(layout); !done) return done.error();
  if (auto done = table.place_columns(layout); !done) return done.error();
  return table;
}

Result<void> TextTable::read_header(const TableLayout& layout) {
  if (!lines_.next())
    return Error{
        fmt::format("{}: the file is empty; its first line must be {}", lines_.name(), layout.columns)};
  in_file_ = split_names(lines_.line());
  for (auto name = in_file_.begin(); name != in_file_.end(); ++name) {
    if (std::ranges::find(columns_, *name) == columns_.end()) {
      const std::string guess = nearest_name(*name, columns_);
      return lines_.error(fmt::format("unknown column {}{}; the columns are {}", in_quotes(*name),
                                      guess.empty() ? "" : fmt::format(", did you mean {}?", guess),
                                      layout.columns));
    }
    if (std::find(in_file_.begin(), name, *name) != name)
      return lines_.error("column " + *name + " is listed twice");
  }
  return {};
}

Result<void> TextTable::place_columns(const TableLayout& layout) {
  const auto may_lack = split_names(layout.may_lack);
  for (const auto& column : columns_) {
    const auto found = std::ranges::find(in_file_, column);
    place_.push_back(found == in_file_.end() ? kNowhere : static_cast<std::size_t>(found - in_file_.begin()));
    if (place_.back() == kNowhere && std::ranges::find(may_lack, column) == may_lack.end())
      return lines_.error(fmt::format("column {} is missing; the columns are {}", column, layout.columns));
  }
  return {};
}

bool TextTable::next() {
  if (error_ || !lines_.next()) return false;
  split();
  if (cells_.size() == in_file_.size()) return true;
  fail(fmt::format("expected {} columns ({}), found {}", in_file_.size(), fmt::join(in_file_, ","),
                   cells_.size()));
  return false;
}

void TextTable::split() {
  cells_.clear();
  std::string_view rest = lines_.line();
  if (separator_ == TableLayout::Separator::kBlank) {
    while (!rest.empty()) cells_.push_back(take_word(rest));
    return;
  }
  cells_.push_back(take_cell(rest));
  while (!rest.empty()) cells_.push_back(take_cell(rest));
  if (lines_.line().back() == ',') cells_.emplace_back();
}

std::string_view TextTable::text(std::size_t column) const {
  return place_[column] == kNowhere ? std::string_view{} : cells_[place_[column]];
}

double TextTable::number(std::size_t column) {
  const auto value = parse_number(text(column));
  if (value && std::isfinite(*value)) return *value;
  fail_cell(column, value ? "a finite number" : "a number");
  return 0.0;
}

int TextTable::integer(std::size_t column) {
  const auto value = parse_whole_number(text(column));
  if (!value) fail_cell(column, "a whole number");
  return value.value_or(0);
}

Stamp TextTable::stamp(std::size_t column) {
  const auto value = parse_stamp(text(column));
  if (const auto mend = value ? std::string() : mend_of_stamp(text(column)); !mend.empty())
    fail(fmt::format("{} is not a number of seconds in column {}{}", in_quotes(text(column)),
                     columns_[column], mend));
  else if (!value)
    fail_cell(column, "a number of seconds");
  return value.value_or(Stamp{});
}

Stamp TextTable::ordered_stamp(std::size_t column) {
  const Stamp now = stamp(column);
  if (last_stamp_ && now < *last_stamp_)
    fail(fmt::format("stamp {} is before {} in line {}; rows must be sorted by time", to_string(now),
                     to_string(*last_stamp_), last_stamp_line_));
  last_stamp_ = now;
  last_stamp_line_ = lines_.number();
  return now;
}

void TextTable::fail(std::string_view what) {
  if (!error_) error_ = lines_.error(what);
}

void TextTable::fail_cell(std::size_t column, std::string_view expected) {
  if (is_empty(column))
    return fail(fmt::format("column {} is empty; it needs {}", columns_[column], expected));
  fail(fmt::format("{} is not {} in column {}", in_quotes(text(column)), expected, columns_[column]));
}

}  // namespace waymark
