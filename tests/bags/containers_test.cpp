// One log in every container, each written by a public writer: rosbag (Debian's python3-rosbag), npm's
// @mcap/core with @foxglove/rosmsg2-serialization, and sqlite3 of Python. What is damaged afterwards must
// cost no more than it hit.
#include <sys/stat.h>

#include <cmath>
#include <cstdlib>
#include <random>

#include <gmock/gmock.h>

#include "support/io_support.hpp"

#include "workbench/bags/bag_source.hpp"
#include "workbench/logs/image_file.hpp"
#include "workbench/logs/image_loader.hpp"
#include "workbench/logs/log_folder.hpp"
#include "workbench/run/open_source.hpp"

namespace waymark {
namespace {

namespace fs = std::filesystem;
using testing::AnyOf;
using testing::Contains;
using testing::HasSubstr;

constexpr const char* kPython = "/usr/bin/python3";  // Debian's own, which has rosbag
const std::string kWriters = WAYMARK_SOURCE_DIR "/tests/bags/writers/";
const std::string kWeb = WAYMARK_SOURCE_DIR "/web";

bool runs(const std::string& command) { return std::system((command + " >/dev/null 2>&1").c_str()) == 0; }

/// One log as messages, and as every bag that this machine has a writer for. Made once.
class Containers : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    home = std::make_unique<test::TempFolder>();
    write_log();
    const fs::path messages = home->path() / "messages.jsonl";
    ASSERT_TRUE(
        runs(fmt_command({kPython, kWriters + "log_to_messages.py", log().string(), messages.string()})));
    for (const std::string compression : {"none", "bz2", "lz4"})
      make("ros1_" + compression + ".bag", {kPython, kWriters + "write_ros1_bag.py", messages.string()},
           {compression});
    for (const std::string compression : {"none", "lz4", "zstd", "flat"})
      make("ros2_" + compression + ".mcap", {"node", kWriters + "write_mcap.mjs", messages.string()},
           {compression, kWeb});
    const fs::path serialized = home->path() / "cdr.jsonl";
    if (!runs(fmt_command(
            {"node", kWriters + "write_mcap.mjs", messages.string(), serialized.string(), "none", kWeb})))
      return;
    for (const std::string age : {"new", "old", "bare"}) {
      fs::create_directories(home->path() / age);
      make(age + "/ros2.db3", {kPython, kWriters + "write_db3.py", serialized.string()}, {age});
    }
  }
  static void TearDownTestSuite() { home.reset(); }

  static fs::path log() { return home->path() / "log"; }
  static fs::path bag(const std::string& name) { return home->path() / name; }
  static const std::vector<std::string>& bags() { return written; }

  static bool has(const std::string& name) { return std::ranges::find(written, name) != written.end(); }

 private:
  static std::string fmt_command(const std::vector<std::string>& words) {
    std::string command;
    for (const auto& word : words) command += "'" + word + "' ";
    return command;
  }

  static void make(const std::string& name, std::vector<std::string> words,
                   const std::vector<std::string>& more) {
    words.push_back(bag(name).string());
    words.insert(words.end(), more.begin(), more.end());
    if (runs(fmt_command(words))) written.push_back(name);
  }

  /// Odometry, observations and images over 4 s, of a camera that is tilted.
  static void write_log() {
    std::string odometry = "stamp_s,x_m,y_m,theta_rad\n", observations = "stamp_s,id,range_m,bearing_rad\n",
                images = "stamp_s,file\n";
    fs::create_directories(log() / "images");
    for (int i = 0; i < 80; ++i) {
      const double t = 1000.0 + 0.05 * i;
      odometry +=
          std::to_string(t) + "," + std::to_string(0.01 * i) + ",0.5," + std::to_string(0.02 * i) + "\n";
      if (i % 8 == 3) observations += std::to_string(t) + ",7,2.5,0.25\n" + std::to_string(t) + ",9,4,-0.5\n";
      if (i % 8 == 7) observations += std::to_string(t) + ",,,\n";
      if (i % 8 == 5) {
        const std::string file = std::to_string(i) + ".png";
        images += std::to_string(t) + "," + file + "\n";
        ASSERT_TRUE(write_png(log() / "images" / file, GreyImage(24, 16, static_cast<std::uint8_t>(i))).ok());
      }
    }
    const auto write = [](const char* name, const std::string& text) {
      ASSERT_TRUE(write_file(log() / name, text).ok());
    };
    write("odometry.csv", odometry);
    write("observations.csv", observations);
    write("images.csv", images);
    write("log.yaml", "waymark_log: 1\ncamera_mount:\n  x_m: 0.1\n  z_m: 0.4\n");
    write("camera.yaml",
          "image_width: 24\nimage_height: 16\ncamera_matrix:\n  data: [30, 0, 12, 0, 31, 8, 0, 0, 1]\n"
          "distortion_model: plumb_bob\ndistortion_coefficients:\n  data: [0.1, 0.01, 0, 0.002, 0]\n"
          "rectification_matrix:\n  data: [1, 0, 0, 0, 1, 0, 0, 0, 1]\n"
          "projection_matrix:\n  data: [30, 0, 12, 0, 0, 31, 8, 0, 0, 0, 1, 0]\n");
  }

