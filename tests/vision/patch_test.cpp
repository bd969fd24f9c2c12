#include "waymark/vision/patch.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include "support/matrix_near.hpp"
#include "support/numeric_jacobian.hpp"

#include "smooth_texture.hpp"

namespace waymark::vision {
namespace {

using test::matrix_near;

const Eigen::Matrix2d kUnwarped = Eigen::Matrix2d::Identity();

GreyImage counted(int width_px, int height_px) {
  GreyImage image(width_px, height_px);
  for (int v = 0; v < height_px; ++v)
    for (int u = 0; u < width_px; ++u) image(u, v) = static_cast<std::uint8_t>(u + 7 * v);
  return image;
}

TEST(Patch, Covers8BeforeAnd7BehindItsPlaceAtSize16) {
  const GreyImage image = counted(40, 30);
  const auto patch = cut_patch(image, 20, 15, 16);
  ASSERT_TRUE(patch);
  EXPECT_EQ((*patch)(0, 0), image(12, 7));
  EXPECT_EQ((*patch)(8, 8), image(20, 15));
  EXPECT_EQ((*patch)(15, 15), image(27, 22));
}

TEST(Patch, IsNothingWhereItLeavesTheImage) {
  const GreyImage image = counted(40, 30);
  EXPECT_TRUE(cut_patch(image, 8, 8, 16));
  EXPECT_FALSE(cut_patch(image, 7, 8, 16));
  EXPECT_TRUE(cut_patch(image, 32, 22, 16));
  EXPECT_FALSE(cut_patch(image, 33, 22, 16));
  EXPECT_FALSE(cut_patch(image, 32, 23, 16));
  EXPECT_TRUE(cut_patch(image, 4, 4, 9));
  EXPECT_FALSE(cut_patch(image, 36, 4, 9));
}

TEST(Warp, OfNothingIsThePatchItself) {
  const GreyImage image = counted(60, 50);
  for (const int size : {8, 9, 16})
    EXPECT_EQ(warp_patch(*cut_reference(image, 30, 25), kUnwarped, size)->pixels,
              cut_patch(image, 30, 25, size)->pixels);
}

TEST(Warp, ShowsWhatAnotherViewSees) {
  RandomStream random(1, StreamPurpose::kWorld);
  for (int i = 0; i < 50; ++i) {
    const test::SmoothTexture texture(random, 6.0);
    const Eigen::Matrix2d A{{random.uniform(0.8, 1.3), random.uniform(-0.3, 0.3)},
                            {random.uniform(-0.3, 0.3), random.uniform(0.8, 1.3)}};
    const Eigen::Vector2d centre(20.0, 20.0);
    const GreyImage then = texture.seen(41, 41, kUnwarped, {0.0, 0.0}, 0.0, random);
    // Pixel p of the new view shows the place whose image was at centre + A^-1 (p - centre).
    const Eigen::Matrix2d then_now = A.inverse();
    const GreyImage now = texture.seen(41, 41, then_now, centre - then_now * centre, 0.0, random);
    const auto warped = warp_patch(*cut_reference(then, 20, 20), A, 16);
    const auto seen = cut_patch(now, 20, 20, 16);
    ASSERT_TRUE(warped);
    double squares = 0.0;
    for (int k = 0; k < 256; ++k)
      squares += std::pow(double{1.0} * warped->pixels[static_cast<std::size_t>(k)] -
                              seen->pixels[static_cast<std::size_t>(k)],
                          2.0);
    EXPECT_LT(std::sqrt(squares / 256.0), 4.0);  // bilinear: a few grey levels where waves are short
  }
}

TEST(Warp, IsNothingWhereTheReferenceIsTooSmall) {
  const auto reference = cut_reference(counted(60, 50), 30, 25);
  EXPECT_TRUE(warp_patch(*reference, 0.6 * kUnwarped, 16));
  EXPECT_FALSE(warp_patch(*reference, 0.4 * kUnwarped, 16));
  EXPECT_FALSE(warp_patch(*reference, Eigen::Matrix2d::Zero(), 16));
}

/// A camera that moved by a step and a turn, and a point on a plane in front of both.
struct TwoCameras {
  explicit TwoCameras(RandomStream& random) {
    CameraOptions options;
    options.distortion = {-0.15, 0.03, 0.001, -0.001, 0.0};
    camera = Camera(options);
    const Eigen::Vector3d axis(random.normal(), random.normal(), random.normal());
    motion.R_now_then = Eigen::AngleAxisd(random.uniform(-0.3, 0.3), axis.normalized()).toRotationMatrix();
    motion.t_now_then = {random.uniform(-0.5, 0.5), random.uniform(-0.3, 0.3), random.uniform(-0.5, 0.5)};
    p_then = {random.uniform(-0.8, 0.8), random.uniform(-0.6, 0.6), random.uniform(2.0, 5.0)};
    normal_then = Eigen::Vector3d(random.uniform(-0.6, 0.6), random.uniform(-0.6, 0.6), -1.0).normalized();
  }

