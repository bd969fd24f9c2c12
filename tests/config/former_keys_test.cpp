#include "workbench/config/former_keys.hpp"

#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "workbench/config/schema.hpp"

namespace waymark {
namespace {

using testing::HasSubstr;

std::string migrated(const std::string& yaml) {
  const auto text = migrate_config(yaml, "old.yaml");
  return text ? *text : text.error().message;
}

TEST(FormerKeys, EachStandsOnceAndSaysWhatBecameOfIt) {
  std::set<std::string_view> keys;
  for (const FormerKey& each : former_keys()) {
    EXPECT_TRUE(keys.insert(each.key).second) << each.key;
    EXPECT_NE(each.now.empty(), each.why.empty()) << each.key;
  }
}

TEST(FormerKeys, AreRefusedInOneLine) {
  Schema schema;
  const auto renamed = schema.set("ekf.capacity", "50", "my.yaml:3");
  ASSERT_FALSE(renamed.ok());
  EXPECT_EQ(renamed.error().message,
            "my.yaml:3: ekf.capacity is now map.capacity; `waymark config --migrate FILE` updates a file");
  const auto gone = schema.set("markers.own_thread", "true", "--set");
  ASSERT_FALSE(gone.ok());
  EXPECT_THAT(gone.error().message, HasSubstr("--set: markers.own_thread was removed: always true"));
}

TEST(MigrateConfig, LeavesAFileOfTodayAlone) {
  const std::string today = "# mine\nseed: 3   # lucky\n\nsensor:\n  x_m: 0.1\n";
  EXPECT_EQ(migrated(today), today);
}

TEST(MigrateConfig, PutsWhatIsGoneIntoAComment) {
  EXPECT_EQ(migrated("seed: 3\nmarkers:\n  own_thread: false\n  confirm: 2\n"),
            "seed: 3\n"
            "markers:\n"
            "  # own_thread: false  # markers.own_thread was removed: always true\n"
            "  confirm: 2\n");
}

TEST(MigrateConfig, MovesWhatHasAnotherSection) {
  EXPECT_EQ(migrated("ekf:\n  capacity: 50\n  likelihood: student"),
            "ekf:\n  # capacity: 50  # ekf.capacity is now map.capacity\n  likelihood: student\n"
            "map.capacity: 50\n");
  EXPECT_EQ(migrated("ekf.capacity: 50\n"),
            "# ekf.capacity: 50  # ekf.capacity is now map.capacity\nmap.capacity: 50\n");
}

TEST(MigrateConfig, KeepsOneOfTwoThatBecameOne) {
  EXPECT_THAT(migrated("ekf:\n  capacity: 1000\npixel:\n  capacity: 60\n"),
              HasSubstr("\nmap.capacity: 60\n"));
  EXPECT_THAT(migrated("ekf:\n  capacity: 1000\npixel:\n  capacity: 100\n"),
              testing::Not(HasSubstr("\nmap.capacity")))
      << "nobody had set them";
  EXPECT_EQ(migrated("ekf:\n  capacity: 50\npixel:\n  capacity: 60\n"),
            "old.yaml:4: pixel.capacity is now map.capacity, which this file sets twice, to different "
            "values; keep one of them");
}

TEST(MigrateConfig, RefusesTwoValuesOfOneKeyWhereverTheyStand) {
  const std::string in_place = "pixel:\n  most_candidates: 16\n";
  const std::string from_elsewhere = "tracker:\n  most_candidates: 20\n";
  EXPECT_EQ(migrated(in_place + from_elsewhere),
            "old.yaml:4: tracker.most_candidates is now pixel.max_candidates, which this file sets twice, to "
            "different values; keep one of them");
  EXPECT_THAT(migrated(from_elsewhere + in_place), HasSubstr("old.yaml:4: pixel.most_candidates is now"));
  EXPECT_THAT(migrated("ekf:\n  capacity: 50\nmap:\n  capacity: 60\n"),
              HasSubstr("old.yaml:2: ekf.capacity is now map.capacity, which this file sets twice"))
      << "beside the key of today, before it";
  EXPECT_THAT(migrated("pixel:\n  max_candidates: 16\n  most_candidates: 17\n"),
              HasSubstr("old.yaml:3: pixel.most_candidates is now pixel.max_candidates, which"));
}

TEST(MigrateConfig, WritesAValueOnce) {
  EXPECT_EQ(migrated("pixel:\n  most_candidates: 16\ntracker:\n  most_candidates: 16\n"),
            "pixel:\n  max_candidates: 16\n"
            "tracker:\n  # most_candidates: 16  # tracker.most_candidates is now pixel.max_candidates\n");
  EXPECT_EQ(migrated("ekf.capacity: 60\nmap.capacity: 60\n"),
            "# ekf.capacity: 60  # ekf.capacity is now map.capacity\nmap.capacity: 60\n");
  EXPECT_EQ(migrated("ekf.capacity: 60\npixel.capacity: 60\n"),
            "# ekf.capacity: 60  # ekf.capacity is now map.capacity\n"
            "# pixel.capacity: 60  # pixel.capacity is now map.capacity\nmap.capacity: 60\n");
}

TEST(MigrateConfig, RefusesALineThatHoldsMore) {
  EXPECT_EQ(migrated("ekf: {capacity: 50, likelihood: student}\n"),
            "old.yaml:1: ekf.capacity is now map.capacity; this line holds more than that key, so change it "
            "by hand");
  EXPECT_THAT(migrated("ekf: [1]\n"), HasSubstr("old.yaml:1: ekf cannot be a list"));
}

}  // namespace
}  // namespace waymark
