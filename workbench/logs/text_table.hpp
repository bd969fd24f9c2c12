#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "waymark/core/result.hpp"
#include "waymark/core/stamp.hpp"

#include "workbench/logs/text_lines.hpp"

namespace waymark {

/// What a table looks like.
struct TableLayout {
  enum class Separator {
    kComma,  ///< the first line names the columns, in any order
    kBlank,  ///< no header, all columns in this order
  };

  std::string columns;  ///< "stamp_s,left_rad,right_rad": cells are asked for by their place in here
  Separator separator = Separator::kComma;
  std::string may_lack;  ///< columns that a header need not name; their cells read as empty
};

/// Reads a table of text row by row. The first thing wrong becomes `error()` and ends the reading, so that a
/// row may be read cell by cell and judged once:
///
///     while (table.next()) {
///       const Stamp stamp = table.ordered_stamp(0);
///       const double range_m = table.number(2);
///       if (table.error()) break;
///     }
///
/// About 0.1 us per cell. Cells are not quoted: they hold no comma.
class TextTable {
 public:
  [[nodiscard]] static Result<TextTable> open(const std::filesystem::path& path, const TableLayout& layout);
  [[nodiscard]] static Result<TextTable> from(TextLines lines, const TableLayout& layout);

  /// Goes to the next row; false at the end or when something is wrong.
  bool next();

  [[nodiscard]] bool is_empty(std::size_t column) const { return text(column).empty(); }
  [[nodiscard]] std::string_view text(std::size_t column) const;
  /// A finite number.
  [[nodiscard]] double number(std::size_t column);
  [[nodiscard]] int integer(std::size_t column);
  [[nodiscard]] Stamp stamp(std::size_t column);
  /// A stamp that is not before that of the row above.
  [[nodiscard]] Stamp ordered_stamp(std::size_t column);

  /// Refuses this row.
  void fail(std::string_view what);
  [[nodiscard]] const std::optional<Error>& error() const { return error_; }

  [[nodiscard]] const TextLines& lines() const { return lines_; }

 private:
  TextTable(TextLines lines, const TableLayout& layout);
  [[nodiscard]] Result<void> read_header(const TableLayout& layout);
  [[nodiscard]] Result<void> place_columns(const TableLayout& layout);
  void split();
  void fail_cell(std::size_t column, std::string_view expected);

  TextLines lines_;
  TableLayout::Separator separator_;
  std::vector<std::string> columns_;  // as the layout counts them
  std::vector<std::string> in_file_;  // as the file has them
  std::vector<std::size_t> place_;    // of a column of the layout among the cells
  std::vector<std::string_view> cells_;
  std::optional<Error> error_;
  std::optional<Stamp> last_stamp_;
  int last_stamp_line_ = 0;
};

}  // namespace waymark
