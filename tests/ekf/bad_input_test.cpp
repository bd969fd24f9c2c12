// What a filter must live through: it never stops, and its belief stays finite and a covariance.

#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "support/circle_world.hpp"
#include "waymark/core/gaussian.hpp"
#include "waymark/ekf/ekf_slam.hpp"

namespace waymark {
namespace {

using test::CircleWorld;

class BadInput : public testing::TestWithParam<ekf::Consistency> {
 protected:
  void drive(int steps) {
    for (int i = 0; i < steps; ++i) {
      filter_.predict(world_.move());
      filter_.correct(world_.look());
    }
  }

  void expect_sound() const {
    EXPECT_TRUE(filter_.state().mean().allFinite());
    EXPECT_TRUE(is_covariance(filter_.state().covariance()));
  }

  /// After whatever happened, good observations are still taken in.
  void expect_alive() {
    expect_sound();
    filter_.predict(world_.move());
    EXPECT_GT(filter_.correct(world_.look()).count(Outcome::kMatched), 0);
    expect_sound();
  }

  static Observation sight(int id, double range_m, double bearing_rad, double variance) {
    return {LandmarkId{LandmarkId::Family::kMarker, id}, RangeBearing{range_m, bearing_rad},
            Eigen::Matrix2d(variance * Eigen::Matrix2d::Identity())};
  }

  CircleWorld world_{11};
  EkfSlam filter_{{GetParam(), 8}, world_.sensor()};
};

TEST_P(BadInput, TwoObservationsOfOneLandmarkInOneScan) {
  drive(20);
  std::vector<Observation> scan = world_.look();
  scan.push_back(world_.sight(2));
  Observation contradiction = world_.sight(2);
  std::get<RangeBearing>(contradiction.value).range_m += 5.0;
  scan.insert(scan.begin(), contradiction);
  const auto& correction = filter_.correct(scan);
  EXPECT_EQ(correction.innovations.front().outcome, Outcome::kGated);
  EXPECT_EQ(correction.innovations[3].outcome, Outcome::kMatched)
      << "a refused observation does not stand for its landmark";
  EXPECT_EQ(correction.innovations.back().outcome, Outcome::kDuplicate);
  expect_alive();
}

TEST_P(BadInput, ObservationsThatContradictEachOtherWithinTheirGates) {
  drive(3);
  filter_.predict({{}, 4.0 * Eigen::Matrix3d::Identity()});
  std::vector<Observation> scan = world_.look();
  for (std::size_t i = 0; i < scan.size(); ++i)
    std::get<RangeBearing>(scan[i].value).range_m += i % 2 == 0 ? 1.0 : -1.0;
  EXPECT_GT(filter_.correct(scan).count(Outcome::kMatched), 4);
  expect_sound();
}

TEST_P(BadInput, AnInnovationCovarianceThatIsSingular) {
  const Observation exact = sight(0, 2.0, 0.1, 0.0);
  EXPECT_EQ(filter_.correct({&exact, 1}).innovations[0].outcome, Outcome::kAdded);
  EXPECT_EQ(filter_.correct({&exact, 1}).innovations[0].outcome, Outcome::kUnusable);
  filter_.predict(world_.move());
  for (int i = 0; i < 5; ++i) {  // exact again and again: the first one leaves nothing to learn
    filter_.correct({&exact, 1});
    expect_sound();
  }
}

TEST_P(BadInput, ObservationsOfImpossiblePrecision) {
  drive(20);
  for (int i = 0; i < 20; ++i) {
    std::vector<Observation> scan = world_.look();
    for (Observation& observation : scan) *observation.covariance *= 1e-12;
    filter_.predict(world_.move());
    filter_.correct(scan);
    expect_sound();
  }
}

TEST_P(BadInput, ACovarianceThatIsNone) {
  drive(20);
  const Eigen::VectorXd before = filter_.state().mean();
  for (const double variance :
       {-1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    Observation observation = world_.sight(1);
    *observation.covariance *= variance;
    EXPECT_EQ(filter_.correct({&observation, 1}).innovations[0].outcome, Outcome::kUnusable);
    EXPECT_EQ(filter_.state().mean(), before);
  }
  expect_alive();
}

TEST_P(BadInput, ALandmarkAtTheRobotsOwnPosition) {
  drive(20);
  const Observation touching = sight(99, 0.0, 0.0, 1e-4);
  EXPECT_EQ(filter_.correct({&touching, 1}).innovations[0].outcome, Outcome::kUnusable);
  // Drive the sensor onto a landmark of the map: its direction is not defined there.
  const Pose2 T_world_sensor = filter_.pose().T_world_robot * world_.mount();
  const Eigen::Vector2d landmark = T_world_sensor.inverse() * filter_.state().landmark(0).head<2>().eval();
  const Eigen::Vector2d jump = rotation_matrix(world_.mount().theta_rad) * landmark;
  filter_.predict({{jump.x(), jump.y(), 0.0}, 1e-6 * Eigen::Matrix3d::Identity()});
  const Observation seen = sight(0, 0.01, 0.3, 1e-4);
  EXPECT_EQ(filter_.correct({&seen, 1}).innovations[0].outcome, Outcome::kUnusable);
  expect_sound();
}

TEST_P(BadInput, OdometryThatTeleports) {
  drive(20);
  filter_.predict({{1e6, -1e6, 3.0}, 1e-4 * Eigen::Matrix3d::Identity()});
  filter_.correct(world_.look());
  EXPECT_EQ(filter_.correct(world_.look()).count(Outcome::kMatched), 8);  // where the landmarks say
  EXPECT_EQ(filter_.faults().recoveries(), 1);
  expect_sound();
  filter_.predict({{1.0, 0.0, 0.0}, 1e6 * Eigen::Matrix3d::Identity()});
  filter_.correct(world_.look());
  expect_sound();
}

TEST_P(BadInput, OdometryThatIsNoNumber) {
  drive(20);
  const Eigen::VectorXd before = filter_.state().mean();
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    filter_.predict({{bad, 0.0, 0.0}, Eigen::Matrix3d::Identity()});
    filter_.predict({{}, bad * Eigen::Matrix3d::Ones()});
    EXPECT_EQ(filter_.state().mean(), before);
  }
  expect_alive();
}

TEST_P(BadInput, EverNewLandmarksInAFullMap) {
  drive(5);
  for (int i = 0; i < 300; ++i) {
    filter_.predict(world_.move());
    std::vector<Observation> scan{world_.sight(0), world_.sight(1)};
    scan.push_back(world_.sight(5));
    scan.back().id->number = 100 + i;
    EXPECT_EQ(filter_.correct(scan).innovations.back().outcome, Outcome::kAdded);
    EXPECT_EQ(filter_.state().landmarks(), 8);
  }
  expect_alive();
}

INSTANTIATE_TEST_SUITE_P(AllModes, BadInput,
                         testing::Values(ekf::Consistency::kInvariant, ekf::Consistency::kFej,
                                         ekf::Consistency::kStandard));

}  // namespace
}  // namespace waymark
