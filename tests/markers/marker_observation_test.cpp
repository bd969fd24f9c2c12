#include "waymark/markers/marker_observation.hpp"

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "support/matrix_near.hpp"
#include "support/numeric_jacobian.hpp"
#include "waymark/core/angle.hpp"

#include "drawn_marker.hpp"

namespace waymark::markers {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
constexpr double kMarker_m = 0.2;

MarkerOptions options() { return {.dictionary = "4x4_50", .size_m = kMarker_m, .jitter_deg = 0.0}; }

MarkerObserver make_observer(const MarkerOptions& how) {
  return {Camera(test::marker_camera()), how, *marker_set(how)};
}

/// Independent of the code under test: by way of the robot's frame.
Vector2d range_bearing(const CameraMount& mount, const Vector3d& p_camera) {
  const Vector3d p_robot = mount.R_robot_camera() * p_camera + mount.p_robot_camera();
  const Vector2d from_camera = p_robot.head<2>() - Vector2d(mount.x_m, mount.y_m);
  return {from_camera.norm(),
          wrap_angle(std::atan2(from_camera.y(), from_camera.x()) - to_radians(mount.yaw_deg))};
}

TEST(MarkerObservation, RangeAndBearingAreInThePlaneOfTheRobot) {
  const CameraMount mount = test::marker_camera().mount;
  RandomStream random(1, StreamPurpose::kWorld);
  for (int i = 0; i < 50; ++i) {
    const Vector3d p = test::random_marker_pose(random, 1.0).p_camera_marker;
    EXPECT_TRUE(test::matrix_near(view_in_plane(mount, p).value, range_bearing(mount, p), 1e-12));
  }
}

TEST(MarkerObservation, JacobianIsThatOfTheView) {
  const CameraMount mount = test::marker_camera().mount;
  RandomStream random(2, StreamPurpose::kWorld);
  for (int i = 0; i < 50; ++i) {
    const Vector3d p = test::random_marker_pose(random, 1.0).p_camera_marker;
    const auto numeric = test::numeric_jacobian(
        [&](const Vector3d& at) -> Vector2d { return view_in_plane(mount, at).value; }, p);
    EXPECT_TRUE(test::matrix_near(view_in_plane(mount, p).dvalue_dpoint, numeric, 1e-7));
  }
}

TEST(MarkerObservation, OfADrawnMarkerIsWhereItIs) {
  const CameraOptions lens = test::marker_camera();
  const Camera camera(lens);
  const MarkerObserver observer = make_observer(options());
  RandomStream random(3, StreamPurpose::kWorld);
  for (int i = 0; i < 20; ++i) {
    const MarkerPose pose = test::random_marker_pose(random, 0.9);
    GreyImage image(640, 480, 120);
    test::draw_marker(image, camera, pose, kMarker_m, i);
    const auto seen = observer.observe(image, {i, test::corners_of(camera, pose, kMarker_m)});
    ASSERT_TRUE(std::holds_alternative<Observation>(seen)) << i;
    const auto& observation = std::get<Observation>(seen);
    EXPECT_EQ(observation.id, (LandmarkId{LandmarkId::Family::kMarker, i}));
    const auto& z = std::get<RangeBearing>(observation.value);
    const Vector2d truth = range_bearing(lens.mount, pose.p_camera_marker);
    EXPECT_NEAR(z.range_m, truth[0], 0.01) << i;
    EXPECT_NEAR(z.bearing_rad, truth[1], 0.001) << i;
  }
}

/// Corners with the noise that their covariance tells of: the normalised errors of range and bearing are
/// chi-square with 2 degrees of freedom, near and far, straight on and tilted.
TEST(MarkerObservation, CovarianceIsHonest) {
  const CameraOptions lens = test::marker_camera();
  const Camera camera(lens);
  const MarkerOptions how = options();
  const MarkerObserver observer = make_observer(how);
  RandomStream random(4, StreamPurpose::kWorld);
  constexpr int kDraws = 2000;
  double sum = 0.0;
  for (int i = 0; i < kDraws; ++i) {
    const MarkerPose pose = test::random_marker_pose(random, 0.7);
    RefinedCorners corners{test::corners_of(camera, pose, kMarker_m), 0.3 * CornerCovariance::Identity()};
    const double noise_px = how.side_sigma_px * std::sqrt(0.3);
    for (auto& corner : corners.corners_px) corner += noise_px * Vector2d(random.normal(), random.normal());
    const auto seen = observer.observe(corners, 1);
    ASSERT_TRUE(std::holds_alternative<Observation>(seen));
    const auto& observation = std::get<Observation>(seen);
    const auto& z = std::get<RangeBearing>(observation.value);
    const Vector2d truth = range_bearing(lens.mount, pose.p_camera_marker);
    const Vector2d e(z.range_m - truth[0], wrap_angle(z.bearing_rad - truth[1]));
    sum += e.dot(observation.covariance->inverse() * e);
  }
  EXPECT_NEAR(sum / kDraws, 2.0, 0.35);
}

TEST(MarkerObservation, FarMarkersAreLessCertain) {
  const Camera camera(test::marker_camera());
  const MarkerObserver observer = make_observer(options());
  double last = 0.0;
  for (const double depth_m : {1.0, 2.0, 4.0}) {
    MarkerPose pose;
    pose.p_camera_marker = {0.1, 0.0, depth_m};
    const auto seen =
        observer.observe({test::corners_of(camera, pose, kMarker_m), CornerCovariance::Identity()}, 1);
    const double variance = (*std::get<Observation>(seen).covariance)(0, 0);
    EXPECT_GT(variance, 3.0 * last);
    last = variance;
  }
}

TEST(MarkerObservation, AShakingMountMovesTheBearing) {
  const Camera camera(test::marker_camera());
  MarkerPose pose;
  pose.p_camera_marker = {0.1, 0.0, 2.0};
  const RefinedCorners corners{test::corners_of(camera, pose, kMarker_m),
                               1e-6 * CornerCovariance::Identity()};
  MarkerOptions how = options();
  how.jitter_deg = 0.1;
  const auto seen = make_observer(how).observe(corners, 1);
  EXPECT_NEAR(std::sqrt((*std::get<Observation>(seen).covariance)(1, 1)), to_radians(0.1),
              0.1 * to_radians(0.1));
}

TEST(MarkerObservation, RefusesMarkersSeenEdgeOn) {
  const Camera camera(test::marker_camera());
  const MarkerObserver observer = make_observer(options());
  for (const double tilt_deg : {70.0, 80.0}) {
    MarkerPose pose;
    pose.p_camera_marker = {0.0, 0.0, 1.0};
    pose.R_camera_marker = Eigen::AngleAxisd(to_radians(tilt_deg), Vector3d::UnitY()).toRotationMatrix();
    const auto seen =
        observer.observe({test::corners_of(camera, pose, kMarker_m), CornerCovariance::Identity()}, 1);
    const auto* why = std::get_if<Refusal>(&seen);
    EXPECT_EQ(why != nullptr && *why == Refusal::kEdgeOn, tilt_deg > 75.0) << tilt_deg;
  }
}

TEST(MarkerObservation, RefusesWhatNobodyKnowsTheSizeOf) {
  MarkerOptions how = options();
  how.size_m = 0.0;
  how.sizes_m = "3: 0.2";
  const GreyImage wall(640, 480, 120);
  const auto seen = make_observer(how).observe(wall, {4, {}});
  EXPECT_EQ(std::get<Refusal>(seen), Refusal::kNoSize);
}

TEST(MarkerObservation, AmbiguousPosesAreMixed) {
  const RangeBearingEstimate best{{2.0, 0.1}, Eigen::Matrix2d::Identity() * 1e-4};
  const RangeBearingEstimate other{{2.2, 0.1}, Eigen::Matrix2d::Identity() * 1e-4};
  const RangeBearingEstimate even = mixture(best, other, 0.0);
  EXPECT_NEAR(even.value[0], 2.1, 1e-12);
  EXPECT_NEAR(even.covariance(0, 0), 1e-4 + 0.01, 1e-12);  // half of the distance on either side
  EXPECT_NEAR(even.covariance(1, 1), 1e-4, 1e-12);
  const RangeBearingEstimate clear = mixture(best, other, 100.0);
  EXPECT_EQ(clear.value, best.value);
  EXPECT_EQ(clear.covariance, best.covariance);
}

TEST(MarkerObservation, MixtureGoesTheShortWayRound) {
  const RangeBearingEstimate best{{2.0, kPi - 0.01}, Eigen::Matrix2d::Identity()};
  const RangeBearingEstimate other{{2.0, -kPi + 0.01}, Eigen::Matrix2d::Identity()};
  EXPECT_NEAR(mixture(best, other, 0.0).value[1], kPi, 1e-12);
}

}  // namespace
}  // namespace waymark::markers
