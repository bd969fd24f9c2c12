#include "workbench/run/input_formats.hpp"

#include <algorithm>
#include <set>

#include <gmock/gmock.h>

#include "support/data_dir.hpp"
#include "support/io_support.hpp"

#include "workbench/run/open_source.hpp"

namespace waymark {
namespace {

using test::TempFolder;
using testing::HasSubstr;
using Place = InputFormat::Place;

TEST(InputFormats, AreNamedApart) {
  std::set<std::string> names;
  for (const InputFormat& format : input_formats())
    EXPECT_TRUE(names.insert(format.name).second) << format.name;
  for (const MatFormat& format : mat_formats()) EXPECT_TRUE(names.insert(format.name).second) << format.name;
}

TEST(InputFormats, AFolderThatIsNoneOfThemIsToldWhatEachThatCanBeOneExpects) {
  const TempFolder folder;
  const std::string error = open_source(folder.path()).error().message;
  for (const InputFormat& format : input_formats()) {
    const bool is_named = error.find(format.expects) != std::string::npos;
    EXPECT_EQ(is_named, format.can_be(Place::kFolder)) << format.name;
  }
}

TEST(InputFormats, AFileThatIsNoneOfThemIsToldAllNames) {
  const TempFolder folder;
  const std::string error = open_source(folder.write("x.bin", "\x01")).error().message;
  for (const InputFormat& format : input_formats()) EXPECT_THAT(error, HasSubstr(format.name));
  for (const MatFormat& format : mat_formats()) EXPECT_THAT(error, HasSubstr(format.name));
}

TEST(InputFormats, NoneRecognisesAnEmptyFolderOrWhatIsNoLog) {
  const TempFolder folder;
  for (const InputFormat& format : input_formats())
    EXPECT_FALSE(format.can_be(Place::kFolder) && format.recognises(folder.path())) << format.name;
  const auto file = folder.write("notes.txt", "no log");
  for (const InputFormat& format : input_formats())
    EXPECT_FALSE(format.can_be(Place::kFile) && format.recognises(file)) << format.name;
}

TEST(InputFormats, OneRecognisesEachPublishedRecording) {
  const auto recognised_by = [](const std::filesystem::path& path) {
    const Place place = std::filesystem::is_directory(path) ? Place::kFolder : Place::kFile;
    std::vector<std::string> names;
    for (const InputFormat& format : input_formats())
      if (format.can_be(place) && format.recognises(path)) names.push_back(format.name);
    return names;
  };
  for (const char* name : {"mrclam1", "uwb-labyrinth", "planar-mono-slam", "victoria-park",
                           "victoria-park/victoria_park.txt", "odom-bags/husky_test1.bag"}) {
    WAYMARK_REQUIRE_DATA(name);
    EXPECT_EQ(recognised_by(test::data_path(name)).size(), 1U) << name;
  }
}

}  // namespace
}  // namespace waymark