  Camera camera{CameraOptions{}};
  CameraMotion motion;
  Eigen::Vector3d p_then, normal_then;
};

TEST(PlaneWarp, IsTheDerivativeOfTheImageOfThePlane) {
  RandomStream random(2, StreamPurpose::kWorld);
  for (int i = 0; i < 200; ++i) {
    const TwoCameras s(random);
    // The pixel now of the plane's point at a pixel then.
    const auto through_plane = [&](const Eigen::Vector2d& pixel_then) -> Eigen::Vector2d {
      const Eigen::Vector3d ray = s.camera.ray(pixel_then)->xy.homogeneous();
      const Eigen::Vector3d p = ray * (s.normal_then.dot(s.p_then) / s.normal_then.dot(ray));
      return s.camera.project(s.motion.R_now_then * p + s.motion.t_now_then)->pixel;
    };
    const auto A = plane_warp(s.camera, s.p_then, s.normal_then, s.motion);
    ASSERT_TRUE(A);
    const Eigen::Vector2d pixel_then = s.camera.project(s.p_then)->pixel;
    EXPECT_TRUE(matrix_near(*A, test::numeric_jacobian(through_plane, pixel_then, 1e-3), 1e-6));
  }
}

TEST(PlaneWarp, IsTheHomographyOfThePlaneWithoutDistortion) {
  // K (R + t n^T / (n^T X0)) K^-1 and its affine part at the landmark.
  RandomStream random(3, StreamPurpose::kWorld);
  const Camera camera;
  const CameraOptions& o = camera.options();
  const Eigen::Matrix3d K{{o.fu_px, 0.0, o.cu_px}, {0.0, o.fv_px, o.cv_px}, {0.0, 0.0, 1.0}};
  for (int i = 0; i < 100; ++i) {
    const TwoCameras s(random);
    const Eigen::Matrix3d H = K *
                              (s.motion.R_now_then + s.motion.t_now_then * s.normal_then.transpose() /
                                                         s.normal_then.dot(s.p_then)) *
                              K.inverse();
    const Eigen::Vector3d q = H * camera.project(s.p_then)->pixel.homogeneous();
    const Eigen::Matrix2d A = (H.topLeftCorner<2, 2>() - q.head<2>() / q.z() * H.block<1, 2>(2, 0)) / q.z();
    EXPECT_TRUE(matrix_near(*plane_warp(camera, s.p_then, s.normal_then, s.motion), A, 1e-9));
  }
}

TEST(PlaneWarp, GrowsWhenTheCameraComesNearer) {
  const Camera camera;
  const CameraMotion forward{Eigen::Matrix3d::Identity(), {0.0, 0.0, -1.0}};
  const auto A = facing_warp(camera, {0.0, 0.0, 3.0}, forward);
  ASSERT_TRUE(A);
  EXPECT_TRUE(matrix_near(*A, 1.5 * kUnwarped, 1e-12));
  EXPECT_FALSE(facing_warp(camera, {0.0, 0.0, 0.5}, forward));  // now behind the camera
}

TEST(PlaneWarp, MotionIsThatBetweenTwoPoses) {
  const Camera camera;
  const auto then = camera.pose({1.0, 2.0, 0.3}), now = camera.pose({1.5, 1.8, 0.5});
  const auto motion = motion_between(then, now);
  const Eigen::Vector3d p_world(4.0, 3.0, 1.0);
  const Eigen::Vector3d p_then = then.R_camera_world * (p_world - then.p_world_camera);
  EXPECT_TRUE(matrix_near(motion.R_now_then * p_then + motion.t_now_then,
                          now.R_camera_world * (p_world - now.p_world_camera), 1e-12));
}

TEST(WarpedPatch, IsDrawnAnewOnlyWhenTheViewHasChanged) {
  RandomStream random(4, StreamPurpose::kWorld);
  const test::SmoothTexture texture(random);
  const GreyImage image = texture.seen(60, 60, kUnwarped, {0.0, 0.0}, 0.0, random);
  WarpedPatch patch(*cut_reference(image, 30, 30), 16);
  const auto before = patch.patch().pixels;
  EXPECT_EQ(patch.seen_under(1.04 * kUnwarped).pixels, before);
  EXPECT_NE(patch.seen_under(1.3 * kUnwarped).pixels, before);
  const auto enlarged = patch.patch().pixels;
  EXPECT_EQ(patch.seen_under(0.3 * kUnwarped).pixels, enlarged);  // more than the reference holds
  EXPECT_EQ(patch.seen_under(kUnwarped).pixels, before);
}

}  // namespace
}  // namespace waymark::vision
