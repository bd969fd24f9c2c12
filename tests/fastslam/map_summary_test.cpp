#include "waymark/fastslam/map_summary.hpp"

#include <gtest/gtest.h>

#include "support/matrix_near.hpp"
#include "waymark/core/gaussian.hpp"
#include "waymark/core/random.hpp"

#include "known_map.hpp"

namespace waymark::fastslam {
namespace {

using test::matrix_near;

/// Particles of different weight whose landmarks moved with their poses.
class MapSummaryTest : public testing::Test {
 protected:
  MapSummaryTest() {
    RandomStream random(1, StreamPurpose::kWorld);
    for (int k = 0; k < 2; ++k) test::add_point(belief_, {});
    test::add_point(belief_, {}, Identity::kUnknown);
    for (int i = 0; i < belief_.particles.count(); ++i) {
      const Pose2 robot{random.normal(), random.normal(), 0.1 * random.normal()};
      belief_.particles.set_pose(i, robot);
      belief_.particles.log_weights()[as_index(i)] = random.normal();
      for (int k = 0; k < 2; ++k) {
        const Eigen::Vector2d p_world = robot * Eigen::Vector2d(3.0 + k, 2.0);
        const auto& m = belief_.store.view(k, {0.0, 0.0}).modes->gaussian;
        m.a[i] = static_cast<float>(p_world.x());
        m.b[i] = static_cast<float>(p_world.y());
      }
    }
    EXPECT_TRUE(normalise_weights(belief_.particles, belief_.blocks));
    belief_.update_estimate();
  }

  Belief belief_{{.particles = 60}, {}, 1};
};

TEST_F(MapSummaryTest, IsTheMomentsOfTheMixture) {
  const auto landmarks = summarise_landmarks(belief_);
  const MapState map = summarise(belief_);
  ASSERT_EQ(landmarks.size(), 2U);
  ASSERT_EQ(map.ids.size(), 2U);
  ASSERT_TRUE(is_covariance(map.covariance));
  EXPECT_TRUE(matrix_near(map.covariance.topLeftCorner<3, 3>(), belief_.pose().covariance, 1e-12));
  for (int k = 0; k < 2; ++k) {
    const LandmarkEstimate& landmark = landmarks[as_index(k)];
    EXPECT_EQ(map.ids[as_index(k)], landmark.id);
    EXPECT_TRUE(matrix_near(map.landmarks.segment<2>(2 * k), landmark.position_m.head<2>(), 1e-12));
    EXPECT_TRUE(matrix_near(map.covariance.block<2, 2>(3 + 2 * k, 3 + 2 * k),
                            landmark.covariance.topLeftCorner<2, 2>(), 1e-12));
    EXPECT_NEAR((*landmark.within)(0, 0), static_cast<double>(1e-4F), 1e-12);
  }
  // Landmarks move with the pose that they were seen from: the cross terms are not nothing.
  EXPECT_GT(map.covariance.topRightCorner(3, 4).cwiseAbs().maxCoeff(), 1e-2);
}

TEST_F(MapSummaryTest, TentativeLandmarksAreLeftOutUntilTheyAreConfirmed) {
  belief_.landmarks.existence(2).confirm();
  EXPECT_EQ(summarise_landmarks(belief_).size(), 3U);
  EXPECT_EQ(summarise(belief_).landmarks.size(), 6);
}

TEST_F(MapSummaryTest, FollowsAMotionThatNoParticleHasMade) {
  const Eigen::MatrixXd before = summarise(belief_).covariance;
  belief_.predict({{1.0, 0.0, 0.3}, 1e-6 * Eigen::Matrix3d::Identity()});
  const MapState map = summarise(belief_);
  EXPECT_TRUE(matrix_near(map.covariance.topLeftCorner<3, 3>(), belief_.pose().covariance, 1e-12));
  EXPECT_TRUE(matrix_near(map.covariance.bottomRightCorner(4, 4), before.bottomRightCorner(4, 4), 0.0));
  EXPECT_TRUE(matrix_near(map.covariance.block(2, 3, 1, 4), before.block(2, 3, 1, 4), 0.0));
  EXPECT_EQ(map.T_world_robot, belief_.pose().T_world_robot);
}

}  // namespace
}  // namespace waymark::fastslam
