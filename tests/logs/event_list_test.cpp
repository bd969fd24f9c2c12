#include "workbench/logs/event_list.hpp"

#include <gtest/gtest.h>

namespace waymark {
namespace {

Event at(double s, double v_mps) { return {stamp_from_seconds(s), Velocity{v_mps, 0.0}}; }

TEST(EventList, GivesEventsInTheOrderOfTimeAndOfTheListAtOneStamp) {
  EventList log({}, {at(2.0, 3.0), at(1.0, 1.0), at(1.0, 2.0)}, {"a note"});
  EXPECT_EQ(log.progress(), 0.0);
  for (const double v_mps : {1.0, 2.0, 3.0}) {
    const auto event = log.next().value();
    ASSERT_TRUE(event.has_value());
    EXPECT_EQ(std::get<Velocity>(event->content).v_mps, v_mps);
  }
  EXPECT_FALSE(log.next().value().has_value());
  EXPECT_EQ(log.progress(), 1.0);
  EXPECT_EQ(log.notes(), std::vector<std::string>{"a note"});
}

TEST(EventList, WithoutEventsIsAtItsEnd) {
  EventList log({}, {});
  EXPECT_FALSE(log.next().value().has_value());
  EXPECT_EQ(log.progress(), 1.0);
}

}  // namespace
}  // namespace waymark
