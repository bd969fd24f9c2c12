#include "workbench/sim/faults.hpp"

#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "workbench/sim/simulation.hpp"

namespace waymark::sim {
namespace {

struct Log {
  std::vector<std::pair<Stamp, Observation>> observations;
  std::vector<std::pair<Stamp, Truth>> truth;
  std::vector<std::pair<Stamp, WheelAngles>> wheels;
  LogInfo info;
};

Log simulate(const FaultOptions& faults, std::uint64_t seed = 1) {
  SimOptions options = *scenario("study");
  options.faults = faults;
  auto simulation = Simulation::make("study", options, seed);
  Log log;
  while (auto event = *(*simulation)->next()) {
    if (const auto* seen = std::get_if<Observations>(&event->content))
      for (const Observation& each : *seen) log.observations.emplace_back(event->stamp, each);
    if (const auto* truth = std::get_if<Truth>(&event->content)) log.truth.emplace_back(event->stamp, *truth);
    if (const auto* wheels = std::get_if<WheelAngles>(&event->content))
      log.wheels.emplace_back(event->stamp, *wheels);
  }
  log.info = (*simulation)->info();
  return log;
}

bool same(const Observation& a, const Observation& b) {
  const auto& x = std::get<RangeBearing>(a.value);
  const auto& y = std::get<RangeBearing>(b.value);
  return a.id == b.id && x.range_m == y.range_m && x.bearing_rad == y.bearing_rad;
}

/// Stamps and identities of those that differ.
std::vector<std::pair<Stamp, LandmarkId>> differing(const Log& a, const Log& b) {
  std::vector<std::pair<Stamp, LandmarkId>> differ;
  EXPECT_EQ(a.observations.size(), b.observations.size());
  for (std::size_t i = 0; i < std::min(a.observations.size(), b.observations.size()); ++i)
    if (!same(a.observations[i].second, b.observations[i].second))
      differ.emplace_back(a.observations[i].first, *a.observations[i].second.id);
  return differ;
}

TEST(SimFaults, FirstObservationsOfAShareOfTheLandmarksAreFalse) {
  const Log clean = simulate({});
  std::map<LandmarkId, Stamp> first;
  for (const auto& [stamp, seen] : clean.observations) first.emplace(*seen.id, stamp);
  for (const auto& [share, count] : {std::pair(0.001, 1.0),
                                     {0.5, std::round(0.5 * static_cast<double>(first.size()))},
                                     {1.0, static_cast<double>(first.size())}}) {
    const auto differ = differing(simulate({.false_first_share = share}), clean);
    EXPECT_EQ(static_cast<double>(differ.size()), count) << share;
    for (const auto& [stamp, id] : differ) EXPECT_EQ(stamp, first.at(id));
  }
}

TEST(SimFaults, AShareOfAllObservationsIsFalseByMuch) {
  const Log clean = simulate({});
  const Log spoilt = simulate({.outlier_share = 0.1});
  const double share =
      static_cast<double>(differing(spoilt, clean).size()) / static_cast<double>(clean.observations.size());
  EXPECT_NEAR(share, 0.1, 0.015);  // three standard deviations of 3800 draws
  for (std::size_t i = 0; i < clean.observations.size(); ++i) {
    const auto& a = std::get<RangeBearing>(spoilt.observations[i].second.value);
    const auto& b = std::get<RangeBearing>(clean.observations[i].second.value);
    EXPECT_TRUE(a.range_m == b.range_m || a.bearing_rad == b.bearing_rad);
    EXPECT_GE(a.range_m / b.range_m, 0.3 - 1e-9);
    EXPECT_LE(a.range_m / b.range_m, 3.0 + 1e-9);
    if (a.bearing_rad != b.bearing_rad) {
      EXPECT_GE(std::abs(wrap_angle(a.bearing_rad - b.bearing_rad)), kPi / 6.0 - 1e-9);
    }
  }
}

TEST(SimFaults, TheTwinLeavesOutJustWhatWouldBeFalse) {
  const FaultOptions faults{.false_first_share = 0.2, .outlier_share = 0.1};
  FaultOptions omitted = faults;
  omitted.omit = true;
  const Log spoilt = simulate(faults);
  const Log twin = simulate(omitted);
  const Log clean = simulate({});
  EXPECT_EQ(twin.observations.size() + differing(spoilt, clean).size(), clean.observations.size());
  std::size_t at = 0;
  for (std::size_t i = 0; i < clean.observations.size(); ++i)
    if (same(spoilt.observations[i].second, clean.observations[i].second)) {
      EXPECT_TRUE(same(twin.observations[at++].second, clean.observations[i].second));
    }
}

TEST(SimFaults, ALandmarkIsCarriedThatIsSeenBeforeAndAfter) {
  constexpr double kAt_s = 88.0;
  const Log clean = simulate({});
  const Log log = simulate({.landmark_carried_at_s = kAt_s});
  std::vector<LandmarkId> moved;
  for (std::size_t k = 0; k < clean.info.landmarks.size(); ++k) {
    const TrueLandmark& a = clean.info.landmarks[k];
    const TrueLandmark& b = log.info.landmarks[k];
    if (a.x_m == b.x_m && a.y_m == b.y_m) continue;
    moved.push_back(a.id);
    EXPECT_NEAR(std::hypot(a.x_m - b.x_m, a.y_m - b.y_m), 2.0, 1e-12);
  }
  ASSERT_EQ(moved.size(), 1U);
  int before = 0;
  int after = 0;
  for (const auto& [stamp, seen] : log.observations)
    if (seen.id == moved[0]) (to_seconds(stamp) < kAt_s ? before : after) += 1;
  EXPECT_GE(before, 10);
  EXPECT_GE(after, 10);
  const Log twin = simulate({.landmark_carried_at_s = kAt_s, .omit = true});
  EXPECT_EQ(twin.observations.size() + static_cast<std::size_t>(after), log.observations.size());
  EXPECT_EQ(twin.info.landmarks[0].x_m, clean.info.landmarks[0].x_m);
}

TEST(SimFaults, ARobotIsCarriedAndFindsBackToItsPath) {
  constexpr double kAt_s = 40.0;
  const Log clean = simulate({});
  const Log log = simulate({.robot_carried_at_s = kAt_s});
  ASSERT_EQ(clean.truth.size(), log.truth.size());
  for (std::size_t i = 0; i < log.truth.size(); ++i) {
    const auto& [stamp, a] = log.truth[i];
    const Truth& b = clean.truth[i].second;
    const double off_m = std::hypot(a.x_m - b.x_m, a.y_m - b.y_m);
    const double after_s = to_seconds(stamp) - kAt_s;
    if (after_s < 0.0) {
      EXPECT_EQ(off_m, 0.0);
    } else if (after_s > 0.0 && after_s < 0.5) {
      EXPECT_NEAR(off_m, 2.0, 0.3);
    } else if (after_s > 60.0) {
      EXPECT_LT(off_m, 0.2);
    }
  }
  // The wheels know nothing of it.
  for (std::size_t i = 1; i < log.wheels.size(); ++i)
    EXPECT_LT(std::abs(log.wheels[i].second.left_rad - log.wheels[i - 1].second.left_rad), 0.3);
}

}  // namespace
}  // namespace waymark::sim
