#include "waymark/models/undistortion_table.hpp"

#include <gtest/gtest.h>

#include "support/matrix_near.hpp"

#include "random_camera.hpp"

namespace waymark {
namespace {

TEST(UndistortionTable, IsTheExactRayToAHundredthOfAPixel) {
  RandomStream random(1, StreamPurpose::kWorld);
  for (int i = 0; i < 20; ++i) {
    const CameraOptions o = test::random_camera(random);
    const Camera camera(o);
    const UndistortionTable table(camera);
    for (int k = 0; k < 300; ++k) {
      const Eigen::Vector2d pixel = test::random_pixel(camera, random);
      EXPECT_TRUE(test::matrix_near(o.fu_px * table(pixel), o.fu_px * camera.ray(pixel)->xy, 0.01)) << i;
    }
  }
}

TEST(UndistortionTable, HoldsAtTheCornersAndBeyond) {
  const Camera camera;
  const UndistortionTable table(camera);
  EXPECT_TRUE(test::matrix_near(table({319.0, 239.0}), camera.ray({319.0, 239.0})->xy, 1e-9));
  EXPECT_TRUE(test::matrix_near(table({400.0, -5.0}), camera.ray({319.0, 0.0})->xy, 1e-9));
}

TEST(UndistortionTable, IsNothingWhereNoRayEnds) {
  CameraOptions o;
  o.distortion.k1 = -1.2;  // the image's corners lie beyond what this lens can show
  EXPECT_TRUE(UndistortionTable(Camera(o))({0.0, 0.0}).hasNaN());
}

}  // namespace
}  // namespace waymark
