#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "waymark/core/result.hpp"

struct sqlite3;
struct sqlite3_stmt;

namespace waymark::bag {

/// How much work a query may still make.
struct SqliteBudget {
  std::int64_t steps = 0;  ///< of SQLite's virtual machine, in thousands
  std::uint64_t bytes = 0;
};

/// The rows that a query gives, one after the other.
class SqliteRows {
 public:
  /// No rows.
  SqliteRows() = default;

  /// Goes to the next row; false: there is no further one, or what follows cannot be read.
  [[nodiscard]] bool next();
  /// False: the query does not fit the database, for the reason that problem() gives.
  [[nodiscard]] bool has_begun() const { return has_begun_; }
  /// Why the rows ended before the last one; empty: they did not.
  [[nodiscard]] const std::string& problem() const { return problem_; }

  /// Of the row, valid until the next one.
  [[nodiscard]] std::int64_t integer(int column) const;
  [[nodiscard]] std::string_view bytes(int column) const;

 private:
  friend class SqliteFile;
  struct Finish {
    void operator()(sqlite3_stmt* statement) const;
  };

  SqliteRows(sqlite3* database, const std::string& query, SqliteBudget* budget);
  [[nodiscard]] bool end(std::string problem);
  [[nodiscard]] std::uint64_t row_bytes() const;

  sqlite3* database_ = nullptr;
  std::unique_ptr<sqlite3_stmt, Finish> statement_;
  SqliteBudget* budget_ = nullptr;
  bool has_begun_ = false;
  std::string problem_;
};

/// A database of SQLite that a stranger made, as data. None of the SQL in it is run (views, triggers, virtual
/// tables, columns that are computed), nothing is written, not beside it either, so that it may lie on a
/// medium that is read-only; and what a query may cost and give is bounded by the size of the file, whatever
/// its pages say.
class SqliteFile {
 public:
  [[nodiscard]] static Result<SqliteFile> open(const std::filesystem::path& path);

  /// Why a table cannot be read as data: it is missing, or something else; nothing where it can.
  [[nodiscard]] std::optional<std::string> table_problem(std::string_view table) const;

  /// One at a time: a query ends the budget of the one before. The rows must not outlive the file.
  [[nodiscard]] SqliteRows query(const std::string& sql) const;

  /// What its state on disk says against it, one sentence.
  [[nodiscard]] std::optional<std::string> note() const { return note_; }

 private:
  struct Close {
    void operator()(sqlite3* database) const;
  };

  SqliteFile(sqlite3* database, std::uint64_t size);

  std::unique_ptr<SqliteBudget> budget_;  // outlives the database, which counts in it
  std::unique_ptr<sqlite3, Close> database_;
  std::uint64_t size_;  // with the log beside it
  std::optional<std::string> note_;
};

}  // namespace waymark::bag
