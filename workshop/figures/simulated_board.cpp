#include "workshop/figures/simulated_board.hpp"

#include <algorithm>
#include <cmath>

#include "waymark/core/angle.hpp"

namespace waymark::calibrate::simulated {
namespace {

constexpr double kBorder_px = 5.0;

/// Standard deviation `sigma`; draws nothing where that is 0.
Eigen::Vector3d normals(double sigma, RandomStream& random) {
  if (sigma == 0.0) return Eigen::Vector3d::Zero();
  return sigma * Eigen::Vector3d(random.normal(), random.normal(), random.normal());
}

Eigen::Vector2d middle_m(const Board& board) { return 0.5 * board.corner_m(board.size() - 1); }

Eigen::Vector3d corner_m(const Board& board, int index, const Eigen::Vector3d& bend_m) {
  const Eigen::Vector2d m = board.corner_m(index), q = (m - middle_m(board)) / middle_m(board).maxCoeff();
  return {m.x(), m.y(), bend_m.dot(Eigen::Vector3d(q.x() * q.x(), q.x() * q.y(), q.y() * q.y()))};
}

/// Where a camera without a fisheye sees what a fisheye sees at `p`.
Eigen::Vector3d through_fisheye(const Eigen::Vector3d& p) {
  const double radius = p.head<2>().norm();
  const double scale = std::atan2(radius, p.z()) / std::max(radius, 1e-12);
  return {scale * p.x(), scale * p.y(), 1.0};
}

bool lies_in_part(const BoardCorners& corners, const CameraOptions& camera, double part) {
  const Eigen::Vector2d end_px = part * Eigen::Vector2d(camera.width_px, camera.height_px);
  return std::ranges::all_of(corners, [&](const BoardCorner& corner) {
    return corner.pixel.x() < end_px.x() && corner.pixel.y() < end_px.y();
  });
}

/// Rows are read one after the other, and the camera moves.
void roll(BoardCorners& corners, const CameraOptions& camera, double sigma_px, RandomStream& random) {
  const Eigen::Vector2d move_px = normals(sigma_px, random).head<2>();
  const double half = 0.5 * camera.height_px;
  for (BoardCorner& corner : corners) corner.pixel += (corner.pixel.y() - half) / half * move_px;
}

void add_noise(BoardCorners& corners, const Flaws& flaws, RandomStream& random) {
  const double noise_px = flaws.noise_px * (1.0 + std::abs(normals(flaws.uneven, random).x()));
  for (BoardCorner& corner : corners)
    corner.pixel += noise_px * Eigen::Vector2d(random.normal(), random.normal());
}

}  // namespace

Board chessboard() { return {.corners = {9, 6}, .square_m = 0.025}; }

CameraOptions true_camera() {
  return {.width_px = 640,
          .height_px = 480,
          .fu_px = 532.0,
          .fv_px = 533.5,
          .cu_px = 331.0,
          .cv_px = 236.0,
          .distortion = {.k1 = -0.28, .k2 = 0.09, .p1 = 0.001, .p2 = -0.0006}};
}

Eigen::Isometry3d random_pose(const Board& board, const Poses& poses, RandomStream& random) {
  const double tilt_rad = to_radians(poses.tilt_deg);
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = (Eigen::AngleAxisd(random.uniform(-tilt_rad, tilt_rad), Eigen::Vector3d::UnitX()) *
                Eigen::AngleAxisd(random.uniform(-tilt_rad, tilt_rad), Eigen::Vector3d::UnitY()) *
                Eigen::AngleAxisd(random.uniform(-0.5, 0.5), Eigen::Vector3d::UnitZ()))
                   .toRotationMatrix();
  const double z = random.uniform(poses.nearest_m, poses.farthest_m);
  const Eigen::Vector3d place(random.uniform(-0.6, 0.6) * z, random.uniform(-0.45, 0.45) * z, z);
  T.translation() = place - T.linear().leftCols<2>() * middle_m(board);
  return T;
}

BoardCorners project(const Board& board, const CameraOptions& camera, const Eigen::Isometry3d& T_camera_board,
                     const Flaws& flaws) {
  const Camera model(camera);
  BoardCorners corners;
  for (int i = 0; i < board.size(); ++i) {
    const Eigen::Vector3d p = T_camera_board * corner_m(board, i, flaws.bend_m);
    const auto image = model.project(flaws.fisheye ? through_fisheye(p) : p);
    if (!image || !model.sees(image->pixel, kBorder_px)) return {};
    corners.push_back({i, image->pixel});
  }
  return corners;
}

std::vector<BoardCorners> photograph(const Board& board, const CameraOptions& camera, std::size_t count,
                                     const Poses& poses, const Flaws& flaws, RandomStream& random) {
  std::vector<BoardCorners> views;
  while (views.size() < count) {
    const Eigen::Isometry3d T = random_pose(board, poses, random);
    Flaws of_view = flaws;
    of_view.bend_m += normals(flaws.flex_m, random);
    BoardCorners corners = project(board, camera, T, of_view);
    if (corners.empty() || !lies_in_part(corners, camera, poses.part)) continue;
    roll(corners, camera, flaws.rolling_px, random);
    add_noise(corners, flaws, random);
    views.push_back(std::move(corners));
  }
  return views;
}

std::vector<BoardView> named(const std::vector<BoardCorners>& corners, ImageSize size) {
  constexpr double kSharp_px = 1.5;
  std::vector<BoardView> views;
  for (const BoardCorners& each : corners)
    views.push_back({.name = "view " + std::to_string(views.size()),
                     .size = size,
                     .corners = each,
                     .edge_px = kSharp_px});
  return views;
}

}  // namespace waymark::calibrate::simulated
