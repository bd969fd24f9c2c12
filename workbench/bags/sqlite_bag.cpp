#include "workbench/bags/sqlite_bag.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "workbench/bags/byte_reader.hpp"
#include "workbench/bags/byte_stream.hpp"
#include "workbench/bags/sqlite_file.hpp"

namespace waymark::bag {
namespace {

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
  return fmt::format("{}: damaged or cut off: only {} of {} bytes exist; what can be read of them is used",
                     path.filename().string(), (*file)->size(), expected);
}

class SqliteBag final : public Reader {
 public:
  SqliteBag(const std::filesystem::path& path, SqliteFile file)
      : name_(path.filename().string()), file_(std::move(file)) {
    if (auto note = missing_bytes(path)) notes_.push_back(*std::move(note));
    if (const auto note = file_.note()) notes_.push_back(name_ + ": " + *note);
  }

  /// What makes it no bag, if anything.
  std::optional<std::string> look_through() {
    summary_.format = "ROS 2 bag";
    for (const char* table : {"topics", "messages"})
      if (auto problem = file_.table_problem(table)) return problem;
    if (auto problem = read_topics()) return problem;
    if (auto problem = count_messages()) return problem;
    rewind(std::vector<bool>(summary_.topics.size(), true));
    return std::nullopt;
  }

  [[nodiscard]] const Summary& summary() const override { return summary_; }

  /// In the order of the rows, which is that of recording: that of the times would need an index, or memory.
  void rewind(std::vector<bool> wanted) override {
    std::vector<std::int64_t> ids;
    for (const auto& [id, place] : places_)
      if (place < wanted.size() && wanted[place]) ids.push_back(id);
    row_ = 0;
    messages_ =
        file_.query(fmt::format("SELECT topic_id, timestamp, data, id FROM messages WHERE topic_id IN ({}) "
                                "ORDER BY id",
                                fmt::join(ids, ",")));
  }

  [[nodiscard]] std::optional<Message> next() override {
    while (messages_.next()) {
      row_ = messages_.integer(3);
      if (const auto place = places_.find(messages_.integer(0)); place != places_.end())
        return Message{place->second, stamp_of(messages_.integer(1)), messages_.bytes(2)};
    }
    note_damage(messages_);
    return std::nullopt;
  }

  [[nodiscard]] std::vector<std::string> notes() const override { return notes_; }

  [[nodiscard]] double progress() const override {
    return last_row_ <= 0 ? 1.0 : static_cast<double>(row_) / static_cast<double>(last_row_);
  }

 private:
  std::optional<std::string> read_topics() {
    const auto definitions = read_definitions();
    auto topics = file_.query("SELECT id, name, type, serialization_format FROM topics ORDER BY id");
    while (topics.next()) {
      Topic topic{.name = std::string(topics.bytes(1)),
                  .type = plain_type(topics.bytes(2)),
                  .encoding = topics.bytes(3) == "cdr" ? Encoding::kCdr : Encoding::kOther,
                  .definition = {}};
      if (const auto known = definitions.find(topic.type); known != definitions.end())
        topic.definition = known->second;
      places_[topics.integer(0)] = place_topic(summary_.topics, std::move(topic));
    }
    return why_none(topics);
  }

  /// By type; older bags have none.
  [[nodiscard]] std::map<std::string, std::string> read_definitions() const {
    std::map<std::string, std::string> definitions;
    if (file_.table_problem("message_definitions")) return definitions;
    auto rows = file_.query(
        "SELECT topic_type, encoded_message_definition FROM message_definitions WHERE encoding = 'ros2msg'");
    while (rows.next()) definitions[plain_type(rows.bytes(0))] = rows.bytes(1);
    return definitions;
  }

  std::optional<std::string> count_messages() {
    auto counts = file_.query(
        "SELECT topic_id, COUNT(*), MIN(timestamp), MAX(timestamp), MAX(id) FROM messages GROUP BY topic_id");
    while (counts.next()) {
      last_row_ = std::max(last_row_, counts.integer(4));
      const auto place = places_.find(counts.integer(0));
      if (place == places_.end()) continue;
      summary_.topics[place->second].messages = counts.integer(1);
      for (const int column : {2, 3}) include(summary_, stamp_of(counts.integer(column)));
    }
    return why_none(counts);
  }

  /// Why a query could not even begin; one that breaks off is noted.
  std::optional<std::string> why_none(const SqliteRows& rows) {
    if (!rows.has_begun()) return rows.problem();
    note_damage(rows);
    return std::nullopt;
  }

  /// Why a query ended before its last row, if it did.
  void note_damage(const SqliteRows& rows) {
    if (!rows.problem().empty())
      add_note(notes_,
               fmt::format("{}: damaged or cut off after message {} ({}); only what comes before is used",
                           name_, row_, rows.problem()));
  }

  std::string name_;
  SqliteFile file_;
  SqliteRows messages_;
  Summary summary_;
  std::map<std::int64_t, std::size_t> places_;  // of topic ids among the summary's topics
  std::vector<std::string> notes_;
  std::int64_t row_ = 0;
  std::int64_t last_row_ = 0;
};

}  // namespace

bool is_sqlite(std::string_view first_bytes) { return first_bytes.starts_with("SQLite format 3"); }

Result<std::unique_ptr<Reader>> open_sqlite_bag(const std::filesystem::path& path) {
  auto file = SqliteFile::open(path);
  if (!file) return file.error();
  auto bag = std::make_unique<SqliteBag>(path, *std::move(file));
  if (const auto problem = bag->look_through())
    return Error{fmt::format("{}: not a ROS 2 bag, or a damaged one: {}", path.string(), *problem)};
  return std::unique_ptr<Reader>(std::move(bag));
}

}  // namespace waymark::bag
