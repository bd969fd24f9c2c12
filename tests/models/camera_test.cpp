#include "waymark/models/camera.hpp"

#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "support/matrix_near.hpp"
#include "support/numeric_jacobian.hpp"
#include "support/poses.hpp"

#include "random_camera.hpp"

namespace waymark {
namespace {

using test::matrix_near;
using test::numeric_jacobian;
using test::random_camera;
using test::random_pixel;

// Of pixels by metres at some hundred pixels of focal length.
constexpr double kJacobianTolerance = 1e-4;

Eigen::Vector3d random_point_ahead(RandomStream& random) {
  const double depth_m = random.uniform(0.5, 10.0);
  return {depth_m * random.uniform(-0.5, 0.5), depth_m * random.uniform(-0.4, 0.4), depth_m};
}

TEST(CameraMount, WithoutAnglesLooksAheadWithLevelRows) {
  const Eigen::Matrix3d R = CameraMount{}.R_robot_camera();
  EXPECT_TRUE(matrix_near(R.col(0), -Eigen::Vector3d::UnitY(), 1e-15));  // right
  EXPECT_TRUE(matrix_near(R.col(1), -Eigen::Vector3d::UnitZ(), 1e-15));  // down
  EXPECT_TRUE(matrix_near(R.col(2), Eigen::Vector3d::UnitX(), 1e-15));   // ahead
}

TEST(CameraMount, PitchLooksDownYawLooksLeftAndRollDropsTheRight) {
  const auto axis = [](const CameraMount& mount, int column) -> Eigen::Vector3d {
    return mount.R_robot_camera().col(column);
  };
  EXPECT_TRUE(matrix_near(axis({.pitch_deg = 90.0}, 2), -Eigen::Vector3d::UnitZ(), 1e-15));
  EXPECT_TRUE(matrix_near(axis({.yaw_deg = 90.0}, 2), Eigen::Vector3d::UnitY(), 1e-15));
  EXPECT_TRUE(matrix_near(axis({.roll_deg = 90.0}, 0), -Eigen::Vector3d::UnitZ(), 1e-15));
}

TEST(Camera, SeesWhatIsRightOfTheAxisOnTheRightAndWhatIsHighAbove) {
  const Camera camera;
  const auto pose = camera.pose({1.0, 2.0, kPi / 2.0});  // looks along the world's y axis
  const Eigen::Vector3d right_and_high(1.5, 5.0, 1.0);
  const auto image = camera.project(pose.R_camera_world * (right_and_high - pose.p_world_camera));
  ASSERT_TRUE(image);
  EXPECT_NEAR(image->pixel.x(), 159.5 + 277.0 * 0.5 / 3.0, 1e-9);
  EXPECT_NEAR(image->pixel.y(), 119.5 - 277.0 * 0.7 / 3.0, 1e-9);
}

TEST(Camera, ProjectsAsThePlumbBobFormula) {
  CameraOptions o;
  o.distortion = {-0.2, 0.05, 0.001, -0.002, 0.01};
  const double x = 0.3, y = -0.2, s = x * x + y * y;
  const double g = 1.0 - 0.2 * s + 0.05 * s * s + 0.01 * s * s * s;
  const auto image = Camera(o).project({2.0 * x, 2.0 * y, 2.0});
  ASSERT_TRUE(image);
  EXPECT_NEAR(image->pixel.x(), 159.5 + 277.0 * (g * x + 0.002 * x * y - 0.002 * (s + 2.0 * x * x)), 1e-9);
  EXPECT_NEAR(image->pixel.y(), 119.5 + 277.0 * (g * y + 0.001 * (s + 2.0 * y * y) - 0.004 * x * y), 1e-9);
}

TEST(Camera, ProjectionJacobianAgreesWithCentralDifferences) {
  RandomStream random(1, StreamPurpose::kWorld);
  for (int i = 0; i < 300; ++i) {
    const Camera camera(random_camera(random));
    const Eigen::Vector3d p = random_point_ahead(random);
    const auto image = camera.project(p);
    ASSERT_TRUE(image);
    const auto pixel_of = [&](const Eigen::Vector3d& q) { return camera.project(q)->pixel; };
    EXPECT_TRUE(matrix_near(image->dpixel_dpoint, numeric_jacobian(pixel_of, p), kJacobianTolerance));
  }
}

TEST(Camera, RayIsTheInverseOfTheProjection) {
  RandomStream random(2, StreamPurpose::kWorld);
  for (int i = 0; i < 300; ++i) {
    const Camera camera(random_camera(random));
    const Eigen::Vector2d pixel = random_pixel(camera, random);
    const auto ray = camera.ray(pixel);
    ASSERT_TRUE(ray);
    EXPECT_TRUE(matrix_near(camera.project(3.0 * ray->xy.homogeneous())->pixel, pixel, 1e-9));
    const auto ray_of = [&](const Eigen::Vector2d& p) { return camera.ray(p)->xy; };
    EXPECT_TRUE(matrix_near(ray->dxy_dpixel, numeric_jacobian(ray_of, pixel, 1e-4), 1e-7));
  }
}

TEST(Camera, SeesNothingBehindIt) {
  EXPECT_FALSE(Camera().project({0.1, 0.1, -1.0}));
  EXPECT_FALSE(Camera().project({0.1, 0.1, 0.0}));
  EXPECT_FALSE(Camera().project({0.1, 0.1, std::nan("")}));
}

TEST(Camera, SeesNothingWhereTheLensPolynomialTurnsBack) {
  CameraOptions o;
  o.distortion.k1 = -0.3;  // r (1 - 0.3 r^2) rises to r = 1.05 and is at most 0.70
  const Camera camera(o);
  EXPECT_TRUE(camera.project({1.0, 0.0, 1.0}));
  EXPECT_FALSE(camera.project({1.1, 0.0, 1.0}));
  EXPECT_FALSE(camera.ray({159.5 + 0.75 * 277.0, 119.5}));
  const auto ray = camera.ray({159.5 + 0.69 * 277.0, 119.5});
  ASSERT_TRUE(ray);
  EXPECT_LT(ray->xy.x(), 1.054);
}

TEST(Camera, ImageEndsAtTheCentresOfItsOuterPixels) {
  const Camera camera;
  EXPECT_TRUE(camera.sees({0.0, 0.0}));
  EXPECT_TRUE(camera.sees({319.0, 239.0}));
  EXPECT_FALSE(camera.sees({319.1, 10.0}));
  EXPECT_FALSE(camera.sees({10.0, -0.1}));
  EXPECT_FALSE(camera.sees({7.9, 100.0}, 8.0));
  EXPECT_FALSE(camera.sees({std::nan(""), 100.0}));
}

TEST(Camera, PoseIsThatOfTheMountOnTheRobotWithItsDerivatives) {
  RandomStream random(3, StreamPurpose::kWorld);
  for (int i = 0; i < 100; ++i) {
    const CameraOptions o = random_camera(random);
    const Camera camera(o);
    const Pose2 T_world_robot = test::random_pose(random);
    const auto pose = camera.pose(T_world_robot);
    const Eigen::Matrix3d R_world_robot =
        Eigen::AngleAxisd(T_world_robot.theta_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    EXPECT_TRUE(
        matrix_near(pose.R_camera_world.transpose(), R_world_robot * o.mount.R_robot_camera(), 1e-12));
    const auto centre_of = [&](const Eigen::Vector3d& x) {
      return camera.pose(test::to_pose(x)).p_world_camera;
    };
    EXPECT_TRUE(
        matrix_near(pose.dp_dpose, numeric_jacobian(centre_of, test::to_vector(T_world_robot)), 1e-7));
    const auto turned_of = [&](const Eigen::Matrix<double, 1, 1>& th) -> Eigen::Vector3d {
      return camera.pose({0.0, 0.0, th[0]}).R_camera_world * Eigen::Vector3d(1.0, 2.0, 3.0);
    };
    const Eigen::Matrix<double, 1, 1> th(T_world_robot.theta_rad);
    EXPECT_TRUE(matrix_near(pose.dR_camera_world_dth * Eigen::Vector3d(1.0, 2.0, 3.0),
                            numeric_jacobian(turned_of, th), 1e-7));
  }
}

/// All rotations, those at the poles of roll, pitch and yaw among them, and with few digits.
TEST(CameraMount, ExpressesEveryRotation) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  const auto expect_same = [](const Eigen::Quaterniond& q) {
    const Eigen::Matrix3d R = q.normalized().toRotationMatrix();
    const CameraMount mount = camera_mount(R, {1.0, 2.0, 3.0});
    ASSERT_LT((mount.R_robot_camera() - R).cwiseAbs().maxCoeff(), 2e-9) << q.coeffs().transpose();
    ASSERT_EQ(mount.p_robot_camera(), Eigen::Vector3d(1.0, 2.0, 3.0));
  };
  for (int i = 0; i < 10'000; ++i)
    expect_same({normal(random), normal(random), normal(random), normal(random)});
  const Eigen::Quaterniond ahead(CameraMount{}.R_robot_camera());
  for (const double pitch_deg : {-90.0, 90.0})
    for (int yaw_deg = -180; yaw_deg <= 180; yaw_deg += 15)
      for (const double off_rad : {0.0, 1e-12, 1e-10, 1e-9, 1e-8, 1e-6, 1e-4}) {
        const Eigen::Quaterniond q =
            Eigen::AngleAxisd(to_radians(yaw_deg), Eigen::Vector3d::UnitZ()) *
            Eigen::AngleAxisd(to_radians(pitch_deg) + off_rad, Eigen::Vector3d::UnitY()) * ahead;
        expect_same(q);
        const Eigen::Vector4d rounded = (q.coeffs() * 1e3).array().round();
        expect_same(Eigen::Quaterniond(rounded));
      }
}

}  // namespace
}  // namespace waymark
