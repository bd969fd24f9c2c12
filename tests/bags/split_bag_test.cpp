#include "workbench/bags/split_bag.hpp"

#include <gmock/gmock.h>

#include "support/io_support.hpp"
#include "support/stamps.hpp"

namespace waymark::bag {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using waymark::test::at;

std::vector<std::string> names(const std::vector<std::filesystem::path>& files) {
  std::vector<std::string> names;
  for (const auto& file : files) names.push_back(file.filename().string());
  return names;
}

TEST(SplitBag, ListsTheBagsOfAFolderAsTheyCount) {
  const waymark::test::TempFolder folder;
  for (const char* name : {"d_10.bag", "d_9.bag", "d_9.orig.bag", "d_11.bag.active", "d.db3", "bag"})
    folder.write(name, "");
  EXPECT_THAT(names(ros1_bags_in(folder.path())), ElementsAre("d_9.bag", "d_10.bag", "d_11.bag.active"));
}

TEST(SplitBag, TheFirstPartStandsForThoseThatGoOnCounting) {
  const waymark::test::TempFolder folder;
  for (const char* name : {"d_2024-05-01_0.bag", "d_2024-05-01_1.bag", "d_2024-05-02_2.bag",
                           "d_2024-05-01_4.bag", "other_1.bag", "whole.bag"})
    folder.write(name, "");
  const auto from = [&folder](const char* name) { return names(parts_from(folder.path() / name)); };
  EXPECT_THAT(from("d_2024-05-01_0.bag"),
              ElementsAre("d_2024-05-01_0.bag", "d_2024-05-01_1.bag", "d_2024-05-02_2.bag"));
  EXPECT_THAT(from("d_2024-05-01_1.bag"), ElementsAre("d_2024-05-01_1.bag"));
  EXPECT_THAT(from("whole.bag"), ElementsAre("whole.bag"));
}

TEST(SplitBag, NamesPartsThatAreMissing) {
  const std::vector<PartSpan> spans{{"d_0.bag", at(0.0), at(20.0)}, {"d_3.bag", at(60.0), at(80.0)}};
  EXPECT_THAT(missing_parts(spans), ElementsAre(HasSubstr("missing between d_0.bag and d_3.bag: 2")));
  EXPECT_EQ(why_not_one(spans), std::nullopt);
  EXPECT_THAT(missing_parts({{"d_0.bag", at(0.0), at(20.0)}, {"d_1.bag", at(20.0), at(40.0)}}), IsEmpty());
}

TEST(SplitBag, BagsOfOneTimeAreOneRecordingAndOthersAreNot) {
  EXPECT_EQ(why_not_one({{"odometry.bag", at(0.0), at(60.0)},
                         {"camera.bag", at(2.0), at(30.0)},
                         {"more.bag", at(65.0), at(70.0)}}),
            std::nullopt);
  const auto apart =
      why_not_one({{"monday_0.bag", at(0.0), at(60.0)}, {"tuesday_1.bag", at(5000.0), at(6000.0)}});
  ASSERT_TRUE(apart.has_value());
  EXPECT_THAT(*apart, HasSubstr("tuesday_1.bag begins 4940 s after monday_0.bag"));
}

}  // namespace
}  // namespace waymark::bag
