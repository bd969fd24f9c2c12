#include "workbench/bags/sqlite_bag.hpp"

#include <memory>
#include <set>

#include <gmock/gmock.h>
#include <sqlite3.h>

#include "support/io_support.hpp"

namespace waymark::bag {
namespace {

using testing::AnyOf;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using waymark::test::TempFolder;
namespace fs = std::filesystem;

constexpr const char* kTopics =
    "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT, type TEXT, serialization_format TEXT);"
    "INSERT INTO topics VALUES (1, '/odom', 'nav_msgs/msg/Odometry', 'cdr');";
constexpr const char* kMessages =
    "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER, timestamp INTEGER, data BLOB);";
/// 200 messages of 20 bytes.
constexpr const char* kRows =
    "WITH RECURSIVE c(x) AS (SELECT 1 UNION ALL SELECT x + 1 FROM c WHERE x < 200) "
    "INSERT INTO messages SELECT x, 1, 1000 * x, zeroblob(20) FROM c;";

class Writer {
 public:
  explicit Writer(const fs::path& path) {
    sqlite3* database = nullptr;
    EXPECT_EQ(sqlite3_open(path.c_str(), &database), SQLITE_OK);
    database_.reset(database);
  }

  /// False: this SQLite cannot.
  bool run(const std::string& sql) {
    return sqlite3_exec(database_.get(), sql.c_str(), nullptr, nullptr, nullptr) == SQLITE_OK;
  }
  std::int64_t number(const std::string& sql) {
    std::int64_t value = -1;
    const auto keep = [](void* into, int /*columns*/, char** values, char** /*names*/) {
      *static_cast<std::int64_t*>(into) = std::stoll(values[0]);
      return 0;
    };
    EXPECT_EQ(sqlite3_exec(database_.get(), sql.c_str(), keep, &value, nullptr), SQLITE_OK);
    return value;
  }