  static inline std::unique_ptr<test::TempFolder> home;
  static inline std::vector<std::string> written;
};

std::vector<Event> events_of(const fs::path& path) {
  auto source = open_source(path);
  EXPECT_TRUE(source.ok()) << source.error().message;
  if (!source) return {};
  ImageLoader loader(*std::move(source));
  auto delivered = test::read_all(loader);
  EXPECT_EQ(delivered.error, "");
  return std::move(delivered.events);
}

/// Through sines and back an angle loses its last bits, and nothing else.
void expect_same(const std::vector<Event>& events, const std::vector<Event>& expected) {
  ASSERT_EQ(events.size(), expected.size());
  for (std::size_t i = 0; i < events.size(); ++i) {
    EXPECT_EQ(events[i].stamp, expected[i].stamp);
    ASSERT_EQ(events[i].content.index(), expected[i].content.index());
    if (const auto* pose = std::get_if<OdometryPose>(&events[i].content)) {
      const Pose2& other = std::get<OdometryPose>(expected[i].content).T_odom_robot;
      EXPECT_LT(difference(pose->T_odom_robot, other).norm(), 1e-12);
    } else if (const auto* image = std::get_if<Image>(&events[i].content)) {
      EXPECT_EQ(*image->pixels, *std::get<Image>(expected[i].content).pixels);
    } else if (const auto* scan = std::get_if<Observations>(&events[i].content)) {
      const auto& other = std::get<Observations>(expected[i].content);
      ASSERT_EQ(scan->size(), other.size());
      for (std::size_t k = 0; k < scan->size(); ++k) {
        EXPECT_EQ((*scan)[k].id, other[k].id);
        const auto& [range_m, bearing_rad] = std::get<RangeBearing>((*scan)[k].value);
        EXPECT_NEAR(range_m, std::get<RangeBearing>(other[k].value).range_m, 1e-12);
        EXPECT_NEAR(bearing_rad, std::get<RangeBearing>(other[k].value).bearing_rad, 1e-12);
      }
    }
  }
}

TEST_F(Containers, EachGivesTheEventsOfTheLog) {
  const auto expected = events_of(log());
  ASSERT_EQ(expected.size(), 80U + 20U + 10U);
  if (bags().empty())
    GTEST_SKIP() << "no writer of bags on this machine: python3-rosbag, npm packages of web/";
  for (const auto& name : bags()) {
    SCOPED_TRACE(name);
    expect_same(events_of(bag(name)), expected);
  }
  if (has("new/ros2.db3")) expect_same(events_of(bag("new")), expected);
}

TEST_F(Containers, EachKnowsTheCameraAndItsMount) {
  if (bags().empty()) GTEST_SKIP() << "no writer of bags on this machine";
  for (const auto& name : bags()) {
    SCOPED_TRACE(name);
    const auto source = open_source(bag(name));
    ASSERT_TRUE(source.ok()) << source.error().message;
    const auto& settings = (*source)->info().settings;
    EXPECT_THAT(settings, Contains(testing::Pair("camera.fv_px", "31")));
    EXPECT_THAT(settings, Contains(testing::Pair("camera.k1", "0.1")));
    EXPECT_THAT(settings, Contains(testing::Pair("camera.mount_x_m", "0.1")));
    EXPECT_THAT((*source)->notes(), Contains(HasSubstr("not used: /chatter (std_msgs/String)")));
  }
}

