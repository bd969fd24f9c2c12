#pragma once

#include <optional>

#include <Eigen/Core>

#include "waymark/core/grey_image.hpp"
#include "waymark/vision/patch.hpp"

namespace waymark::vision {

struct SubpixelPeak {
  Eigen::Vector2d pixel;
  Eigen::Matrix2d R;   ///< its covariance, px^2
  double zmssd = 0.0;  ///< what is left there, without what a change of contrast by up to 2 explains
};

/// No place is claimed to be known better than this.
inline constexpr double kMinPixelSigma = 0.1;

/// The bottom of the paraboloid through the ZMSSD of the window at (u, v) and its eight neighbours, and how
/// well it is known: the curvature of the ZMSSD is 2 sum grad grad^T, so that two images with grey noise
/// sigma leave R = 2 sigma^2 (sum grad grad^T)^-1 = 4 sigma^2 H^-1, and 2 n sigma^4 H^-2 more where texture
/// is as weak as noise; at least kMinPixelSigma in every direction. Where more is left at the bottom than
/// noise explains (a turned surface, an edge in depth, less sharp from afar), sigma is what explains it.
/// Nothing where a neighbour leaves the image, or the place is no minimum within a pixel: an edge, which
/// fixes one direction only, or the border of the search.
[[nodiscard]] std::optional<SubpixelPeak> find_peak(
    const ImageView& image, const Patch& patch, int u, int v, double grey_sigma,
    kernels::Instructions instructions = kernels::Instructions::kSimd);

/// The covariance of a place that is known to the whole pixel only.
[[nodiscard]] Eigen::Matrix2d whole_pixel_covariance();

}  // namespace waymark::vision
