#include "workbench/run/check_gaps.hpp"

#include <gmock/gmock.h>

#include "support/stamps.hpp"

namespace waymark {
namespace {

using test::at;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::vector<std::string> lines(const std::vector<Event>& events) {
  GapSearch search(2.0);
  for (const Event& event : events) search.add(event);
  return describe(search.found(), events.front().stamp, 2.0);
}

Event speed(double seconds) { return {at(seconds), Velocity{}}; }
Event seen(double seconds) { return {at(seconds), Observations{}}; }

TEST(CheckGaps, FindsNoneInARightLog) {
  EXPECT_THAT(lines({seen(10.0), speed(11.0), speed(12.0), seen(13.0)}), IsEmpty());
}

TEST(CheckGaps, SaysFromWhenToWhenInTimeOfTheLog) {
  EXPECT_THAT(lines({speed(10.0), speed(11.0), seen(14.5)}),
              ElementsAre(AllOf(HasSubstr("odometry is missing from 1.00 s to 4.50 s, the end"),
                                HasSubstr("pipeline.max_hold_s (2 s)"))));
  EXPECT_THAT(lines({seen(10.0), speed(16.0), seen(17.0)}),
              ElementsAre(HasSubstr("odometry is missing from 0.00 s to 6.00 s, longer")));
}

TEST(CheckGaps, NamesTheLongestOfSeveral) {
  EXPECT_THAT(lines({speed(0.0), speed(3.0), speed(8.0), speed(11.0)}),
              ElementsAre(HasSubstr("missing 3 times, 11.0 s in all, the longest from 3.00 s to 8.00 s")));
}

TEST(CheckGaps, TruthAndASecondKindOfOdometryDoNotFillAGap) {
  EXPECT_THAT(lines({speed(0.0), {at(1.0), OdometryPose{}}, {at(2.0), Truth{}}, speed(3.0)}),
              ElementsAre(HasSubstr("from 0.00 s to 3.00 s")));
}

}  // namespace
}  // namespace waymark
