#include "waymark/ekf/existence_update.hpp"

#include <gtest/gtest.h>

namespace waymark::ekf {
namespace {

/// Three landmarks without identity: ahead within range, ahead beyond it, and behind.
class ThreeTentativeLandmarks : public testing::Test {
 protected:
  ThreeTentativeLandmarks() {
    for (const double x_m : {5.0, 15.0, -5.0}) {
      const LandmarkRecord record{
          .id = map_.table().unused_id(), .identity = Identity::kUnknown, .existence = Existence{}};
      map_.append({x_m, 0.0}, 1e-4 * Eigen::Matrix2d::Identity(), {}, record);
    }
  }

  void scan(std::initializer_list<int> observed) {
    map_.table().begin_scan();
    for (const int landmark : observed) map_.table().observe(landmark);
    nearby_.refresh(map_, Eigen::Vector2d::Zero());
    update_existence(map_, nearby_, observation_, model_, sensor_);
  }
  [[nodiscard]] const Existence& existence(int landmark) const { return map_.table()[landmark].existence; }

  LandmarkSensor sensor_{.max_range_m = 10.0, .field_of_view_deg = 180.0, .detection_probability = 0.9};
  AssociationModel model_{{}, sensor_};
  SensorBiasStates errors_{SensorErrors{}};
  PointMap map_{{.capacity = 8}, errors_.pairs(), 1};
  PointObservation observation_{map_.state(), errors_, Pose2{}};
  NearbyLandmarks nearby_{10.0};
};

TEST_F(ThreeTentativeLandmarks, WhatIsObservedIsSurer) {
  scan({0});
  EXPECT_DOUBLE_EQ(existence(0).log_odds(), model_.seen());
  scan({0});
  EXPECT_TRUE(existence(0).is_confirmed());
  EXPECT_GT(map_.sigma_m(0), 0.0);
}

TEST_F(ThreeTentativeLandmarks, WhatShouldHaveBeenObservedIsLessSure) {
  scan({});
  EXPECT_DOUBLE_EQ(existence(0).log_odds(), model_.missed());
  EXPECT_EQ(existence(1).log_odds(), 0.0) << "out of range";
  EXPECT_EQ(existence(2).log_odds(), 0.0) << "behind";
}

TEST_F(ThreeTentativeLandmarks, WhatMayBeOutOfViewIsNotMissed) {
  map_.state().predict({{}, Eigen::Vector3d(4.0, 4.0, 0.0).asDiagonal()});
  scan({});
  EXPECT_EQ(existence(0).log_odds(), 0.0);
}

TEST_F(ThreeTentativeLandmarks, WhatIsCertainIsNotMissed) {
  map_.table().existence(0) = Existence::certain();
  scan({});
  EXPECT_TRUE(existence(0).is_certain());
}

TEST_F(ThreeTentativeLandmarks, FalseTracksAndStaleOnesGo) {
  scan({});
  remove_false_tracks(map_);
  ASSERT_EQ(map_.table().size(), 2);
  map_.table().travel(2.0 * kTentativeDistance_m);
  map_.table().existence(1).confirm();
  remove_false_tracks(map_);
  EXPECT_EQ(map_.table().size(), 1);
  EXPECT_TRUE(map_.table().is_in_map(0));
}

}  // namespace
}  // namespace waymark::ekf
