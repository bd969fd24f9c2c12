#include "workbench/calibrate/weaknesses.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "workbench/calibrate/coverage.hpp"
#include "workbench/calibrate/name_groups.hpp"

namespace waymark::calibrate {
namespace {

// Where a set of views becomes weak. What photographers of boards are told (10 to 20 views, tilted, all over
// the image, errors well below a pixel) as numbers.
constexpr std::size_t kViews = 10;
constexpr double kRms_px = 1.0;
constexpr double kHeldOut = 1.5;  // times the error within the fit
constexpr double kFocal = 0.005;  // standard deviation, of the focal length
constexpr double kProjection_px = 2.0;
constexpr double kTilt_deg = 15.0;
constexpr std::size_t kTilted = 3;  // views
constexpr double kCovered = 0.6;
constexpr double kOffCentre = 0.1;  // of the image's width
constexpr double kSquare = 0.015;

constexpr const char* kTiltIt =
    "take images of the board tilted by 20 to 45 degrees, to the left, to the right, up and down, near and "
    "far";

using Found = std::vector<Weakness>;

/// One of the groups by the names of its views, and how many were dropped because most are of the other.
std::string name_group(const CameraCalibration& c, std::size_t group) {
  std::vector<std::string> names;
  std::vector<bool> is_member;
  std::size_t dropped = 0;
  for (std::size_t i = 0; i < c.views.size(); ++i) {
    const auto has = [i](const TwoCameras::Group& g) { return std::ranges::count(g.views, i) > 0; };
    if (std::ranges::none_of(c.two_cameras->groups, has)) continue;
    names.push_back(c.views[i].name);
    is_member.push_back(has(c.two_cameras->groups[group]));
    if (is_member.back() && c.views[i].fate == Fate::kOutlier) ++dropped;
  }
  return fmt::format("{} ({} views{})", describe_members(names, is_member),
                     c.two_cameras->groups[group].views.size(),
                     dropped > 0 ? fmt::format(", {} dropped", dropped) : "");
}

void check_one_camera(const CameraCalibration& c, Found& found) {
  if (!c.two_cameras) return;
  const auto& [first, second] = c.two_cameras->groups;
  found.push_back({fmt::format("two cameras, or focus or zoom changed: {} | {}: error {:.2f} px fitted "
                               "together, {:.2f} and {:.2f} px separately",
                               name_group(c, 0), name_group(c, 1), c.two_cameras->together_px, first.rms_px,
                               second.rms_px),
                   "calibrate each group separately (waymark calibrate camera FILES), with 15 or more views "
                   "and locked focus and zoom"});
}

void check_count(const CameraCalibration& c, Found& found) {
  if (c.used() < kViews)
    found.push_back(
        {fmt::format("only {} views could be used", c.used()), "take 15 to 20 views from different sides"});
}

void check_errors(const CameraCalibration& c, Found& found) {
  if (c.fit.rms_px > kRms_px)
    found.push_back(
        {fmt::format("reprojection errors of {:.2f} px; a good set has less than 0.5 px", c.fit.rms_px),
         "glue the board to something flat and stiff, keep it and the camera still, lock the focus, and use "
         "more light"});
  if (c.held_out.folds > 0 && c.held_out.rms_px > kHeldOut * c.fit.rms_px)
    found.push_back(
        {fmt::format("overfitted: views left out of the fit have errors of {:.2f} px, those in it {:.2f} px",
                     c.held_out.rms_px, c.fit.rms_px),
         "take more views from every side and distance"});
}

void check_focal_length(const CameraCalibration& c, Found& found) {
  const Intrinsics sigma = c.fit.sigma().cwiseMax(c.held_out.sigma);
  const CameraOptions& camera = c.fit.camera;
  const double relative = std::max(sigma[0] / camera.fu_px, sigma[1] / camera.fv_px);
  if (relative > kFocal)
    found.push_back({fmt::format("the focal length is uncertain by {:.1f} %: from {:.0f} to {:.0f} px, "
                                 "depending on which views are left out",
                                 100.0 * relative, c.held_out.shortest_focal_px, c.held_out.longest_focal_px),
                     kTiltIt});
}

void check_symptoms(const CameraCalibration& c, Found& found) {
  const CameraOptions& camera = c.fit.camera;
  const double off_px =
      std::hypot(camera.cu_px - 0.5 * (camera.width_px - 1), camera.cv_px - 0.5 * (camera.height_px - 1));
  if (off_px > kOffCentre * camera.width_px)
    found.push_back({fmt::format("the principal point is {:.0f} px from the middle of the image, more than "
                                 "is plausible for a lens: the views do not determine it",
                                 off_px),
                     "turn the board and the camera by 90 degrees in some views, and fill the whole image"});
  const double ratio = std::abs(camera.fu_px / camera.fv_px - 1.0);
  if (ratio > kSquare)
    found.push_back(
        {fmt::format("pixels would be {:.1f} % from square, but almost all cameras have square pixels",
                     100.0 * ratio),
         "rotate the board by 90 degrees in some views, and make sure that it is flat"});
}

void check_tilts(const CameraCalibration& c, Found& found) {
  const auto tilted =
      std::ranges::count_if(c.fit.views, [](const auto& view) { return tilt_deg(view) > kTilt_deg; });
  if (static_cast<std::size_t>(tilted) >= kTilted) return;
  std::vector<double> distances;
  for (const FittedView& view : c.fit.views) distances.push_back(distance_m(view, c.board));
  const auto [near, far] = std::ranges::minmax(distances);
  found.push_back(
      {fmt::format(
           "the board is parallel to the image, within {:.0f} degrees, in all but {} views, and the farthest "
           "is only {:.1f} times as far as the nearest: focal length and distance cannot be separated",
           kTilt_deg, tilted, far / near),
       kTiltIt});
}

void check_coverage(const CameraCalibration& c, ImageSize size, Found& found) {
  double worst_px = 0.0;
  for (const ProjectionSigma& place : c.projection) worst_px = std::max(worst_px, place.sigma_px);
  const auto empty = empty_ninths(c.views, size);
  const std::string where = empty.empty() ? std::string("near the borders and corners of the image")
                                          : fmt::format("at the {} of the image", fmt::join(empty, ", "));
  if (c.covered < kCovered)
    found.push_back({fmt::format("corners cover {:.0f} % of the image", 100.0 * c.covered),
                     "take images of the board " + where});
  if (worst_px > kProjection_px)
    found.push_back({fmt::format("somewhere in the image the lens is uncertain by {:.1f} px", worst_px),
                     "take images of the board " + where});
}

}  // namespace

std::vector<Weakness> find_weaknesses(const CameraCalibration& c) {
  const ImageSize size{c.fit.camera.width_px, c.fit.camera.height_px};
  Found found;
  check_one_camera(c, found);
  check_count(c, found);
  check_errors(c, found);
  check_focal_length(c, found);
  check_symptoms(c, found);
  check_tilts(c, found);
  check_coverage(c, size, found);
  return found;
}

}  // namespace waymark::calibrate
