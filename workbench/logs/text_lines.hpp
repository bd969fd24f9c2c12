#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "waymark/core/result.hpp"

namespace waymark {

/// Walks through the lines of a text that have content: blank lines and those that begin with # are passed
/// over. Takes a byte-order mark, CR LF, and a last line without an end.
class TextLines {
 public:
  [[nodiscard]] static Result<TextLines> open(const std::filesystem::path& path);
  /// `name` stands for the file in errors.
  TextLines(std::string text, std::string name);

  /// Goes to the next line with content; false at the end.
  bool next();
  /// The line without blanks at its ends; valid as long as this object.
  [[nodiscard]] std::string_view line() const { return line_; }
  /// Counted from 1, with the lines that were passed over.
  [[nodiscard]] int number() const { return number_; }

  /// "name:17: what", and a hint where the file breaks off in this line.
  [[nodiscard]] Error error(std::string_view what) const;
  [[nodiscard]] const std::string& name() const { return name_; }

  [[nodiscard]] std::size_t bytes() const { return text_->size(); }
  [[nodiscard]] std::size_t bytes_read() const { return position_; }

 private:
  std::string name_;
  std::unique_ptr<const std::string>
      text_;  // on the heap, so that views into it stay valid when this is moved
  std::size_t position_ = 0;
  std::string_view line_;
  int number_ = 0;
  bool is_cut_ = false;
};

/// Takes the first word, ended by blanks, off the front of `rest`; empty when there is none.
[[nodiscard]] std::string_view take_word(std::string_view& rest);

/// Takes what stands before the first comma, without blanks at its ends, and the comma off the front of
/// `rest`.
[[nodiscard]] std::string_view take_cell(std::string_view& rest);

/// A number that fills the text; may be infinite or NaN.
[[nodiscard]] std::optional<double> parse_number(std::string_view text);
[[nodiscard]] std::optional<int> parse_integer(std::string_view text);

/// 'text' in quotes for an error: short, without control characters.
[[nodiscard]] std::string in_quotes(std::string_view text);

}  // namespace waymark