TEST_F(Containers, WithoutDefinitionsTheReleasedTypesAreKnown) {
  if (!has("old/ros2.db3")) GTEST_SKIP() << "no npm packages of web/ on this machine";
  const auto events = events_of(bag("old/ros2.db3"));
  EXPECT_EQ(test::only<OdometryPose>(events).size(), 80U);
  EXPECT_EQ(test::only<Observations>(events).size(), 20U);
  EXPECT_EQ(test::only<Image>(events).size(), 10U);
}

struct Reading {
  std::size_t events = 0;
  std::string error;
  std::vector<std::string> notes;
};

Reading read_bytes(const test::TempFolder& folder, const std::string& name, const std::string& bytes) {
  auto source = open_bag_source(folder.write(name, bytes), {});
  if (!source) return {0, source.error().message, {}};
  ImageLoader loader(*std::move(source));
  const auto delivered = test::read_all(loader);
  return {delivered.events.size(), delivered.error, loader.notes()};
}

TEST_F(Containers, OneThatIsCutOffGivesWhatIsBeforeTheCut) {
  if (bags().empty()) GTEST_SKIP() << "no writer of bags on this machine";
  const test::TempFolder folder;
  for (const auto& name : bags()) {
    SCOPED_TRACE(name);
    const std::string whole = read_file(bag(name)).value();
    const std::string file = fs::path(name).filename().string();
    const bool is_database = name.ends_with(".db3");
    std::size_t last = 0;
    for (std::size_t size = 0; size + 1 < whole.size(); size += 1 + whole.size() / 61) {
      const Reading reading = read_bytes(folder, file, whole.substr(0, size));
      EXPECT_LE(reading.events, 110U);
      if (!is_database) {
        EXPECT_GE(reading.events, last) << "at " << size;
      }
      if (reading.error.empty()) {
        EXPECT_THAT(reading.notes,
                    Contains(AnyOf(HasSubstr("damaged or cut off"), HasSubstr("has no index"))))
            << size;
        last = reading.events;
      } else {
        EXPECT_THAT(reading.error, HasSubstr(file)) << size;
        EXPECT_EQ(reading.error.find('\n'), std::string::npos);
      }
    }
    if (!is_database) {
      EXPECT_GT(last, 60U);
    }
  }
}

TEST_F(Containers, OneByteThatIsWrongCostsNoMoreThanItsChunk) {
  if (bags().empty()) GTEST_SKIP() << "no writer of bags on this machine";
  const test::TempFolder folder;
  std::mt19937 random(1);
  for (const auto& name : bags()) {
    SCOPED_TRACE(name);
    const std::string whole = read_file(bag(name)).value();
    for (int trial = 0; trial < 150; ++trial) {
      std::string bytes = whole;
      const int wrong = 1 + trial % 7;
      for (int i = 0; i < wrong; ++i) bytes[random() % bytes.size()] = static_cast<char>(random() % 256);
      // Anything may come out that is an error or a log; nothing may be read that is not there.
      const Reading reading = read_bytes(folder, fs::path(name).filename().string(), bytes);
      EXPECT_LE(reading.events, 130U);
      EXPECT_EQ(reading.error.find('\n'), std::string::npos);
    }
  }
}

TEST_F(Containers, AnIndexThatIsMissingCostsNothing) {
  if (!has("ros1_lz4.bag")) GTEST_SKIP() << "no python3-rosbag on this machine";
  const test::TempFolder folder;
  std::string bytes = read_file(bag("ros1_lz4.bag")).value();
  const auto place = bytes.find("index_pos=");
  ASSERT_NE(place, std::string::npos);
  bytes.replace(place + 10, 8, std::string(8, '\0'));
  expect_same(events_of(folder.write("unindexed.bag", bytes)), events_of(log()));
}

TEST_F(Containers, AChunkThatLiesAboutItsSizeIsNamedAndTheOthersAreRead) {
  if (!has("ros1_none.bag")) GTEST_SKIP() << "no python3-rosbag on this machine";
  const test::TempFolder folder;
  const std::string whole = read_file(bag("ros1_none.bag")).value();
  const auto place = whole.find("size=", whole.find("compression=none"));
  ASSERT_NE(place, std::string::npos);
  for (const char lie : {'\x7f', '\0'}) {
    std::string bytes = whole;
    bytes.replace(place + 5, 4, lie == '\0' ? std::string(4, '\0') : std::string("\x01\x01\x00\x7f", 4));
    const Reading reading = read_bytes(folder, "lies.bag", bytes);
    EXPECT_EQ(reading.error, "");
    EXPECT_GT(reading.events, 60U);
    EXPECT_THAT(reading.notes,
                Contains(testing::AllOf(HasSubstr("lies.bag: the chunk at byte "), HasSubstr("stated"))));
  }
}

