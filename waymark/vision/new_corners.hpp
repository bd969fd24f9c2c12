#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "waymark/core/grey_image.hpp"
#include "waymark/vision/corners.hpp"
#include "waymark/vision/frame_budget.hpp"
#include "waymark/vision/new_corner_options.hpp"

namespace waymark::vision {

/// The smaller eigenvalue of sum grad grad^T over the patch around (u, v), which must fit into the image with
/// a pixel to spare (Shi and Tomasi 1994): how well the place of the patch can be told in every direction.
[[nodiscard]] double shi_tomasi_score(const ImageView& image, int u, int v, int patch_px);

/// Looks for new landmarks in those cells of an image that hold fewer features than their share of what is
/// wanted, and in no others; begins each time where it ended the time before.
class NewCorners {
 public:
  NewCorners(const NewCornerOptions& options, const CornerOptions& corners, int patch_px, int width_px,
             int height_px);

  /// Corners that are far enough from the `features` in view and from each other and have room for a
  /// reference patch, at most one per cell: of its strongest, that with the largest Shi-Tomasi score. Valid
  /// until the next call.
  [[nodiscard]] std::span<const Corner> find(const ImageView& image,
                                             std::span<const Eigen::Vector2d> features, int candidates,
                                             FrameBudget& budget);

 private:
  static constexpr std::size_t kRanked = 8;  ///< corners of a cell whose texture is looked at

  [[nodiscard]] int cell_of(const Eigen::Vector2d& place) const;
  [[nodiscard]] PixelRect searched_part(int cell) const;
  [[nodiscard]] bool is_far(const Corner& corner, std::span<const Eigen::Vector2d> features) const;
  void count_features(std::span<const Eigen::Vector2d> features);
  void rank(const Corner& corner);
  void add_best(const ImageView& image, const PixelRect& part, std::span<const Eigen::Vector2d> features);

  NewCornerOptions options_;
  CornerDetector detector_;
  double pixel_ns_;
  int patch_px_, width_px_, height_px_;
  int next_cell_ = 0;
  std::vector<int> features_in_;  ///< each cell
  std::vector<Corner> strongest_;
  std::vector<Corner> found_;
};

}  // namespace waymark::vision
