#include "waymark/ekf/pixel_noise.hpp"

#include <cmath>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "support/matrix_near.hpp"
#include "support/numeric_jacobian.hpp"
#include "waymark/core/angle.hpp"
#include "waymark/models/camera.hpp"

namespace waymark::ekf {
namespace {

using test::matrix_near;

TEST(PixelNoise, OfAPixelIsItsOwnOrThatOfTheOptionsAndThatOfTheModel) {
  const PixelNoise noise({.sigma_px = 0.5, .model_sigma_px = 0.2});
  Observation observation{{}, Pixel{1.0, 2.0}, {}};
  EXPECT_TRUE(matrix_near(noise.of(observation), (0.25 + 0.04) * Eigen::Matrix2d::Identity(), 1e-15));
  const Eigen::Matrix2d own{{0.3, 0.1}, {0.1, 0.2}};
  observation.covariance = own;
  EXPECT_TRUE(matrix_near(noise.of(observation), own + 0.04 * Eigen::Matrix2d::Identity(), 1e-15));
}

TEST(PixelNoise, OfASearchIsThatOfAWholePixelAndThatOfTheModel) {
  const PixelNoise noise({.sigma_px = 0.5, .model_sigma_px = 0.2});
  EXPECT_TRUE(matrix_near(noise.of_search(), (1.0 / 12.0 + 0.04) * Eigen::Matrix2d::Identity(), 1e-15));
}

TEST(PixelNoise, AJitterTurnsTheCameraAboutItsXAndItsZAxis) {
  const PixelNoise noise({.jitter_deg = 0.3});
  const Camera camera({.distortion = {.k1 = -0.1}});
  const Eigen::Vector3d p_camera(0.4, -0.3, 2.0);
  const auto image = [&](const Eigen::Vector2d& deviations) -> Eigen::Vector2d {
    const Eigen::Vector2d turned_rad = to_radians(0.3) * deviations;
    const Eigen::Matrix3d R = (Eigen::AngleAxisd(turned_rad[0], Eigen::Vector3d::UnitX()) *
                               Eigen::AngleAxisd(turned_rad[1], Eigen::Vector3d::UnitZ()))
                                  .toRotationMatrix();
    return camera.project(R * p_camera)->pixel;
  };
  const BiasTerms terms = noise.attitude_jitter(p_camera, camera.project(p_camera)->dpixel_dpoint);
  EXPECT_EQ(terms[0].pair, 0);
  EXPECT_FALSE(terms[1].takes_part());
  const Eigen::Vector2d none = Eigen::Vector2d::Zero();
  EXPECT_TRUE(matrix_near(terms[0].J.topRows<2>(), test::numeric_jacobian(image, none, 1e-4), 1e-7));
}

TEST(PixelNoise, AnImageForgetsTheJitterOfTheLastOne) {
  const PixelNoise noise({.jitter_deg = 0.3});
  ASSERT_TRUE(noise.has_jitter());
  State state(3, 1, Consistency::kInvariant, 1, 1);
  noise.begin_image(state);
  EXPECT_EQ(state.bias_covariance(0, 0), Eigen::Matrix2d::Identity());
}

TEST(PixelNoise, ACameraThatIsStillHasNoErrors) {
  const PixelNoise noise({.jitter_deg = 0.0});
  EXPECT_FALSE(noise.has_jitter());
  State state(3, 1, Consistency::kInvariant);
  noise.begin_image(state);
  EXPECT_FALSE(noise.attitude_jitter({0.1, 0.2, 1.0}, Eigen::Matrix<double, 2, 3>::Ones())[0].takes_part());
}

TEST(PixelNoise, APatchWandersWithTheRootOfTheAngleBetweenTwoViews) {
  const PixelNoise noise({.landmark_noise_px = 0.2});
  const Eigen::Vector3d p(3.0, 1.0, 0.5);
  const auto from = [&](double angle_deg, double distance_m) -> Eigen::Vector3d {
    return p + Eigen::AngleAxisd(to_radians(angle_deg), Eigen::Vector3d::UnitZ()) *
                   Eigen::Vector3d(-distance_m, 0.0, 0.0);
  };
  EXPECT_NEAR(noise.process_noise_px2(p, from(0.0, 2.0), from(1.0, 2.0)), 0.04, 1e-12);
  EXPECT_NEAR(noise.process_noise_px2(p, from(-10.0, 2.0), from(15.0, 1.0)), 25.0 * 0.04, 1e-10);
  EXPECT_NEAR(noise.process_noise_px2(p, from(5.0, 2.0), from(5.0, 1.0)), 0.0, 1e-12) << "straight ahead";
}

}  // namespace
}  // namespace waymark::ekf
