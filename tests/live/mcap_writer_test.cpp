#include "workbench/live/mcap_writer.hpp"

#include <filesystem>

#include <gtest/gtest.h>

#include "support/stamps.hpp"

#include "workbench/bags/open_bag.hpp"

namespace waymark::live {
namespace {

using test::at;

std::string path(const char* name) { return testing::TempDir() + "/" + name; }

McapWriter writer(const std::string& file) {
  auto opened = McapWriter::open(file);
  EXPECT_TRUE(opened.ok());
  return *std::move(opened);
}

/// What our reader finds, which public writers' files are read by.
std::vector<std::string> messages_in(const std::string& file, std::vector<std::string>* notes = nullptr) {
  auto bag = bag::open_bag(file).value();
  std::vector<std::string> found;
  while (const auto message = bag->next()) found.emplace_back(message->bytes);
  if (notes != nullptr) *notes = bag->notes();
  return found;
}

TEST(McapWriter, WritesWhatIsRead) {
  const std::string file = path("whole.mcap");
  McapWriter mcap = writer(file);
  const auto text = mcap.add({"/text", "json", "Text", "jsonschema", "{}"});
  const auto more = mcap.add({"/more", "json", "", "", ""});
  for (int i = 0; i < 10; ++i) mcap.write(i % 3 == 0 ? more : text, at(i), at(i), std::to_string(i));
  ASSERT_TRUE(mcap.flush().ok());
  for (int i = 10; i < 20; ++i) mcap.write(text, at(i), at(i), std::string(300'000, 'x'));
  ASSERT_TRUE(mcap.close().ok());

  const auto bag = bag::open_bag(file).value();
  const bag::Summary& summary = bag->summary();
  ASSERT_EQ(summary.topics.size(), 2U);
  EXPECT_EQ(summary.topics[0].name, "/text");
  EXPECT_EQ(summary.topics[0].messages, 16);
  EXPECT_EQ(summary.topics[1].messages, 4);
  EXPECT_EQ(*summary.first, at(0));
  EXPECT_EQ(*summary.last, at(19));
  std::vector<std::string> notes;
  const auto found = messages_in(file, &notes);
  ASSERT_EQ(found.size(), 20U);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(found[static_cast<std::size_t>(i)], std::to_string(i));
  EXPECT_TRUE(notes.empty());
}

TEST(McapWriter, LeavesWhatWasFlushedWhereWritingBreaksOff) {
  const std::string file = path("whole2.mcap"), cut = path("cut.mcap");
  {
    McapWriter mcap = writer(file);
    const auto text = mcap.add({"/text", "json", "", "", ""});
    for (int i = 0; i < 5; ++i) mcap.write(text, at(i), at(i), "kept");
    ASSERT_TRUE(mcap.flush().ok());
    std::filesystem::copy_file(file, cut, std::filesystem::copy_options::overwrite_existing);
    mcap.write(text, at(9), at(9), "lost");
    ASSERT_TRUE(mcap.close().ok());
  }
  EXPECT_EQ(messages_in(file).size(), 6U);
  EXPECT_EQ(messages_in(cut), std::vector<std::string>(5, "kept"));
}

TEST(McapWriter, SaysThatTheDiskIsFull) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  McapWriter mcap = writer("/dev/full");
  const auto text = mcap.add({"/text", "json", "", "", ""});
  mcap.write(text, at(1), at(1), "x");
  const auto flushed = mcap.flush();
  ASSERT_FALSE(flushed.ok());
  EXPECT_NE(flushed.error().message.find("full"), std::string::npos);
  EXPECT_FALSE(McapWriter::open("/nowhere/at/all.mcap").ok());
}

}  // namespace
}  // namespace waymark::live
