#include "waymark/models/undistortion_table.hpp"

#include <limits>

namespace waymark {
namespace {

int nodes_for(int pixels) { return (pixels - 1) / UndistortionTable::kCell_px + 2; }

}  // namespace

UndistortionTable::UndistortionTable(const Camera& camera)
    : columns_(nodes_for(camera.width_px())),
      rows_(nodes_for(camera.height_px())),
      last_pixel_(camera.width_px() - 1, camera.height_px() - 1) {
  const Eigen::Vector2d none = Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
  for (int row = 0; row < rows_; ++row) {
    for (int column = 0; column < columns_; ++column) {
      const auto ray = camera.ray(kCell_px * Eigen::Vector2d(column, row));
      nodes_.push_back(ray ? ray->xy : none);
    }
  }
}

Eigen::Vector2d UndistortionTable::operator()(const Eigen::Vector2d& pixel) const {
  const Eigen::Vector2d place = pixel.cwiseMax(0.0).cwiseMin(last_pixel_) / kCell_px;
  const int column = static_cast<int>(place.x()), row = static_cast<int>(place.y());
  const double a = place.x() - column, b = place.y() - row;
  return (1.0 - b) * ((1.0 - a) * node(column, row) + a * node(column + 1, row)) +
         b * ((1.0 - a) * node(column, row + 1) + a * node(column + 1, row + 1));
}

}  // namespace waymark
