#include "workshop/figures/desk_search.hpp"

#include <algorithm>
#include <chrono>
#include <system_error>

#include <fmt/format.h>

namespace waymark {
namespace {

namespace fs = std::filesystem;

constexpr double kPrediction_px = 3.0;
/// The camera is noisier and shakes more than what SearchOptions takes for granted.
constexpr double kAcceptRatio = 4.0;

}  // namespace

Result<std::vector<fs::path>> desk_images(const std::string& folder) {
  std::vector<fs::path> files;
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(fs::path(folder) / "frames", failed))
    files.push_back(entry.path());
  std::ranges::sort(files);
  if (files.size() < 2)
    return Error{fmt::format("{}: expected images in its folder frames/, found {}", folder, files.size())};
  return files;
}

Eigen::Matrix2d desk_prediction_covariance() {
  return kPrediction_px * kPrediction_px * Eigen::Matrix2d::Identity();
}

vision::LandmarkFinder desk_finder(int width_px, int height_px) {
  return {{.patch_px = kDeskPatch_px, .warp = false},
          {.accept_ratio = kAcceptRatio},
          Camera({.width_px = width_px, .height_px = height_px})};
}

vision::NewCorners desk_corners(int width_px, int height_px) {
  return {{.wanted = 40, .max_new = 12}, {}, kDeskPatch_px, width_px, height_px};
}

std::vector<vision::Corner> find_more(vision::NewCorners& corners, const GreyImage& image,
                                      const std::vector<Eigen::Vector2d>& taken) {
  vision::FrameBudget budget(vision::BudgetKind::kWork);
  budget.start(std::chrono::seconds(1));
  const auto found = corners.find(image, taken, 0, budget);
  return {found.begin(), found.end()};
}

}  // namespace waymark
