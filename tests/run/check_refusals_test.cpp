#include "workbench/run/check_refusals.hpp"

#include <gtest/gtest.h>

namespace waymark {
namespace {

/// A run in which landmark 3 has these outcomes one after the other, a second apart, and others are matched.
std::vector<Recording::TimedInnovation> run_with(const std::vector<Outcome>& outcomes) {
  std::vector<Recording::TimedInnovation> innovations;
  const auto add = [&](int second, int id, Outcome outcome) {
    Innovation innovation;
    innovation.landmark = {LandmarkId::Family::kMarker, id};
    innovation.outcome = outcome;
    innovations.push_back({stamp_from_seconds(second), innovation});
  };
  for (int i = 0; i < static_cast<int>(outcomes.size()); ++i) {
    add(i, 3, outcomes[static_cast<std::size_t>(i)]);
    for (const int id : {1, 2, 7}) add(i, id, Outcome::kMatched);
  }
  return innovations;
}

std::vector<Outcome> times(int count, Outcome outcome) {
  return std::vector<Outcome>(static_cast<std::size_t>(count), outcome);
}

TEST(CheckRefusals, NamesALandmarkThatIsRefusedAgainAndAgain) {
  auto outcomes = times(20, Outcome::kMatched);
  for (int i = 0; i < 12; ++i) outcomes.push_back(i % 2 == 0 ? Outcome::kGated : Outcome::kDistrusted);
  const auto lines = describe_refused_landmarks(run_with(outcomes), stamp_from_seconds(5.0));
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_TRUE(lines[0].starts_with("landmark 3: 12 of 12 observations refused since 15.00 s")) << lines[0];
}

TEST(CheckRefusals, NamesALandmarkThatTheFilterPutElsewhere) {
  auto outcomes = times(20, Outcome::kMatched);
  outcomes.insert(outcomes.end(), 2, Outcome::kGated);
  outcomes.push_back(Outcome::kAdded);
  outcomes.insert(outcomes.end(), 50, Outcome::kMatched);
  EXPECT_EQ(describe_refused_landmarks(run_with(outcomes), {}).size(), 1U);
}

TEST(CheckRefusals, SaysNothingOfAFalseFirstObservation) {
  std::vector<Outcome> outcomes{Outcome::kAdded, Outcome::kGated, Outcome::kGated, Outcome::kAdded};
  outcomes.insert(outcomes.end(), 50, Outcome::kMatched);
  EXPECT_TRUE(describe_refused_landmarks(run_with(outcomes), {}).empty());
}

TEST(CheckRefusals, SaysNothingOfAFewMisreadings) {
  auto outcomes = times(100, Outcome::kMatched);
  for (const std::size_t wild : {10, 20, 21, 40, 50, 60, 70, 80, 85, 90, 95})
    outcomes[wild] = Outcome::kGated;
  EXPECT_TRUE(describe_refused_landmarks(run_with(outcomes), {}).empty());
}

TEST(CheckRefusals, BlamesNoLandmarkWhereMostAreRefused) {
  auto innovations = run_with(times(20, Outcome::kGated));
  for (auto& each : innovations) each.innovation.outcome = Outcome::kGated;
  const auto lines = describe_refused_landmarks(innovations, {});
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_TRUE(lines[0].starts_with("observations of 4 of 4 landmarks")) << lines[0];
}

}  // namespace
}  // namespace waymark
