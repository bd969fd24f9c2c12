#include "waymark/io/bag/sqlite_bag.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sqlite3.h>

#include "waymark/io/bag/byte_reader.hpp"
#include "waymark/io/bag/byte_stream.hpp"

namespace waymark::bag {
namespace {

struct CloseDatabase {
  void operator()(sqlite3* database) const { sqlite3_close(database); }
};
struct FinishStatement {
  void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
};
using Database = std::unique_ptr<sqlite3, CloseDatabase>;
using Statement = std::unique_ptr<sqlite3_stmt, FinishStatement>;

/// Null where the database has no such tables or columns, or cannot be read.
Statement prepare(const Database& database, const std::string& query) {
  sqlite3_stmt* statement = nullptr;
  sqlite3_prepare_v2(database.get(), query.c_str(), -1, &statement, nullptr);
  return Statement(statement);
}

bool step(const Statement& statement) { return statement && sqlite3_step(statement.get()) == SQLITE_ROW; }

std::int64_t integer(const Statement& row, int column) { return sqlite3_column_int64(row.get(), column); }

std::string_view bytes(const Statement& row, int column) {
  const void* data = sqlite3_column_blob(row.get(), column);
  const int size = sqlite3_column_bytes(row.get(), column);
  return data == nullptr ? std::string_view{}
                         : std::string_view(static_cast<const char*>(data), static_cast<std::size_t>(size));
}

/// What a Stamp can not hold with room to spare is nonsense and becomes 0.
Stamp stamp_of(std::int64_t nanos) {
  constexpr std::int64_t kLatest = 4'300'000'000'000'000'000;
  return Stamp{Duration(nanos >= 0 && nanos <= kLatest ? nanos : 0)};
}

/// SQLite passes over missing pages that it does not happen to look into. The head of the file says how many
/// there should be; nothing where they are all there.
std::optional<std::string> missing_bytes(const std::filesystem::path& path) {
  std::string head(32, '\0');
  const auto file = InputFile::open(path);
  if (!file || !(*file)->read(0, head)) return std::nullopt;
  const auto page = load<std::uint16_t>(head.data() + 16, std::endian::big);
  const std::uint64_t expected =
      (page == 1 ? 65536U : page) * std::uint64_t{load<std::uint32_t>(head.data() + 28, std::endian::big)};
  if ((*file)->size() >= expected) return std::nullopt;
  return fmt::format("{}: damaged or cut off: {} of {} bytes are there; what can be found in them is used",
                     path.filename().string(), (*file)->size(), expected);
}

class SqliteBag final : public Reader {
 public:
  SqliteBag(const std::filesystem::path& path, Database database)
      : name_(path.filename().string()), database_(std::move(database)) {
    if (auto note = missing_bytes(path)) notes_.push_back(*std::move(note));
  }

  /// False: no bag.
  bool look_through() {
    summary_.format = "ROS 2 bag";
    if (!read_topics()) return false;
    const auto counts = prepare(
        database_,
        "SELECT topic_id, COUNT(*), MIN(timestamp), MAX(timestamp), MAX(id) FROM messages GROUP BY topic_id");
    if (!counts) return false;
    while (step(counts)) {
      last_row_ = std::max(last_row_, integer(counts, 4));
      const auto place = places_.find(integer(counts, 0));
      if (place == places_.end()) continue;
      summary_.topics[place->second].messages = integer(counts, 1);
      for (const int column : {2, 3}) include(summary_, stamp_of(integer(counts, column)));
    }
    note_damage(counts);
    rewind(std::vector<bool>(summary_.topics.size(), true));
    return true;
  }

  [[nodiscard]] const Summary& summary() const override { return summary_; }

