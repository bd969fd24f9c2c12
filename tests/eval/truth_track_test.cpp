#include "workbench/eval/truth_track.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "eval/eval_support.hpp"

namespace waymark::eval {
namespace {

using test::truth_at;

TEST(TruthTrack, SortsAndKeepsTheFirstOfEqualStamps) {
  const TruthTrack track({truth_at(2, 2, 0), truth_at(1, 1, 0), truth_at(2, 9, 9), truth_at(0, 0, 0)});
  ASSERT_EQ(track.samples().size(), 3u);
  EXPECT_EQ(track.samples()[0].truth.x_m, 0.0);
  EXPECT_EQ(track.samples()[2].truth.x_m, 2.0);
}

TEST(TruthTrack, DropsWhatIsNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const TruthTrack track({truth_at(0, nan, 0), truth_at(1, 1, 0, nan), truth_at(2, 2, 0)});
  ASSERT_EQ(track.samples().size(), 1u);
  EXPECT_EQ(track.samples()[0].truth.x_m, 2.0);
}

TEST(TruthTrack, InterpolatesHeadingThroughPi) {
  const TruthTrack track({truth_at(0.0, 0, 0, 3.1), truth_at(0.1, 1, 2, -3.1)});
  const auto truth = track.at(stamp_from_seconds(0.05));
  ASSERT_TRUE(truth);
  EXPECT_NEAR(truth->x_m, 0.5, 1e-12);
  EXPECT_NEAR(truth->y_m, 1.0, 1e-12);
  EXPECT_NEAR(std::abs(*truth->theta_rad), kPi, 1e-12);
}

TEST(TruthTrack, RefusesHolesAndTheOutside) {
  const TruthTrack track({truth_at(0.0, 0, 0), truth_at(0.1, 1, 0), truth_at(0.5, 2, 0)});
  EXPECT_TRUE(track.at(stamp_from_seconds(0.05)));
  EXPECT_FALSE(track.at(stamp_from_seconds(0.3)));
  EXPECT_TRUE(track.at(stamp_from_seconds(0.3), std::chrono::milliseconds(400)));
  EXPECT_FALSE(track.at(stamp_from_seconds(-0.01)));
  EXPECT_FALSE(track.at(stamp_from_seconds(0.51)));
  EXPECT_TRUE(track.at(stamp_from_seconds(0.5))) << "a sample itself is no hole";
}

TEST(TruthTrack, HasNoHeadingNextToAHeadinglessSample) {
  const TruthTrack track({truth_at(0.0, 0, 0, 1.0), truth_at(0.1, 1, 0)});
  EXPECT_TRUE(track.at(stamp_from_seconds(0.0))->theta_rad);
  EXPECT_FALSE(track.at(stamp_from_seconds(0.05))->theta_rad);
}

TEST(TruthTrack, TakesOnlyTruthFromEvents) {
  const std::vector<Event> events{{stamp_from_seconds(0), Velocity{1, 0}},
                                  {stamp_from_seconds(1), Truth{3, 4, 0.5}}};
  const TruthTrack track = TruthTrack::from_events(events);
  ASSERT_EQ(track.samples().size(), 1u);
  EXPECT_EQ(pose_of(track.samples()[0].truth), (Pose2{3, 4, 0.5}));
}

TEST(TruthTrack, EmptyTrackKnowsNothing) { EXPECT_FALSE(TruthTrack().at(Stamp{})); }

}  // namespace
}  // namespace waymark::eval
