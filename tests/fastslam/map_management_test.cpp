#include "waymark/fastslam/map_management.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "known_map.hpp"

namespace waymark::fastslam {
namespace {

FastSlamOptions small() {
  FastSlamOptions options;
  options.particles = 30;
  options.capacity = 5;
  options.unknown.emplace();
  return options;
}

constexpr LandmarkSensor kScanner{
    .max_range_m = 10.0, .field_of_view_deg = 180.0, .detection_probability = 0.9};

class MapManagementTest : public testing::Test {
 protected:
  /// A scan that shows one new landmark; what it was named.
  LandmarkId initialise(const Observation& observation) {
    next_scan();
    const std::vector<Observation> observations{observation};
    scan_.begin(observations);
    if (observation.id) scan_.innovations[0].landmark = *observation.id;
    map_.initialise(0, scan_, history_, belief_);
    return scan_.innovations[0].landmark;
  }
  void next_scan() {
    belief_.landmarks.begin_scan();
    history_.scan();
  }

  Belief belief_{small(), kScanner, 1};
  ViewHistory history_{kScanner};
  Scan scan_;
  MapManagement map_{small(), SensorModel(kScanner, 1.0)};
};

TEST_F(MapManagementTest, ALandmarkBeginsAsWhatItsFirstObservationAllows) {
  initialise(test::range_bearing(4.0, 0.0, test::marker(7)));
  initialise(test::range_alone(4.0, test::marker(8)));
  EXPECT_EQ(belief_.store.form(0), kernels::LandmarkForm::kPoint);
  EXPECT_NEAR(belief_.store.at(0, 3).mean.x(), 4.0, 1e-5);
  EXPECT_EQ(belief_.store.form(1), kernels::LandmarkForm::kRing);
  EXPECT_GT(belief_.store.modes(1), 1U);
  EXPECT_EQ(belief_.landmarks.find(test::marker(8)), 1);
  EXPECT_EQ(belief_.landmarks[1].observations, 1);
  EXPECT_EQ(belief_.records[1].range_alone_m, 4.0);
  EXPECT_EQ(map_.room(belief_), 3);
}

TEST_F(MapManagementTest, LandmarksWithoutIdentityAreNamedAndTentative) {
  const LandmarkId first = initialise(test::range_bearing(4.0, 0.0));
  const LandmarkId second = initialise(test::range_bearing(4.0, 1.0));
  EXPECT_NE(first, second);
  EXPECT_FALSE(belief_.landmarks.is_in_map(0));
  EXPECT_EQ(belief_.store.existence(0)[2], 0.0F);
}

TEST_F(MapManagementTest, ChoicesOfParticlesLeaveRoomForWhatIsNewToAll) {
  for (const Eigen::Vector2d& p_world :
       std::vector<Eigen::Vector2d>{{4.0, 0.0}, {0.0, 5.0}, {0.0, -5.0}, {9.0, 0.0}})
    test::add_point(belief_, p_world);
  const SensorModel sensor(kScanner, 1.0);
  const InnovationGate gate({}, sensor);
  ParticleMatcher matcher(AssociationModel({}, kScanner), sensor, belief_.blocks);
  ScanUpdate update({}, belief_.blocks);
  next_scan();
  const std::vector<Observation> observations{test::range_bearing(4.0, 0.0), test::range_bearing(4.02, 0.0),
                                              test::range_bearing(8.0, -1.0)};
  scan_.begin(observations);
  for (Innovation& innovation : scan_.innovations) innovation.outcome = Outcome::kUnidentified;
  matcher.match(scan_, gate, map_.room(belief_), belief_);
  ASSERT_TRUE(scan_.is(2, Outcome::kAdded));
  ASSERT_TRUE(matcher.match_ambiguous(scan_, gate, 0, belief_).empty());
  update.begin();
  matcher.split(scan_, update, belief_);
  ASSERT_EQ(scan_.count(Outcome::kAdded), 2);

  map_.initialise_choices(scan_, matcher, belief_);
  map_.initialise(2, scan_, history_, belief_);
  EXPECT_EQ(belief_.store.size(), 5);
  EXPECT_EQ(map_.room(belief_), 0);
  EXPECT_EQ(scan_.count(Outcome::kMapFull), 1);
}

TEST_F(MapManagementTest, HypothesesThatWereExpectedAndNotSeenBecomeLessLikely) {
  initialise(test::range_alone(4.0, test::marker(1)));
  const auto weight_ahead = [this] {
    belief_.store.gather(0);
    const auto view = belief_.view(0);
    return view.modes[view.mode_count / 2].log_weight[0];
  };
  next_scan();
  const float before = weight_ahead();
  map_.miss(belief_);
  EXPECT_LT(weight_ahead(), before);
  const float missed = weight_ahead();
  belief_.landmarks.claim(0);
  map_.miss(belief_);
  EXPECT_EQ(weight_ahead(), missed);
}

TEST_F(MapManagementTest, ForgetsWhatNoParticleBelievesInAndWhatASingleObservationLeftBehind) {
  initialise(test::range_bearing(4.0, 0.0));
  const LandmarkId tentative = initialise(test::range_bearing(4.0, 1.0));
  initialise(test::range_alone(4.0, test::marker(1)));
  belief_.landmarks.existence(0).confirm();
  belief_.records[0].existence_probability = 0.0;
  next_scan();
  map_.delete_false_tracks(belief_);
  ASSERT_EQ(belief_.landmarks.size(), 2);
  EXPECT_EQ(belief_.landmarks.removed().size(), 1U);
  belief_.landmarks.travel(2.0 * kTentativeDistance_m);
  map_.delete_false_tracks(belief_);
  ASSERT_EQ(belief_.landmarks.size(), 1);
  EXPECT_NE(belief_.landmarks[0].id, tentative);
  // The ring that took the index of others is still one whose hypotheses can be missed.
  next_scan();
  belief_.store.gather(0);
  const auto view = belief_.view(0);
  const float before = view.modes[view.mode_count / 2].log_weight[0];
  map_.miss(belief_);
  EXPECT_LT(view.modes[view.mode_count / 2].log_weight[0], before);
}

}  // namespace
}  // namespace waymark::fastslam
