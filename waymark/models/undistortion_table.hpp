#pragma once

#include <vector>

#include <Eigen/Core>

#include "waymark/models/camera.hpp"

namespace waymark {

/// Camera::ray() without its Jacobian as a table: every kCell_px pixels, bilinear between. Some nanoseconds a
/// pixel; within 0.01 px of the exact ray for a horizontal view up to 63 degrees and k1 down to -0.2.
class UndistortionTable {
 public:
  static constexpr int kCell_px = 4;

  explicit UndistortionTable(const Camera& camera);

  /// (x, y) of the ray (x, y, 1) through a pixel of the image (beside it: of the nearest one); NaN where no
  /// ray ends.
  [[nodiscard]] Eigen::Vector2d operator()(const Eigen::Vector2d& pixel) const;

 private:
  [[nodiscard]] const Eigen::Vector2d& node(int column, int row) const {
    return *(nodes_.data() + row * columns_ + column);
  }

  int columns_, rows_;
  Eigen::Vector2d last_pixel_;
  std::vector<Eigen::Vector2d> nodes_;
};

}  // namespace waymark
