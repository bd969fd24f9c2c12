#include "workbench/bags/sqlite_file.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <sqlite3.h>

#include "workbench/bags/byte_stream.hpp"
#include "workbench/config/read_file.hpp"

namespace waymark::bag {
namespace {

namespace fs = std::filesystem;

// A row takes this much of a file at least: its place in the page, the sizes of row and head, a type per
// column.
constexpr std::uint64_t kMinRowBytes = 8;
// Of our queries for each row, sorting included, there are no more than eight times as many.
constexpr std::int64_t kStepsPerByte = 8;
constexpr std::int64_t kMinSteps = 1'000'000;
constexpr std::uint64_t kMinBytes = 100'000;

/// 0: there is none.
std::uint64_t size_of(fs::path path, const char* suffix) {
  path += suffix;
  std::error_code failed;
  const auto size = fs::file_size(path, failed);
  return failed ? 0 : size;
}

/// A path as part of a URI: bytes that mean something there are escaped.
std::string escaped(const std::string& path) {
  std::string uri;
  for (const char c : path)
    if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '/' || c == '.' || c == '_' || c == '-')
      uri += c;
    else
      uri += fmt::format("%{:02X}", static_cast<unsigned char>(c));
  return uri;
}

int count_down(void* budget) { return --static_cast<SqliteBudget*>(budget)->steps < 0 ? 1 : 0; }

/// https://www.sqlite.org/security.html, untrusted database files.
void refuse_foreign_code(sqlite3* database) {
  sqlite3_db_config(database, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  sqlite3_db_config(database, SQLITE_DBCONFIG_ENABLE_VIEW, 0, nullptr);
  sqlite3_db_config(database, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
  sqlite3_db_config(database, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  sqlite3_db_config(database, SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, 1, nullptr);
  sqlite3_drop_modules(database, nullptr);  // without which no virtual table works
}

/// With a write-ahead log beside it a database is read through an index of that log, which SQLite writes
/// beside both, unless it believes to be alone: then the index stays in memory.
constexpr const char* kAlone = "PRAGMA locking_mode=EXCLUSIVE";
constexpr const char* kWithoutLocks = "unix-none";

}  // namespace

void SqliteRows::Finish::operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }

SqliteRows::SqliteRows(sqlite3* database, const std::string& query, SqliteBudget* budget)
    : database_(database), budget_(budget) {
  sqlite3_stmt* statement = nullptr;
  has_begun_ = sqlite3_prepare_v2(database, query.c_str(), -1, &statement, nullptr) == SQLITE_OK;
  if (!has_begun_) problem_ = sqlite3_errmsg(database);
  statement_.reset(statement);
}

bool SqliteRows::next() {
  if (!statement_) return false;
  const int code = sqlite3_step(statement_.get());
  if (code == SQLITE_DONE) return end("");
  if (code == SQLITE_INTERRUPT) return end("its pages refer to more rows than it can hold");
  if (code != SQLITE_ROW) return end(sqlite3_errmsg(database_));
  const std::uint64_t bytes = row_bytes();
  if (bytes > budget_->bytes) return end("its rows are larger than the file");
  budget_->bytes -= bytes;
  return true;
}

bool SqliteRows::end(std::string problem) {
  problem_ = std::move(problem);
  statement_.reset();
  return false;
}

std::uint64_t SqliteRows::row_bytes() const {
  std::uint64_t sum = kMinRowBytes;
  for (int column = 0; column < sqlite3_data_count(statement_.get()); ++column)
    if (const int type = sqlite3_column_type(statement_.get(), column);
        type == SQLITE_BLOB || type == SQLITE_TEXT)
      sum += bytes(column).size();
  return sum;
}

std::int64_t SqliteRows::integer(int column) const { return sqlite3_column_int64(statement_.get(), column); }

/// Asking for the length makes UTF-8 of a text of UTF-16, and moves it: it has to be UTF-8 before.
std::string_view SqliteRows::bytes(int column) const {
  const void* data = sqlite3_column_type(statement_.get(), column) == SQLITE_BLOB
                         ? sqlite3_column_blob(statement_.get(), column)
                         : sqlite3_column_text(statement_.get(), column);
  const int size = sqlite3_column_bytes(statement_.get(), column);
  return data == nullptr ? std::string_view{}
                         : std::string_view(static_cast<const char*>(data), static_cast<std::size_t>(size));
}

void SqliteFile::Close::operator()(sqlite3* database) const { sqlite3_close_v2(database); }

SqliteFile::SqliteFile(sqlite3* database, std::uint64_t size)
    : budget_(std::make_unique<SqliteBudget>()), database_(database), size_(size) {
  refuse_foreign_code(database);
  // A value can be no longer than the file.
  sqlite3_limit(database, SQLITE_LIMIT_LENGTH,
                static_cast<int>(std::min<std::uint64_t>(kLargestPiece, std::max(size, kMinBytes))));
  sqlite3_progress_handler(database, 1000, count_down, budget_.get());
}

Result<SqliteFile> SqliteFile::open(const fs::path& path) {
  if (auto checked = check_is_file(path); !checked) return checked.error();
  std::error_code failed;
  const fs::path real = fs::canonical(path, failed);  // the log lies beside what a link leads to
  const std::uint64_t log = size_of(real, "-wal");
  sqlite3* database = nullptr;
  const std::string uri = "file://" + escaped(real.string()) + (log > 0 ? "" : "?immutable=1");
  const int status = sqlite3_open_v2(uri.c_str(), &database, SQLITE_OPEN_READONLY | SQLITE_OPEN_URI,
                                     log > 0 ? kWithoutLocks : nullptr);
  if (status != SQLITE_OK) {
    sqlite3_close_v2(database);
    return Error{fmt::format("{}: {}", path.string(), sqlite3_errstr(status))};
  }
  SqliteFile file(database, size_of(real, "") + log);
  if (log > 0) static_cast<void>(file.query(kAlone).next());
  if (size_of(real, "-journal") > 0)
    file.note_ =
        "its recorder was stopped while writing (there is a -journal beside it); what is in it is used";
  return file;
}

std::optional<std::string> SqliteFile::table_problem(std::string_view table) const {
  auto kind = query(fmt::format("SELECT type FROM sqlite_master WHERE name = '{}' COLLATE NOCASE", table));
  if (!kind.next()) return kind.problem().empty() ? fmt::format("it has no table {}", table) : kind.problem();
  if (kind.bytes(0) != "table") return fmt::format("{} is a {}, not a table", table, kind.bytes(0));
  constexpr int kHidden = 6;
  auto columns = query(fmt::format("PRAGMA table_xinfo({})", table));
  while (columns.next())
    if (columns.integer(kHidden) != 0) return fmt::format("table {} has computed columns", table);
  return columns.problem().empty() ? std::nullopt : std::optional(columns.problem());
}

SqliteRows SqliteFile::query(const std::string& sql) const {
  const auto size = static_cast<std::int64_t>(size_);
  // Texts of UTF-16 take up to one and a half times their place when they are read.
  *budget_ = {(kMinSteps + kStepsPerByte * size) / 1000, 2 * (kMinBytes + size_)};
  return {database_.get(), sql, budget_.get()};
}

}  // namespace waymark::bag
