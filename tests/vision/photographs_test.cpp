// Matches across photographs whose true geometry is known, with predictions as wrong as a filter's would be.
#include "photographs.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <sstream>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "support/spread_corners.hpp"
#include "waymark/core/random.hpp"
#include "waymark/vision/search.hpp"
#include "waymark/vision/subpixel.hpp"

#include "workbench/logs/files.hpp"

namespace waymark::vision {
namespace {

constexpr double kPredictionSigma_px = 5.0;

/// Where a pixel of the first photograph is in the second, and the affine map around it.
struct TruePlace {
  Eigen::Vector2d pixel;
  Eigen::Matrix2d A = Eigen::Matrix2d::Identity();
};
using Truth = std::function<TruePlace(const Eigen::Vector2d&)>;

Truth same_view() {
  return [](const Eigen::Vector2d& pixel) { return TruePlace{pixel}; };
}

Truth homography(const Eigen::Matrix3d& H) {
  return [H](const Eigen::Vector2d& pixel) {
    const Eigen::Vector3d q = H * pixel.homogeneous();
    const Eigen::Vector2d seen = q.hnormalized();
    return TruePlace{seen, (H.topLeftCorner<2, 2>() - seen * H.block<1, 2>(2, 0)) / q.z()};
  };
}

/// The nine numbers of an OpenCV matrix file.
Eigen::Matrix3d read_matrix(const std::filesystem::path& path) {
  const std::string text = read_file(path).value();
  const std::size_t begin = text.find("<data>") + 6;
  std::istringstream numbers(text.substr(begin, text.find("</data>") - begin));
  Eigen::Matrix3d H;
  for (int k = 0; k < 9; ++k) numbers >> H(k / 3, k % 3);
  return H;
}

struct MatchQuality {
  int searched = 0, accepted = 0, right = 0, accepted_right = 0;

  [[nodiscard]] double right_share() const { return static_cast<double>(right) / searched; }
  [[nodiscard]] double accepted_right_share() const { return static_cast<double>(accepted_right) / accepted; }
};

MatchQuality match(const char* name, const GreyImage& first, const GreyImage& second, const Truth& truth,
                   bool warp, const SearchOptions& options = {}) {
  RandomStream random(1, StreamPurpose::kWorld);
  Search search(options);
  MatchQuality outcome;
  for (const Corner& corner : test::spread_corners(first, {.threshold = 20, .arc = 9})) {
    const TruePlace place = truth(Eigen::Vector2d(corner.u, corner.v));
    const auto reference = cut_reference(first, corner.u, corner.v);
    const bool visible = place.pixel.minCoeff() > 25.0 && place.pixel.x() < second.width_px() - 25.0 &&
                         place.pixel.y() < second.height_px() - 25.0;
    if (!reference || !visible) continue;
    const auto patch = warp_patch(*reference, warp ? place.A : Eigen::Matrix2d::Identity(), 16);
    if (!patch) continue;
    const Eigen::Vector2d predicted =
        place.pixel + kPredictionSigma_px * Eigen::Vector2d(random.normal(), random.normal());
    const Eigen::Matrix2d S = kPredictionSigma_px * kPredictionSigma_px * Eigen::Matrix2d::Identity();
    const auto found = search.find(second, *patch, predicted, S);
    if (!found) continue;
    const auto peak = find_peak(second, *patch, found->u, found->v, options.grey_sigma);
    const Eigen::Vector2d pixel = peak ? peak->pixel : Eigen::Vector2d(found->u, found->v);
    const bool is_right = (pixel - place.pixel).norm() <= 2.0;
    ++outcome.searched;
    outcome.accepted += found->accepted;
    outcome.right += is_right;
    outcome.accepted_right += found->accepted && is_right;
  }
  std::printf("%s: %d searched, %.1f %% within 2 px; %d accepted, %.1f %% of them within 2 px\n", name,
              outcome.searched, 100.0 * outcome.right_share(), outcome.accepted,
              100.0 * outcome.accepted_right_share());
  return outcome;
}

TEST(Photographs, WallFromAnotherViewpointIsMatchedByWarpedPatches) {
  WAYMARK_REQUIRE_DATA("gray-images");
  const Truth truth = homography(read_matrix(test::data_path("gray-images/H1to3p.xml")));
  const GreyImage first = test::photograph("graf1.png"), second = test::photograph("graf3.png");
  const MatchQuality warped = match("graf, warped", first, second, truth, true);
  const MatchQuality plain = match("graf, as cut", first, second, truth, false);
  const MatchQuality article =
      match("graf, warped, match: article", first, second, truth, true, {.match = MatchScore::kArticle});
  EXPECT_GT(warped.right_share(), 0.75);
  EXPECT_GT(warped.accepted_right_share(), 0.8);
  EXPECT_GT(warped.right_share(), 2.0 * plain.right_share());
  EXPECT_LT(plain.accepted, plain.searched / 10) << "what looks different is told";
  EXPECT_GT(article.right_share(), 0.7);
}

TEST(Photographs, SmallMotionIsMatched) {
  WAYMARK_REQUIRE_DATA("gray-images");
  // The scene moves by one to two pixels between the two.
  const MatchQuality outcome = match("rubberwhale", test::photograph("rubberwhale1.png"),
                                     test::photograph("rubberwhale2.png"), same_view(), false);
  EXPECT_GT(outcome.right_share(), 0.9);
  EXPECT_GT(outcome.accepted, outcome.searched * 9 / 10);
}

/// The same image at another exposure, with the noise of a small camera.
GreyImage exposed(const GreyImage& image, double gain, double offset) {
  RandomStream random(2, StreamPurpose::kWorld);
  GreyImage changed(image.width_px(), image.height_px());
  for (int v = 0; v < image.height_px(); ++v) {
    for (int u = 0; u < image.width_px(); ++u) {
      const double grey = gain * image(u, v) + offset + 3.0 * random.normal();
      changed(u, v) = static_cast<std::uint8_t>(std::clamp(std::lround(grey), 0L, 255L));
    }
  }
  return changed;
}

TEST(Photographs, AnotherExposureIsMatched) {
  WAYMARK_REQUIRE_DATA("gray-images");
  const GreyImage first = test::photograph("building.jpg");
  for (const auto& [gain, offset] : {std::pair{1.0, 30.0}, {0.8, 0.0}, {0.6, 20.0}}) {
    const std::string name = "building, gain " + std::to_string(gain) + ", offset " + std::to_string(offset);
    const MatchQuality outcome = match(name.c_str(), first, exposed(first, gain, offset), same_view(), false);
    EXPECT_GT(outcome.right_share(), 0.9) << name;
  }
}

}  // namespace
}  // namespace waymark::vision
