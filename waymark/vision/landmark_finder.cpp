#include "waymark/vision/landmark_finder.hpp"

#include <cmath>

#include "waymark/vision/subpixel.hpp"

namespace waymark::vision {
namespace {

/// Should the whole patch of a landmark be seen?
bool should_be_seen(const Expectation& expected, const ImageView& image, int patch_px) {
  return patch_fits(image, static_cast<int>(std::lround(expected.predicted_px.x())),
                    static_cast<int>(std::lround(expected.predicted_px.y())), patch_px);
}

}  // namespace

LandmarkFinder::LandmarkFinder(const FinderOptions& options, const SearchOptions& search,
                               const Camera& camera)
    : options_(options),
      search_options_(search),
      camera_(camera),
      costs_(work_costs(search.instructions)),
      search_(search) {
  search_.reserve(camera.width_px(), camera.height_px());
}

double LandmarkFinder::expected_cost_ns(const Expectation& expected) const {
  return costs_.search_ns + costs_.peak_ns + costs_.window_ns * search_.expected_windows(expected.S);
}

SearchResult LandmarkFinder::search_for(const Expectation& expected, const ImageView& image,
                                        const CameraPose& here, Appearance& appearance) {
  SearchResult search_result;
  search_result.cost_ns = costs_.search_ns;
  if (options_.warp && redraw(expected, here, appearance)) search_result.cost_ns += costs_.warp_ns;
  const Patch& patch = appearance.patch.patch();
  const auto match = search_.find(image, patch, expected.predicted_px, expected.S);
  search_result.cost_ns += costs_.window_ns * static_cast<double>(search_.windows());
  if (!match) return search_result;
  search_result.pixel = Eigen::Vector2d(match->u, match->v);
  locate(image, patch, *match, search_result);
  if (search_result.result != SearchRecord::Result::kFound && should_be_seen(expected, image, patch.size))
    search_result.result = SearchRecord::Result::kMissed;
  return search_result;
}

/// Turns and scales the patch to how it should look from here; says whether it had to be drawn.
bool LandmarkFinder::redraw(const Expectation& expected, const CameraPose& here,
                            Appearance& appearance) const {
  const CameraPose& then = appearance.seen_from;
  const Eigen::Vector3d p_then = then.R_camera_world * (expected.p_world_m - then.p_world_camera);
  const auto A = facing_warp(camera_, p_then, motion_between(then, here));
  if (!A) return false;
  const Eigen::Matrix2d before = appearance.patch.A();
  static_cast<void>(appearance.patch.seen_under(*A));
  return appearance.patch.A() != before;
}

void LandmarkFinder::locate(const ImageView& image, const Patch& patch, const Match& match,
                            SearchResult& search_result) const {
  if (!options_.subpixel) {
    if (match.accepted) search_result.result = SearchRecord::Result::kFound;
    search_result.R = whole_pixel_covariance();
    return;
  }
  search_result.cost_ns += costs_.peak_ns;
  const auto peak =
      find_peak(image, patch, match.u, match.v, search_options_.grey_sigma, search_options_.instructions);
  // At the peak there is no half pixel to be forgiven: what is left comes of surfaces that are not flat.
  if (!peak || peak->zmssd > search_options_.accept_ratio * expected_zmssd(patch, search_options_.grey_sigma))
    return;
  search_result.result = SearchRecord::Result::kFound;
  search_result.pixel = peak->pixel;
  search_result.R = peak->R;
}

}  // namespace waymark::vision