TEST_F(Containers, AChecksumThatIsWrongIsSaid) {
  if (!has("ros2_none.mcap")) GTEST_SKIP() << "no npm packages of web/ on this machine";
  const test::TempFolder folder;
  std::string bytes = read_file(bag("ros2_none.mcap")).value();
  const auto place = bytes.find("hello");
  ASSERT_NE(place, std::string::npos);
  bytes[place] = 'j';
  const Reading reading = read_bytes(folder, "spoilt.mcap", bytes);
  EXPECT_EQ(reading.events, 110U);
  EXPECT_THAT(reading.notes, Contains(HasSubstr("its checksum is wrong")));
}

TEST(BagFiles, OthersAreRefusedInOneLine) {
  const test::TempFolder folder;
  const auto error = [&folder](const char* name, const std::string& bytes) {
    return open_bag_source(folder.write(name, bytes), {}).error().message;
  };
  EXPECT_THAT(error("old.bag", "#ROSBAG V1.2\n"),
              HasSubstr("old.bag: a ROS bag of version 1.2; only 2.0 is supported"));
  EXPECT_THAT(error("short.bag", "#ROSBAG V2.0\n"), HasSubstr("short.bag: an empty or damaged ROS bag"));
  EXPECT_THAT(error("next.mcap", "\x89MCAP1\r\n"), HasSubstr("next.mcap: an MCAP file of version 1"));
  EXPECT_THAT(error("empty.mcap", "\x89MCAP0\r\n"), HasSubstr("the bag holds no messages"));
  EXPECT_THAT(error("other.db3", "SQLite format 3"),
              HasSubstr("other.db3: not a ROS 2 bag, or a damaged one"));
  EXPECT_THAT(error("a.db3.zstd", "\x28\xb5\x2f\xfd"), HasSubstr("a.db3.zstd: cannot be unpacked"));
  EXPECT_THAT(error("nothing.bag", ""), HasSubstr("nothing.bag: is empty; expected a ROS 1 bag"));
}

TEST(BagFiles, DevicesAndPipesAreRefused) {
  const test::TempFolder folder;
  fs::create_symlink("/dev/zero", folder.path() / "zero.bag");
  EXPECT_THAT(open_bag_source(folder.path() / "zero.bag", {}).error().message, HasSubstr("zero.bag"));
  ASSERT_EQ(::mkfifo((folder.path() / "metadata.yaml").c_str(), 0600), 0);
  EXPECT_FALSE(open_source(folder.path()).ok());
}

TEST(BagFiles, AFileThatAFolderNamesAThousandTimesIsOneFile) {
  const test::TempFolder folder;
  std::string names = "&name gone_0.db3";
  for (int i = 0; i < 1000; ++i) names += ", *name";
  folder.write("metadata.yaml", "rosbag2_bagfile_information:\n  relative_file_paths: [" + names + "]\n");
  EXPECT_THAT(open_source(folder.path()).error().message, HasSubstr("gone_0.db3"));
  folder.write("metadata.yaml", "rosbag2_bagfile_information:\n  relative_file_paths: [&a [], *a]\n");
  EXPECT_THAT(open_source(folder.path()).error().message, HasSubstr("metadata.yaml:2"));
  folder.write("metadata.yaml",
               "rosbag2_bagfile_information: {relative_file_paths: [" + std::string(400, 'x') + "]}\n");
  EXPECT_THAT(open_source(folder.path()).error().message, HasSubstr("File name too long"));
}

TEST(BagFiles, AFolderSaysWhichOfItsFilesAreMissing) {
  const test::TempFolder folder;
  folder.write("metadata.yaml", "rosbag2_bagfile_information:\n  relative_file_paths: [gone_0.db3]\n");
  EXPECT_THAT(open_source(folder.path()).error().message, HasSubstr("gone_0.db3 is missing"));
  folder.write("metadata.yaml", "rosbag2_bagfile_information: [\n");
  EXPECT_THAT(open_source(folder.path()).error().message, HasSubstr("metadata.yaml:2"));
}

}  // namespace
}  // namespace waymark
