#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "waymark/core/grey_image.hpp"
#include "waymark/core/result.hpp"
#include "waymark/vision/landmark_finder.hpp"
#include "waymark/vision/new_corners.hpp"

namespace waymark {

/// Side of the patches that are followed through the images of the desk.
inline constexpr int kDeskPatch_px = 16;

/// The desk's images in order. The error says what the folder lacks.
[[nodiscard]] Result<std::vector<std::filesystem::path>> desk_images(const std::string& folder);

/// Of a place that its last motion predicts.
[[nodiscard]] Eigen::Matrix2d desk_prediction_covariance();

/// Looks for patches as they are: where the camera is nobody knows yet.
[[nodiscard]] vision::LandmarkFinder desk_finder(int width_px, int height_px);

/// As many new corners as a follower takes.
[[nodiscard]] vision::NewCorners desk_corners(int width_px, int height_px);

/// Corners that `corners` finds in an image, away from `taken`, without a limit of time.
[[nodiscard]] std::vector<vision::Corner> find_more(vision::NewCorners& corners, const GreyImage& image,
                                                    const std::vector<Eigen::Vector2d>& taken);

}  // namespace waymark
