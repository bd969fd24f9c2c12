#include "waymark/slam/odometry_gaps.hpp"

#include <gmock/gmock.h>

#include "support/stamps.hpp"

namespace waymark {
namespace {

using test::at;
using testing::ElementsAre;
using testing::IsEmpty;

TEST(OdometryGaps, FindsNoneBetweenReadingsThatFollowInTime) {
  OdometryGaps gaps(duration_from_seconds(2.0));
  EXPECT_THAT(gaps.all(), IsEmpty());
  for (int i = 0; i < 10; ++i) gaps.see_reading(at(2.0 * i));
  gaps.see(at(20.0));
  EXPECT_THAT(gaps.all(), IsEmpty());
}

TEST(OdometryGaps, FindsThemBeforeBetweenAndBehindTheReadings) {
  OdometryGaps gaps(duration_from_seconds(2.0));
  gaps.see(at(0.0));
  gaps.see(at(4.0));
  gaps.see_reading(at(5.0));
  gaps.see_reading(at(6.0));
  gaps.see_reading(at(9.0));
  EXPECT_EQ(gaps.known(), at(9.0));
  gaps.see(at(12.0));
  EXPECT_THAT(gaps.all(), ElementsAre(OdometryGap{at(0.0), at(5.0)}, OdometryGap{at(6.0), at(9.0)},
                                      OdometryGap{at(9.0), at(12.0), true}));
}

}  // namespace
}  // namespace waymark
