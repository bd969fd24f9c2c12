#include "waymark/fastslam/scan.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "known_map.hpp"

namespace waymark::fastslam {
namespace {

TEST(Scan, AMatchClaimsTheLandmarkAndRemembersWhenItWasClaimedBefore) {
  LandmarkTable table(5);
  table.begin_scan();
  table.append({.id = test::marker(7)});
  table.begin_scan();
  const std::vector<Observation> observations(2);
  Scan scan;
  scan.begin(observations);
  scan.match(1, 0, table);
  EXPECT_EQ(scan.landmarks, (std::vector<int>{Scan::kNone, 0}));
  EXPECT_EQ(scan.innovations[1].landmark, test::marker(7));
  EXPECT_TRUE(scan.is(1, Outcome::kMatched));
  EXPECT_EQ(scan.last_claims[1], 1);
  EXPECT_TRUE(table.is_claimed(0));
}

TEST(Scan, OnlyWhatIsOfALandmarkMakesALaterOneADuplicate) {
  const std::vector<Observation> observations(3);
  Scan scan;
  scan.begin(observations);
  for (Innovation& innovation : scan.innovations) innovation.landmark = test::marker(3);
  EXPECT_FALSE(scan.has_before(2, test::marker(3)));
  scan.innovations[0].outcome = Outcome::kAdded;
  EXPECT_TRUE(scan.has_before(2, test::marker(3)));
  EXPECT_FALSE(scan.has_before(0, test::marker(3)));
  EXPECT_FALSE(scan.has_before(2, test::marker(4)));
}

TEST(Scan, TheNextOneForgetsWhatBecameOfTheLast) {
  const std::vector<Observation> observations(3);
  Scan scan;
  scan.begin(observations);
  scan.innovations[2].outcome = Outcome::kGated;
  scan.landmarks[2] = 4;
  EXPECT_TRUE(scan.any(Outcome::kGated));
  scan.begin(observations);
  EXPECT_EQ(scan.count(Outcome::kGated), 0);
  EXPECT_EQ(scan.landmarks[2], Scan::kNone);
}

}  // namespace
}  // namespace waymark::fastslam
