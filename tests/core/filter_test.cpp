#include "waymark/core/filter.hpp"

#include <iterator>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace waymark {
namespace {

constexpr Outcome kOutcomes[] = {Outcome::kMatched,      Outcome::kAdded,     Outcome::kGated,
                                 Outcome::kUnidentified, Outcome::kUnusable,  Outcome::kAmbiguous,
                                 Outcome::kDuplicate,    Outcome::kDeferred,  Outcome::kMapFull,
                                 Outcome::kNotInMap,     Outcome::kDistrusted};

TEST(Correction, CountsInnovationsByOutcome) {
  std::vector<Innovation> innovations;
  for (int i = 0; i < 9; ++i)
    for (int copies = 0; copies < i; ++copies) innovations.push_back({.outcome = kOutcomes[i]});
  const Correction correction{.innovations = innovations, .removed = {}};
  for (int i = 0; i < 9; ++i) EXPECT_EQ(correction.count(kOutcomes[i]), i);
}

TEST(Correction, IsEmptyByDefault) {
  EXPECT_EQ(Correction{}.count(Outcome::kUnusable), 0);
  EXPECT_TRUE(Correction{}.removed.empty());
}

TEST(Outcome, EachHasItsOwnDescription) {
  std::set<std::string> descriptions;
  for (const Outcome outcome : kOutcomes) descriptions.insert(describe(outcome));
  EXPECT_EQ(descriptions.size(), std::size(kOutcomes));
  EXPECT_FALSE(descriptions.contains("unknown"));
}

}  // namespace
}  // namespace waymark
