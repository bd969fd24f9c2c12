#pragma once

#include <cmath>
#include <vector>

#include <Eigen/Geometry>

#include "workshop/figures/simulated_board.hpp"

namespace waymark::test {

using calibrate::simulated::chessboard;
using calibrate::simulated::named;
using calibrate::simulated::Poses;
using calibrate::simulated::true_camera;

/// By a camera and of a board without flaws, but for the noise of corners.
inline std::vector<calibrate::BoardCorners> photograph(const calibrate::Board& board,
                                                       const CameraOptions& camera, std::size_t count,
                                                       double noise_px, std::uint64_t seed,
                                                       const Poses& poses = {}) {
  RandomStream random(seed, StreamPurpose::kSimulation);
  return calibrate::simulated::photograph(board, camera, count, poses, {.noise_px = noise_px}, random);
}

/// A chessboard drawn flat: its first inner corner at (u, v), the rows turned by `turn_rad`, its edges
/// blurred by a Gaussian of `blur_px`.
struct DrawnBoard {
  double u = 80.0;
  double v = 70.0;
  double square_px = 36.0;
  double turn_rad = 0.1;
  double blur_px = 0.8;

  [[nodiscard]] Eigen::Vector2d corner(const calibrate::Board& board, int index) const {
    return Eigen::Vector2d(u, v) +
           Eigen::Rotation2Dd(turn_rad) * (square_px / board.square_m * board.corner_m(index));
  }

  [[nodiscard]] GreyImage draw(const calibrate::Board& board, int width_px, int height_px) const {
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

}  // namespace waymark::test
