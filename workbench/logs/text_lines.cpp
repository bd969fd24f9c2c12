#include "workbench/logs/text_lines.hpp"

#include <charconv>
#include <utility>

#include <fmt/format.h>

#include "workbench/logs/files.hpp"

namespace waymark {
namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

constexpr bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

std::string_view trim(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

template <class Number>
std::optional<Number> parse_whole(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return number;
}

}  // namespace

Result<TextLines> TextLines::open(const std::filesystem::path& path) {
  auto text = read_file(path);
  if (!text) return text.error();
  return TextLines(*std::move(text), path.string());
}

TextLines::TextLines(std::string text, std::string name)
    : name_(std::move(name)), text_(std::make_unique<const std::string>(std::move(text))) {
  if (text_->starts_with(kByteOrderMark)) position_ = kByteOrderMark.size();
}

bool TextLines::next() {
  while (position_ < text_->size()) {
    const std::size_t end = text_->find('\n', position_);
    is_cut_ = end == std::string::npos;
    line_ = trim(std::string_view(*text_).substr(position_, end - position_));
    position_ = is_cut_ ? text_->size() : end + 1;
    ++number_;
    if (!line_.empty() && line_.front() != '#') return true;
  }
  return false;
}

Error TextLines::error(std::string_view what) const {
  return {
      fmt::format("{}:{}: {}{}", name_, number_, what, is_cut_ ? " (the file is cut off in this line)" : "")};
}

std::string_view take_word(std::string_view& rest) {
  std::size_t begin = 0;
  while (begin < rest.size() && is_blank(rest[begin])) ++begin;
  std::size_t end = begin;
  while (end < rest.size() && !is_blank(rest[end])) ++end;
  const std::string_view word = rest.substr(begin, end - begin);
  rest.remove_prefix(end);
  return word;
}

std::string_view take_cell(std::string_view& rest) {
  const std::size_t comma = rest.find(',');
  const std::string_view cell = trim(rest.substr(0, comma));
  rest.remove_prefix(comma == std::string_view::npos ? rest.size() : comma + 1);
  return cell;
}

std::optional<double> parse_number(std::string_view text) { return parse_whole<double>(text); }
std::optional<int> parse_integer(std::string_view text) { return parse_whole<int>(text); }

std::string in_quotes(std::string_view text) {
  constexpr std::size_t kShown = 40;
  std::string shown = "'";
  for (const char c : text.substr(0, kShown)) shown += c >= ' ' && c <= '~' ? c : '?';
  return shown + (text.size() > kShown ? "...'" : "'");
}

}  // namespace waymark
