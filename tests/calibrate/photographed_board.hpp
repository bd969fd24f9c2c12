#pragma once

#include <cmath>
#include <vector>

#include <Eigen/Geometry>

#include "waymark/calibrate/view.hpp"
#include "waymark/core/angle.hpp"
#include "waymark/core/random.hpp"

namespace waymark::calibrate::test {

inline Board chessboard() { return {.corners = {9, 6}, .square_m = 0.025}; }

/// A lens with the distortion of a wide one.
inline CameraOptions true_camera() {
  return {.width_px = 640,
          .height_px = 480,
          .fu_px = 532.0,
          .fv_px = 533.5,
          .cu_px = 331.0,
          .cv_px = 236.0,
          .distortion = {.k1 = -0.28, .k2 = 0.09, .p1 = 0.001, .p2 = -0.0006}};
}

/// What photographs of a board at random poses vary in.
struct Poses {
  double tilt_deg = 40.0;  ///< at most, about either axis
  double nearest_m = 0.25;
  double farthest_m = 0.6;
};

inline Eigen::Isometry3d random_pose(const Board& board, const Poses& poses, RandomStream& random) {
  const double tilt_rad = to_radians(poses.tilt_deg);
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = (Eigen::AngleAxisd(random.uniform(-tilt_rad, tilt_rad), Eigen::Vector3d::UnitX()) *
                Eigen::AngleAxisd(random.uniform(-tilt_rad, tilt_rad), Eigen::Vector3d::UnitY()) *
                Eigen::AngleAxisd(random.uniform(-0.5, 0.5), Eigen::Vector3d::UnitZ()))
                   .toRotationMatrix();
  const double z = random.uniform(poses.nearest_m, poses.farthest_m);
  const Eigen::Vector2d middle = 0.5 * board.corner_m(board.size() - 1);
  const Eigen::Vector3d place(random.uniform(-0.6, 0.6) * z, random.uniform(-0.45, 0.45) * z, z);
  T.translation() = place - T.linear() * Eigen::Vector3d(middle.x(), middle.y(), 0.0);
  return T;
}

/// The corners of a board that is wholly in the picture; empty where it is not.
inline BoardCorners project(const Board& board, const CameraOptions& options, const Eigen::Isometry3d& T) {
  const Camera camera(options);
  BoardCorners corners;
  for (int i = 0; i < board.size(); ++i) {
    const Eigen::Vector2d m = board.corner_m(i);
    const auto image = camera.project(T * Eigen::Vector3d(m.x(), m.y(), 0.0));
    if (!image || !camera.sees(image->pixel, 5.0)) return {};
    corners.push_back({i, image->pixel});
  }
  return corners;
}

inline std::vector<BoardCorners> photograph(const Board& board, const CameraOptions& camera,
                                            std::size_t count, double noise_px, std::uint64_t seed,
                                            const Poses& poses = {}) {
  RandomStream random(seed, StreamPurpose::kSimulation);
  std::vector<BoardCorners> views;
  while (views.size() < count) {
    BoardCorners corners = project(board, camera, random_pose(board, poses, random));
    for (BoardCorner& corner : corners)
      corner.pixel += noise_px * Eigen::Vector2d(random.normal(), random.normal());
    if (!corners.empty()) views.push_back(std::move(corners));
  }
  return views;
}

inline std::vector<View> named(const std::vector<BoardCorners>& corners, ImageSize size = {640, 480}) {
  std::vector<View> views;
  for (const BoardCorners& each : corners)
    views.push_back(
        {.name = "view " + std::to_string(views.size()), .size = size, .corners = each, .edge_px = 1.5});
  return views;
}

/// A chessboard drawn flat: its first inner corner at (u, v), the rows turned by `turn_rad`, its edges
/// blurred by a Gaussian of `blur_px`.
struct DrawnBoard {
  double u = 80.0;
  double v = 70.0;
  double square_px = 36.0;
  double turn_rad = 0.1;
  double blur_px = 0.8;

  [[nodiscard]] Eigen::Vector2d corner(const Board& board, int index) const {
    return Eigen::Vector2d(u, v) +
           Eigen::Rotation2Dd(turn_rad) * (square_px / board.square_m * board.corner_m(index));
  }

  [[nodiscard]] GreyImage draw(const Board& board, int width_px, int height_px) const {
    GreyImage image(width_px, height_px, 230);
    for (int y = 0; y < height_px; ++y)
      for (int x = 0; x < width_px; ++x) {
        const Eigen::Vector2d p = Eigen::Rotation2Dd(-turn_rad) * Eigen::Vector2d(x - u, y - v) / square_px;
        const double wave = squares(p.x(), board.corners.columns) * squares(p.y(), board.corners.rows);
        const double inside = window(p.x(), board.corners.columns) * window(p.y(), board.corners.rows);
        image(x, y) =
            static_cast<std::uint8_t>(std::lround(inside * (130.0 + 100.0 * wave) + (1.0 - inside) * 230.0));
      }
    return image;
  }

 private:
  [[nodiscard]] double step(double squares_away) const {
    return 0.5 * (1.0 + std::erf(squares_away * square_px / (blur_px * std::sqrt(2.0))));
  }
  /// From -1 to 1 and back at every corner.
  [[nodiscard]] double squares(double x, int corners) const {
    double value = -1.0;
    for (int i = 0; i < corners; ++i) value += (i % 2 == 0 ? 2.0 : -2.0) * step(x - i);
    return value;
  }
  /// 1 on the board, which ends a square beyond its outer corners.
  [[nodiscard]] double window(double x, int corners) const { return step(x + 1.0) * step(corners - x); }
};

}  // namespace waymark::calibrate::test
