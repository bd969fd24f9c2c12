// A camera carried over a desk (Davison's sequence for MonoSLAM): corners cut in one image are found in the
// next one, and the corners of a known target where its camera model says.
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/data_dir.hpp"
#include "support/spread_corners.hpp"
#include "waymark/vision/search.hpp"
#include "waymark/vision/subpixel.hpp"

#include "workbench/eval/median.hpp"
#include "workbench/logs/image_file.hpp"

namespace waymark::vision {
namespace {

constexpr int kPatch_px = 16;

GreyImage read(const std::string& name) {
  auto image = read_image(test::data_path("monoslam-desk/" + name));
  EXPECT_TRUE(image.ok()) << image.error().message;
  return image.ok() ? *std::move(image) : GreyImage();
}

GreyImage frame(int number) {
  std::array<char, 32> name{};
  (void)std::snprintf(name.data(), name.size(), "frames/rawoutput%04d.pgm", number);
  return read(name.data());
}

Eigen::Matrix2d isotropic(double sigma_px) { return sigma_px * sigma_px * Eigen::Matrix2d::Identity(); }

/// Where what is at a place of one image is in another one, searched for around `predicted`.
std::optional<Eigen::Vector2d> follow(const ImageView& from, const Eigen::Vector2d& place,
                                      const ImageView& to, const Eigen::Vector2d& predicted) {
  constexpr double kPrediction_px = 3.0;
  const auto patch = cut_patch(from, static_cast<int>(std::lround(place.x())),
                               static_cast<int>(std::lround(place.y())), kPatch_px);
  // Its camera is noisier and shakes more than what SearchOptions takes for granted.
  Search search({.accept_ratio = 4.0});
  const auto match = patch ? search.find(to, *patch, predicted, isotropic(kPrediction_px)) : std::nullopt;
  if (!match || !match->accepted) return std::nullopt;
  return Eigen::Vector2d(match->u, match->v);
}

struct Followed {
  int looked_for = 0, found = 0, found_back = 0;
  Eigen::Vector2d motion = Eigen::Vector2d::Zero();  ///< median of those found
};

/// The corners of one image in the next one, which is expected to move as the image before did; and back.
Followed follow_corners(const ImageView& first, const ImageView& second, const Eigen::Vector2d& motion) {
  constexpr double kMargin_px = 30.0;
  constexpr double kSamePlace_px = 1.5;
  Followed followed;
  std::vector<double> du, dv;
  for (const Corner& corner : test::spread_corners(first)) {
    const Eigen::Vector2d place(corner.u, corner.v);
    const bool is_inside = place.minCoeff() > kMargin_px && place.x() < first.width_px - kMargin_px &&
                           place.y() < first.height_px - kMargin_px;
    if (!is_inside) continue;
    ++followed.looked_for;
    const auto found = follow(first, place, second, place + motion);
    if (!found) continue;
    ++followed.found;
    du.push_back(found->x() - place.x());
    dv.push_back(found->y() - place.y());
    const auto back = follow(second, *found, first, *found - motion);
    followed.found_back += back && (*back - place).norm() <= kSamePlace_px;
  }
  followed.motion = {eval::median(du).value_or(0.0), eval::median(dv).value_or(0.0)};
  return followed;
}

TEST(Desk, CornersAreFoundAgainInTheNextImage) {
  WAYMARK_REQUIRE_DATA("monoslam-desk");
  Followed all;
  GreyImage before = frame(0);
  for (int i = 1; i < 30; ++i) {
    GreyImage now = frame(i);
    const Followed step = follow_corners(before, now, all.motion);
    all.looked_for += step.looked_for;
    all.found += step.found;
    all.found_back += step.found_back;
    all.motion = step.motion;
    before = std::move(now);
  }
  std::printf("desk: %d corners, %.1f %% found in the next image, %.1f %% of these lead back\n",
              all.looked_for, 100.0 * all.found / all.looked_for, 100.0 * all.found_back / all.found);
  EXPECT_GT(all.looked_for, 29 * 15);
  EXPECT_GE(all.found, 0.9 * all.looked_for);
  EXPECT_GE(all.found_back, 0.95 * all.found);
}

/// The camera of the sequence: x left, y up, z ahead, and one radial term.
Eigen::Vector2d project(const Eigen::Vector3d& p_camera) {
  constexpr double kFocal_px = 195.0;
  constexpr double kRadial = 9e-6;  // 1/px^2
  const Eigen::Vector2d undistorted = -kFocal_px * p_camera.head<2>() / p_camera.z();
  return Eigen::Vector2d(162.0, 125.0) +
         undistorted / std::sqrt(1.0 + 2.0 * kRadial * undistorted.squaredNorm());
}

TEST(Desk, CornersOfTheTargetAreFoundWhereTheCameraModelExpectsThem) {
  WAYMARK_REQUIRE_DATA("monoslam-desk");
  constexpr double kDistance_m = 0.6;
  constexpr double kPosition_m = 0.02;    // standard deviation of the first pose
  constexpr double kThreeSigma = 0.9889;  // what MonoSLAM searches
  const std::array<Eigen::Vector2d, 4> target{
      Eigen::Vector2d(0.13477, 0.04074), {-0.04632, 0.04324}, {0.13555, -0.08827}, {-0.04969, -0.08697}};
  const GreyImage camera_image = frame(0);
  const double sigma_px = std::hypot(195.0 * kPosition_m / kDistance_m, 1.0);
  for (int k = 0; k < 4; ++k) {
    const GreyImage shown = read("init/known_patch" + std::to_string(k) + ".pgm");
    const auto patch = cut_patch(shown, shown.width_px() / 2, shown.height_px() / 2, shown.width_px());
    ASSERT_TRUE(patch.has_value());
    const Eigen::Vector2d& corner = target[static_cast<std::size_t>(k)];
    const Eigen::Vector2d predicted = project({corner.x(), corner.y(), kDistance_m});
    Search search({.probability = kThreeSigma});
    const auto match = search.find(camera_image, *patch, predicted, isotropic(sigma_px));
    ASSERT_TRUE(match.has_value()) << k;
    EXPECT_LE((Eigen::Vector2d(match->u, match->v) - predicted).norm(), 2.0)
        << k << ": " << match->u << ", " << match->v << " for " << predicted.transpose();
  }
}

}  // namespace
}  // namespace waymark::vision