  /// In the order of the rows, which is that of recording: that of the times would need an index, or memory.
  void rewind(std::vector<bool> wanted) override {
    std::vector<std::int64_t> ids;
    for (const auto& [id, place] : places_)
      if (place < wanted.size() && wanted[place]) ids.push_back(id);
    row_ = 0;
    messages_ = prepare(
        database_, fmt::format("SELECT topic_id, timestamp, data, id FROM messages WHERE topic_id IN ({}) "
                               "ORDER BY id",
                               fmt::join(ids, ",")));
  }

  [[nodiscard]] std::optional<Message> next() override {
    if (!step(messages_)) {
      note_damage(messages_);
      messages_.reset();
      return std::nullopt;
    }
    row_ = integer(messages_, 3);
    return Message{places_.at(integer(messages_, 0)), stamp_of(integer(messages_, 1)), bytes(messages_, 2)};
  }

  [[nodiscard]] std::vector<std::string> notes() const override { return notes_; }

  [[nodiscard]] double progress() const override {
    return last_row_ <= 0 ? 1.0 : static_cast<double>(row_) / static_cast<double>(last_row_);
  }

 private:
  bool read_topics() {
    const auto definitions = read_definitions();
    const auto topics =
        prepare(database_, "SELECT id, name, type, serialization_format FROM topics ORDER BY id");
    if (!topics) return false;
    while (step(topics)) {
      Topic topic{.name = std::string(bytes(topics, 1)),
                  .type = plain_type(bytes(topics, 2)),
                  .encoding = bytes(topics, 3) == "cdr" ? Encoding::kCdr : Encoding::kOther,
                  .definition = {}};
      if (const auto known = definitions.find(topic.type); known != definitions.end())
        topic.definition = known->second;
      places_[integer(topics, 0)] = place_topic(summary_.topics, std::move(topic));
    }
    return true;
  }

  /// By type; older bags have none.
  [[nodiscard]] std::map<std::string, std::string> read_definitions() const {
    std::map<std::string, std::string> definitions;
    const auto rows = prepare(
        database_,
        "SELECT topic_type, encoded_message_definition FROM message_definitions WHERE encoding = 'ros2msg'");
    while (step(rows)) definitions[plain_type(bytes(rows, 0))] = bytes(rows, 1);
    return definitions;
  }

  /// Why a query ended before its last row, if it did.
  void note_damage(const Statement& statement) {
    const int code = sqlite3_errcode(database_.get());
    if (statement && code != SQLITE_DONE && code != SQLITE_OK && code != SQLITE_ROW)
      add_note(notes_, fmt::format("{}: damaged or cut off behind message {} ({}); what comes before is used",
                                   name_, row_, sqlite3_errmsg(database_.get())));
  }

  std::string name_;
  Database database_;
  Statement messages_;
  Summary summary_;
  std::map<std::int64_t, std::size_t> places_;  // of topic ids among the summary's topics
  std::vector<std::string> notes_;
  std::int64_t row_ = 0;
  std::int64_t last_row_ = 0;
};

}  // namespace

bool is_sqlite(std::string_view first_bytes) { return first_bytes.starts_with("SQLite format 3"); }

Result<std::unique_ptr<Reader>> open_sqlite_bag(const std::filesystem::path& path) {
  sqlite3* raw = nullptr;
  const int status = sqlite3_open_v2(path.c_str(), &raw, SQLITE_OPEN_READONLY, nullptr);
  Database database(raw);
  if (status != SQLITE_OK) return Error{fmt::format("{}: {}", path.string(), sqlite3_errstr(status))};
  sqlite3_limit(raw, SQLITE_LIMIT_LENGTH, static_cast<int>(kLargestPiece));
  sqlite3_db_config(raw, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  auto bag = std::make_unique<SqliteBag>(path, std::move(database));
  if (!bag->look_through())
    return Error{fmt::format("{}: no ROS 2 bag, or a damaged one: {}", path.string(), sqlite3_errmsg(raw))};
  return std::unique_ptr<Reader>(std::move(bag));
}

}  // namespace waymark::bag
