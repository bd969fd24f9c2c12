#include "waymark/vision/landmark_finder.hpp"

#include <gtest/gtest.h>

#include "waymark/core/random.hpp"
#include "waymark/vision/subpixel.hpp"

#include "squares.hpp"

namespace waymark::vision {
namespace {

const Eigen::Matrix2d kInnovation = 9.0 * Eigen::Matrix2d::Identity();

/// A wall of squares before the camera, and the landmark at (u, v) of its image.
class Finder : public ::testing::Test {
 protected:
  Finder() : random_(1, StreamPurpose::kWorld), image_(test::squares(320, 240, random_)) {}

  [[nodiscard]] Appearance appearance(int u, int v) const {
    return {{}, here_, WarpedPatch(*cut_reference(image_, u, v), 16)};
  }
  [[nodiscard]] Expectation expectation(int u, int v, const Eigen::Vector2d& error) const {
    const Eigen::Vector2d pixel(u, v), xy = camera_.ray(pixel)->xy;
    const Eigen::Vector3d p_camera = 3.0 * Eigen::Vector3d(xy.x(), xy.y(), 1.0);
    return {.predicted_px = pixel + error,
            .S = kInnovation,
            .p_world_m = here_.p_world_camera + here_.R_camera_world.transpose() * p_camera};
  }

  RandomStream random_;
  GreyImage image_;
  Camera camera_;
  CameraPose here_ = camera_.pose({});
};

TEST_F(Finder, FindsAPatchWhereItWasCut) {
  LandmarkFinder finder({}, {}, camera_);
  Appearance known = appearance(150, 100);
  const SearchResult search_result =
      finder.search_for(expectation(150, 100, {2.0, -3.0}), image_, here_, known);
  EXPECT_EQ(search_result.result, SearchRecord::Result::kFound);
  EXPECT_LT((search_result.pixel - Eigen::Vector2d(150.0, 100.0)).norm(), 0.05);
  EXPECT_NEAR(search_result.R.norm(), (kMinPixelSigma * kMinPixelSigma * Eigen::Matrix2d::Identity()).norm(),
              1e-6);
}

TEST_F(Finder, MissesWhatIsElsewhereOnlyWhereTheWholePatchShouldBeSeen) {
  LandmarkFinder finder({}, {}, camera_);
  RandomStream other_random(2, StreamPurpose::kWorld);
  const GreyImage other = test::squares(320, 240, other_random);
  Appearance known = appearance(150, 100), aside = appearance(25, 100);
  EXPECT_EQ(finder.search_for(expectation(150, 100, {0.0, 0.0}), other, here_, known).result,
            SearchRecord::Result::kMissed);
  EXPECT_EQ(finder.search_for(expectation(25, 100, {-20.0, 0.0}), other, here_, aside).result,
            SearchRecord::Result::kNotTried);
  EXPECT_EQ(finder.search_for(expectation(25, 100, {-100.0, 0.0}), other, here_, aside).result,
            SearchRecord::Result::kNotTried);
}

TEST_F(Finder, CostsWhatItExpectedToCost) {
  const WorkCosts costs = work_costs(kernels::Instructions::kSimd);
  LandmarkFinder finder({}, {}, camera_);
  Appearance known = appearance(150, 100);
  const Expectation expected = expectation(150, 100, {1.0, 1.0});
  const SearchResult search_result = finder.search_for(expected, image_, here_, known);
  EXPECT_NEAR(search_result.cost_ns, finder.expected_cost_ns(expected), 10.0 * costs.window_ns);
}

TEST_F(Finder, DrawsThePatchAnewForAnotherViewpointUnlessToldOtherwise) {
  const CameraPose nearer = camera_.pose({1.0, 0.0, 0.0});
  for (const bool warp : {true, false}) {
    LandmarkFinder finder({.warp = warp}, {}, camera_);
    Appearance known = appearance(160, 120);
    static_cast<void>(finder.search_for(expectation(160, 120, {0.0, 0.0}), image_, nearer, known));
    EXPECT_NEAR(known.patch.A()(0, 0), warp ? 1.5 : 1.0, 0.01);
  }
}

TEST_F(Finder, ClaimsLessWhereSomethingElseIsInThePatchToo) {
  LandmarkFinder finder({}, {.accept_ratio = 1e6}, camera_);
  Appearance known = appearance(150, 100), changed = known;
  GreyImage half_hidden = image_;
  for (int v = 92; v < 108; ++v)
    for (int u = 142; u < 148; ++u)
      half_hidden(u, v) = static_cast<std::uint8_t>(random_.uniform(0.0, 255.0));
  const Expectation expected = expectation(150, 100, {0.0, 0.0});
  const SearchResult clear = finder.search_for(expected, image_, here_, known);
  const SearchResult hidden = finder.search_for(expected, half_hidden, here_, changed);
  ASSERT_EQ(hidden.result, SearchRecord::Result::kFound);
  EXPECT_GT(hidden.R.trace(), 2.0 * clear.R.trace());
}

}  // namespace
}  // namespace waymark::vision
