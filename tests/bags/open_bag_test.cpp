#include "workbench/bags/open_bag.hpp"

#include <algorithm>
#include <functional>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <sqlite3.h>

#include "support/io_support.hpp"
#include "support/stamps.hpp"

#include "bags/ros1_file.hpp"
#include "bags/zstd_frame.hpp"
#include "workbench/bags/bag_source.hpp"
#include "workbench/run/open_source.hpp"

namespace waymark::bag {
namespace {

using test::Ros1File;
using test::Wire;
using test::zstd_frame;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;
using waymark::test::at;
using waymark::test::TempFolder;
namespace fs = std::filesystem;

std::string twist(Encoding encoding, double stamp_s, double v_mps) {
  const auto nanos = stamp_from_seconds(stamp_s).since_epoch.count();
  Wire wire(encoding);
  if (encoding == Encoding::kRos1) wire.add<std::uint32_t>(0);  // seq
  wire.add(static_cast<std::int32_t>(nanos / 1'000'000'000))
      .add(static_cast<std::uint32_t>(nanos % 1'000'000'000))
      .text("base_link");
  for (const double value : {v_mps, 0.0, 0.0, 0.0, 0.0, 0.5}) wire.add(value);
  return wire.bytes();
}

std::string ros1_bag(const std::string& topic, double from_s, double to_s) {
  Ros1File file;
  const auto number = file.topic(topic, "geometry_msgs/TwistStamped");
  for (double t_s = from_s; t_s < to_s - 1e-6; t_s += 0.5)
    file.add(number, t_s, twist(Encoding::kRos1, t_s, t_s));
  return file.bytes();
}

/// A .db3 file whose messages are packed as `pack` does.
fs::path write_db3(const fs::path& path, double from_s, double to_s,
                   const std::function<std::string(std::string)>& pack = {}) {
  sqlite3* database = nullptr;
  EXPECT_EQ(sqlite3_open(path.c_str(), &database), SQLITE_OK);
  std::string sql =
      "BEGIN;"
      "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT, type TEXT, serialization_format TEXT);"
      "INSERT INTO topics VALUES (1, '/speed', 'geometry_msgs/msg/TwistStamped', 'cdr');"
      "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER, timestamp INTEGER, data BLOB);";
  for (double t_s = from_s; t_s < to_s - 1e-6; t_s += 0.5) {
    std::string bytes = twist(Encoding::kCdr, t_s, t_s);
    if (pack) bytes = pack(std::move(bytes));
    sql += fmt::format("INSERT INTO messages(topic_id, timestamp, data) VALUES (1, {}, x'",
                       stamp_from_seconds(t_s).since_epoch.count());
    for (const char c : bytes) sql += fmt::format("{:02x}", static_cast<unsigned char>(c));
    sql += "');";
  }
  sql += "COMMIT;";
  EXPECT_EQ(sqlite3_exec(database, sql.c_str(), nullptr, nullptr, nullptr), SQLITE_OK);
  sqlite3_close(database);
  return path;
}

/// Replaces a file by what zstd makes of it.
void pack_file(const fs::path& path) {
  const std::string packed = zstd_frame(read_file(path).value());
  fs::remove(path);
  EXPECT_TRUE(write_file(path.string() + ".zstd", packed).ok());
}

void write_metadata(const TempFolder& folder, const std::string& names, const std::string& mode = "") {
  folder.write("metadata.yaml", "rosbag2_bagfile_information:\n  version: 4\n  relative_file_paths: [" +
                                    names + "]\n  compression_mode: \"" + mode + "\"\n");
}

struct Read {
  std::vector<double> speeds;
  std::vector<std::string> notes;
};

Read read(const fs::path& path, const InputOptions& options = {}) {
  auto source = open_source(path, options);
  EXPECT_TRUE(source.ok()) << source.error().message;
  if (!source) return {};
  Read all;
  for (const auto& [stamp, velocity] :
       waymark::test::only<Velocity>(waymark::test::read_all(**source).events)) {
    EXPECT_EQ(stamp, at(velocity.v_mps));
    all.speeds.push_back(velocity.v_mps);
  }
  EXPECT_TRUE(std::ranges::is_sorted(all.speeds));
  all.notes = (*source)->notes();
  return all;
}

TEST(OpenBag, ARecordingOfRos1InPartsIsOneByItsFolderItsFirstPartOrItsNames) {
  const TempFolder folder;
  for (int part = 0; part < 12; ++part)
    folder.write(fmt::format("drive_{}.bag", part),
                 ros1_bag("/speed", 100.0 + 10.0 * part, 110.0 + 10.0 * part));
  EXPECT_EQ(read(folder.path()).speeds.size(), 240U);
  const Read from_first = read(folder.path() / "drive_0.bag");
  EXPECT_EQ(from_first.speeds.size(), 240U);
  EXPECT_THAT(from_first.notes, Contains(HasSubstr("drive_0.bag is the first of 12 parts")));
  EXPECT_EQ(read(folder.path() / "drive_1.bag").speeds.size(), 20U);
  InputOptions options;
  options.bag.more_bags =
      (folder.path() / "drive_1.bag").string() + "," + (folder.path() / "drive_3.bag").string();
  EXPECT_EQ(read(folder.path() / "drive_2.bag", options).speeds.size(), 60U);
}

TEST(OpenBag, APartOfRos1ThatIsMissingIsNamed) {
  const TempFolder folder;
  for (const int part : {0, 1, 3})
    folder.write(fmt::format("drive_{}.bag", part),
                 ros1_bag("/speed", 100.0 + 20.0 * part, 120.0 + 20.0 * part));
  const Read all = read(folder.path());
  EXPECT_EQ(all.speeds.size(), 120U);
  EXPECT_THAT(all.notes, Contains(HasSubstr("missing between drive_1.bag and drive_3.bag: 1")));
}

TEST(OpenBag, BagsOfOtherDrivesInTheFolderAreNotMixed) {
  const TempFolder folder;
  folder.write("monday.bag", ros1_bag("/speed", 100.0, 110.0));
  folder.write("tuesday.bag", ros1_bag("/speed", 9000.0, 9010.0));
  EXPECT_THAT(open_source(folder.path()).error().message,
              AllOf(HasSubstr("not of one recording"), HasSubstr("one of them at a time")));
}

TEST(OpenBag, BagsWithOtherTopicsOfTheSameTimeAreMerged) {
  const TempFolder folder;
  const auto first = folder.write("a.bag", ros1_bag("/speed", 100.0, 160.0));
  Ros1File truth;
  const auto number = truth.topic("/truth", "geometry_msgs/PoseStamped");
  for (int i = 0; i < 60; ++i) {
    Wire wire(Encoding::kRos1);
    wire.add<std::uint32_t>(0).add<std::int32_t>(100 + i).add<std::uint32_t>(0).text("world");
    for (const double value : {1.0, 2.0, 0.0, 0.0, 0.0, 0.0, 1.0}) wire.add(value);
    truth.add(number, 100.0 + i, wire.bytes());
  }
  InputOptions options;
  options.bag.truth_topic = "/truth";
  options.bag.more_bags = folder.write("b.bag", truth.bytes()).string();
  auto source = open_source(first, options);
  ASSERT_TRUE(source.ok()) << source.error().message;
  const auto events = waymark::test::read_all(**source).events;
  EXPECT_EQ(events.size(), 180U);
  EXPECT_TRUE(std::ranges::is_sorted(events, {}, &Event::stamp));
}

TEST(OpenBag, OfSeveralInputsEachMustBeABag) {
  const TempFolder folder;
  InputOptions options;
  options.bag.more_bags = (folder.path() / "nowhere.bag").string();
  EXPECT_THAT(open_source(folder.path(), options).error().message, HasSubstr("must be a ROS bag"));
  EXPECT_THAT(open_source(folder.write("a.bag", ros1_bag("/speed", 1.0, 2.0)), options).error().message,
              HasSubstr("nowhere.bag"));
}

TEST(OpenBag, FilesThatAreCompressedAsAWholeAreRead) {
  const TempFolder folder;
  pack_file(write_db3(folder.path() / "drive_0.db3", 100.0, 110.0));
  pack_file(write_db3(folder.path() / "drive_1.db3", 110.0, 120.0));
  write_metadata(folder, "drive_0.db3.zstd, drive_1.db3.zstd", "FILE");
  EXPECT_EQ(read(folder.path()).speeds.size(), 40U);
  write_metadata(folder, "drive_0.db3, drive_1.db3", "FILE");
  EXPECT_EQ(read(folder.path()).speeds.size(), 40U) << "named without .zstd";
  fs::remove(folder.path() / "metadata.yaml");
  EXPECT_EQ(read(folder.path()).speeds.size(), 40U);
  EXPECT_EQ(read(folder.path() / "drive_1.db3.zstd").speeds.size(), 20U);
}

TEST(OpenBag, FilesThatWereUnpackedSinceAreFound) {
  const TempFolder folder;
  write_db3(folder.path() / "drive_0.db3", 100.0, 110.0);
  write_metadata(folder, "drive_0.db3.zstd", "FILE");
  EXPECT_EQ(read(folder.path()).speeds.size(), 20U);
}

TEST(OpenBag, MessagesThatAreCompressedOneByOneAreReadWithAndWithoutMetadata) {
  const TempFolder folder;
  const auto file = write_db3(folder.path() / "drive_0.db3", 100.0, 110.0, zstd_frame);
  EXPECT_EQ(read(file).speeds.size(), 20U);
  write_metadata(folder, "drive_0.db3", "MESSAGE");
  EXPECT_EQ(read(folder.path()).speeds.size(), 20U);
}

TEST(OpenBag, AMessageWhoseFrameIsDamagedIsLeftOut) {
  const TempFolder folder;
  int count = 0;
  const auto spoil = [&count](std::string bytes) {
    std::string frame = zstd_frame(bytes);
    if (++count == 5) frame.resize(frame.size() - 3);
    return frame;
  };
  const Read all = read(write_db3(folder.path() / "drive_0.db3", 100.0, 110.0, spoil));
  EXPECT_EQ(all.speeds.size(), 19U);
  EXPECT_THAT(all.notes, Contains(HasSubstr("/speed skipped whose zstd frames are damaged")));
}

TEST(OpenBag, AFileOfAFolderThatIsMissingIsNamedAndTheOthersAreRead) {
  const TempFolder folder;
  write_db3(folder.path() / "drive_0.db3", 100.0, 110.0);
  write_db3(folder.path() / "drive_2.db3", 120.0, 130.0);
  write_metadata(folder, "drive_0.db3, drive_1.db3, drive_2.db3");
  const Read all = read(folder.path());
  EXPECT_EQ(all.speeds.size(), 40U);
  EXPECT_THAT(all.notes, Contains(AllOf(HasSubstr("drive_1.db3 is missing"), Not(HasSubstr("empty")))));
}

TEST(OpenBag, FilesOfAFolderInAnotherOrderArePlayedInTheOrderOfTime) {
  const TempFolder folder;
  for (const int part : {0, 1, 2})
    write_db3(folder.path() / fmt::format("drive_{}.db3", part), 100.0 + 10.0 * part, 110.0 + 10.0 * part);
  write_metadata(folder, "drive_1.db3, drive_2.db3, drive_0.db3");
  EXPECT_EQ(read(folder.path()).speeds.size(), 60U);
}

}  // namespace
}  // namespace waymark::bag
