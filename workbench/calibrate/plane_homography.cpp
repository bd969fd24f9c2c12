#include "workbench/calibrate/plane_homography.hpp"

#include <vector>

#include "waymark/models/homography.hpp"

namespace waymark::calibrate {

std::optional<Eigen::Matrix3d> plane_homography(const Board& board, const BoardCorners& corners) {
  std::vector<PlacePair> pairs;
  for (const auto& [index, pixel] : corners) pairs.push_back({board.corner_m(index), pixel});
  return homography(pairs);
}

}  // namespace waymark::calibrate
