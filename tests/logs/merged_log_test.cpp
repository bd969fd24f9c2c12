#include "workbench/logs/merged_log.hpp"

#include <sstream>

#include <gmock/gmock.h>

#include "support/io_support.hpp"

namespace waymark {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TextTable table_of(std::string text, std::string name) {
  return TextTable::from(TextLines(std::move(text), std::move(name)),
                         {"stamp_s,value", TableLayout::Separator::kBlank, ""})
      .value();
}

std::optional<EventContent> read_velocity(TextTable& row, Tally&) { return Velocity{row.number(1), 0.0}; }
std::optional<EventContent> read_range(TextTable& row, Tally&) {
  return Observations{{std::nullopt, Range{row.number(1)}, std::nullopt}};
}

MergedLog merge(std::string velocities, std::string ranges,
                EventStream::BackInTime back_in_time = EventStream::BackInTime::kRefuse) {
  std::vector<EventStream> streams;
  streams.emplace_back(table_of(std::move(velocities), "v"), read_velocity, back_in_time);
  streams.emplace_back(table_of(std::move(ranges), "r"), read_range, back_in_time);
  return {LogInfo{}, std::move(streams), {"a note"}};
}

/// "v1" for a velocity of 1, "r1+2" for ranges of 1 and 2 m.
std::string name(const Event& event) {
  std::ostringstream text;
  if (const auto* velocity = std::get_if<Velocity>(&event.content)) text << 'v' << velocity->v_mps;
  if (const auto* observations = std::get_if<Observations>(&event.content))
    for (const auto& observation : *observations)
      text << (text.tellp() == 0 ? 'r' : '+') << std::get<Range>(observation.value).range_m;
  return text.str();
}

std::vector<std::string> names(const std::vector<Event>& events) {
  std::vector<std::string> all;
  for (const auto& event : events) all.push_back(name(event));
  return all;
}

TEST(MergedLog, OrdersByStampAndEqualStampsByStream) {
  auto log = merge("1 1\n2 2\n4 4\n", "0 0\n2 2\n3 3\n");
  EXPECT_THAT(names(test::read_all(log).events), ElementsAre("r0", "v1", "v2", "r2", "r3", "v4"));
}

TEST(MergedLog, ObservationsOfOneStampAreOneEvent) {
  auto log = merge("", "1 1\n1 2\n1 3\n2 4\n");
  EXPECT_THAT(names(test::read_all(log).events), ElementsAre("r1+2+3", "r4"));
}

TEST(MergedLog, OdometryOfOneStampStaysApartAndIsCounted) {
  auto log = merge("1 1\n1 2\n2 3\n", "");
  EXPECT_THAT(names(test::read_all(log).events), ElementsAre("v1", "v2", "v3"));
  EXPECT_THAT(log.notes(), ElementsAre("a note", "rows of v with the same stamp as the row before: 1"));
}

TEST(MergedLog, RowsThatGoBackInTimeAreRefusedOrSkipped) {
  auto refusing = merge("2 2\n1 1\n3 3\n", "");
  EXPECT_THAT(test::read_all(refusing).error,
              HasSubstr("v:2: stamp 1.000000000 is before 2.000000000 in line 1"));
  auto skipping = merge("2 2\n1 1\n3 3\n", "", EventStream::BackInTime::kSkip);
  EXPECT_THAT(names(test::read_all(skipping).events), ElementsAre("v2", "v3"));
  EXPECT_THAT(skipping.notes(), ElementsAre("a note", "rows of v skipped that go back in time: 1"));
}

TEST(MergedLog, ErrorComesAfterTheEventsBeforeItAndStays) {
  auto log = merge("1 1\n2 x\n", "");
  const auto delivered = test::read_all(log);
  EXPECT_THAT(names(delivered.events), ElementsAre("v1"));
  EXPECT_THAT(delivered.error, HasSubstr("v:2: 'x' is not a number"));
  EXPECT_FALSE(log.next().ok());
}

TEST(MergedLog, ProgressGoesFromAlmostNothingToOne) {
  auto log = merge("1 1\n2 2\n3 3\n4 4\n5 5\n", "");
  EXPECT_LT(log.progress(), 0.5);
  test::read_all(log);
  EXPECT_EQ(log.progress(), 1.0);
}

TEST(MergedLog, EndStaysTheEnd) {
  auto log = merge("", "");
  EXPECT_TRUE(test::read_all(log).events.empty());
  EXPECT_FALSE(log.next().value().has_value());
}

}  // namespace
}  // namespace waymark