 private:
  struct Close {
    void operator()(sqlite3* database) const { sqlite3_close(database); }
  };
  std::unique_ptr<sqlite3, Close> database_;
};

fs::path write_database(const TempFolder& folder, const std::string& sql) {
  const fs::path path = folder.path() / "bag.db3";
  EXPECT_TRUE(Writer(path).run(sql));
  return path;
}

std::string refusal(const std::string& sql) {
  const TempFolder folder;
  const auto bag = open_sqlite_bag(write_database(folder, sql));
  return bag ? "" : bag.error().message;
}

/// What a bag gives up to its end, or to more than any of those here holds.
struct Content {
  std::int64_t messages = 0;
  std::vector<std::string> notes;
};

Content content_of(Reader& bag) {
  Content content;
  while (bag.next() && content.messages < 1'000'000) ++content.messages;
  content.notes = bag.notes();
  return content;
}

Content content_of(const fs::path& path) {
  auto bag = open_sqlite_bag(path);
  EXPECT_TRUE(bag.ok()) << bag.error().message;
  return bag ? content_of(**bag) : Content{};
}

TEST(SqliteBag, GivesItsMessages) {
  const TempFolder folder;
  const auto path = write_database(folder, std::string(kTopics) + kMessages + kRows);
  const Content content = content_of(path);
  EXPECT_EQ(content.messages, 200);
  EXPECT_THAT(content.notes, IsEmpty());
}

TEST(SqliteBag, ViewsInPlaceOfTablesAreRefusedAndNotRun) {
  EXPECT_THAT(
      refusal(std::string(kTopics) +
              "CREATE VIEW messages AS WITH RECURSIVE c(x) AS (SELECT 1 UNION ALL SELECT x + 1 FROM c) "
              "SELECT x AS id, 1 AS topic_id, x AS timestamp, x'00' AS data FROM c;"),
      HasSubstr("bag.db3: not a ROS 2 bag, or a damaged one: messages is a view, not a table"));
  EXPECT_THAT(
      refusal(std::string(kMessages) + "CREATE VIEW topics AS SELECT 1 AS id, randomblob(9) AS name;"),
      HasSubstr("topics is a view, not a table"));
}

TEST(SqliteBag, AViewThatCallsItselfATableIsNotRunEither) {
  EXPECT_THAT(
      refusal(std::string(kTopics) +
              "CREATE VIEW messages AS SELECT random() AS id, 1 AS topic_id, 2 AS timestamp, 3 AS data;"
              "PRAGMA writable_schema = ON;"
              "UPDATE sqlite_master SET type = 'table', rootpage = 2 WHERE name = 'messages';"),
      AnyOf(HasSubstr("prohibited"), HasSubstr("malformed")));
}

TEST(SqliteBag, ColumnsThatAreComputedAreRefused) {
  EXPECT_THAT(refusal(std::string(kTopics) +
                      "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER, timestamp INTEGER, "
                      "data AS (hex(zeroblob(30000000))));"),
              HasSubstr("table messages has computed columns"));
}

TEST(SqliteBag, VirtualTablesAreRefused) {
  const TempFolder folder;
  const fs::path path = folder.path() / "bag.db3";
  if (!Writer(path).run(std::string(kTopics) +
                        "CREATE VIRTUAL TABLE messages USING fts4(id, topic_id, timestamp, data)"))
    GTEST_SKIP() << "this SQLite has no virtual tables";
  EXPECT_THAT(open_sqlite_bag(path).error().message, HasSubstr("no such module"));
}

TEST(SqliteBag, WithoutItsTablesItIsNoBag) {
  EXPECT_THAT(refusal(kTopics), HasSubstr("it has no table messages"));
  EXPECT_THAT(refusal(std::string(kTopics) + "CREATE TABLE messages(id, text);"),
              HasSubstr("no such column: topic_id"));
}

TEST(SqliteBag, DefinitionsThatAreNoTableAreLeftOut) {
  const TempFolder folder;
  const auto path = write_database(folder, std::string(kTopics) + kMessages + kRows +
                                               "CREATE VIEW message_definitions AS SELECT "
                                               "'nav_msgs/msg/Odometry' AS topic_type, 'x' AS "
                                               "encoded_message_definition, 'ros2msg' AS encoding;");
  const auto bag = open_sqlite_bag(path);
  ASSERT_TRUE(bag.ok());
  EXPECT_EQ((*bag)->summary().topics.at(0).definition, "");
}

TEST(SqliteBag, TextsOfUtf16AreRead) {
  const TempFolder folder;
  const auto path =
      write_database(folder, std::string("PRAGMA encoding = 'UTF-16';") + kTopics + kMessages + kRows);
  auto bag = open_sqlite_bag(path);
  ASSERT_TRUE(bag.ok());
  EXPECT_EQ((*bag)->summary().topics.at(0).name, "/odom");
  EXPECT_EQ((*bag)->summary().topics.at(0).type, "nav_msgs/Odometry");
  EXPECT_EQ(content_of(**bag).messages, 200);
}

std::set<std::string> names_in(const fs::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.insert(entry.path().filename().string());
  return names;
}

TEST(SqliteBag, ARecordingThatWasInterruptedIsReadWithItsLogAndNothingIsWritten) {
  const TempFolder recorded;
  Writer recorder(recorded.path() / "bag.db3");
  ASSERT_TRUE(recorder.run("PRAGMA journal_mode = WAL; PRAGMA wal_autocheckpoint = 0;"));
  ASSERT_TRUE(recorder.run(std::string(kTopics) + kMessages + kRows));
  const TempFolder folder;
  for (const char* name : {"bag.db3", "bag.db3-wal"})
    fs::copy_file(recorded.path() / name, folder.path() / name);
  const auto log = read_file(folder.path() / "bag.db3-wal").value();
  EXPECT_EQ(content_of(folder.path() / "bag.db3").messages, 200);
  EXPECT_EQ(names_in(folder.path()), (std::set<std::string>{"bag.db3", "bag.db3-wal"}));
  EXPECT_EQ(read_file(folder.path() / "bag.db3-wal").value(), log);
}

TEST(SqliteBag, AJournalBesideItIsNoted) {
  const TempFolder folder;
  const auto path = write_database(folder, std::string(kTopics) + kMessages + kRows);
  folder.write("bag.db3-journal", "half of a change");
  const Content content = content_of(path);
  EXPECT_EQ(content.messages, 200);
  EXPECT_THAT(content.notes, Contains(HasSubstr("there is a -journal beside it")));
}

TEST(SqliteBag, BytesOfAPathThatMeanSomethingInAUriDoNotHere) {
  const TempFolder folder;
  const fs::path odd = folder.path() / "R\xe4ume?mode=rwc#1%41";
  fs::create_directories(odd);
  EXPECT_TRUE(Writer(odd / "bag.db3").run(std::string(kTopics) + kMessages + kRows));
  EXPECT_EQ(content_of(odd / "bag.db3").messages, 200);
}

/// A page of 512 bytes all of whose 50 children are the page `child`.
std::string page_of_children(std::uint32_t child) {
  constexpr int kCells = 49;
  constexpr std::size_t kPage = 512, kCellSize = 5;
  std::string page(kPage, '\0');
  const auto put = [&page](std::size_t at, int bytes, std::uint32_t value) {
    for (int i = bytes; i-- > 0; value >>= 8)
      page[at + static_cast<std::size_t>(i)] = static_cast<char>(value & 0xff);
  };
  put(0, 1, 5);  // within a tree of rows
  put(3, 2, kCells);
  put(5, 2, kPage - kCells * kCellSize);
  put(8, 4, child);
  for (std::size_t cell = 0; cell < kCells; ++cell) {
    const std::size_t at = kPage - (cell + 1) * kCellSize;
    put(12 + 2 * cell, 2, static_cast<std::uint32_t>(at));
    put(at, 4, child);
    put(at + 4, 1, 100);  // its largest row
  }
  return page;
}

// What aliases are in YAML: 8 pages that lead to one another stand for 50^8 rows.
TEST(SqliteBag, PagesThatLeadToOneAnotherDoNotGoOnForEver) {
  const TempFolder folder;
  const auto path =
      write_database(folder, std::string("PRAGMA page_size = 512;") + kTopics + kMessages + kRows);
  const auto root = Writer(path).number("SELECT rootpage FROM sqlite_master WHERE name = 'messages'");
  std::string bytes = read_file(path).value();
  // Behind the root come the leaves, of which enough are there to be made into what stands above one.
  constexpr int kLevels = 8;
  ASSERT_GT(static_cast<std::int64_t>(bytes.size()), 512 * (root + kLevels));
  for (int level = 0; level < kLevels; ++level) {
    const auto page = static_cast<std::uint32_t>(root + level);
    bytes.replace(512 * (page - 1), 512, page_of_children(page + 1));
  }
  folder.write("bag.db3", bytes);
  const Content content = content_of(path);
  EXPECT_THAT(content.notes, Contains(HasSubstr("its pages refer to more rows than it can hold")));
  EXPECT_LT(content.messages, 1'000'000);
}

}  // namespace
}  // namespace waymark::bag
