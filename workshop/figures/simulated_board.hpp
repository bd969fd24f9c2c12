#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "waymark/core/random.hpp"

#include "workbench/calibrate/view.hpp"

/// Photographs of a board for tests and studies: only where the corners are.
namespace waymark::calibrate::simulated {

/// 9 x 6 corners, 25 mm apart.
[[nodiscard]] Board chessboard();
/// 640 x 480 pixels, with the distortion of a wide lens.
[[nodiscard]] CameraOptions true_camera();

/// What photographs of a board at random poses vary in.
struct Poses {
  double tilt_deg = 40.0;  ///< at most, about either axis
  double nearest_m = 0.25;
  double farthest_m = 0.6;
  double part = 1.0;  ///< of the image's width and height, from its upper left, that boards lie in
};

/// What board, camera and corners have wrong.
struct Flaws {
  double noise_px = 0.12;  ///< of a corner in either direction, standard deviation
  double uneven = 0.0;     ///< each view has (1 + uneven |n|) times that noise, n standard normal
  /// How far the board rises from its plane: times x^2, x y and y^2, in units of half its longer side.
  Eigen::Vector3d bend_m = Eigen::Vector3d::Zero();
  double flex_m = 0.0;  ///< what these are off by, anew in each view, standard deviation
  double rolling_px =
      0.0;               ///< how far the last row has moved, and the first the other way, standard deviation
  bool fisheye = false;  ///< equidistant (the radius is as the angle) before the camera's own distortion
};

/// From the board to the camera; its middle lies somewhere in the image.
[[nodiscard]] Eigen::Isometry3d random_pose(const Board& board, const Poses& poses, RandomStream& random);

/// The corners of a board that is wholly in the image, without noise and rolling; empty where it is not.
[[nodiscard]] BoardCorners project(const Board& board, const CameraOptions& camera,
                                   const Eigen::Isometry3d& T_camera_board, const Flaws& flaws = {});

/// `count` views that show the whole board. Poses that do not are drawn again.
[[nodiscard]] std::vector<BoardCorners> photograph(const Board& board, const CameraOptions& camera,
                                                   std::size_t count, const Poses& poses, const Flaws& flaws,
                                                   RandomStream& random);

/// Views of these corners, called "view 0" and so on.
[[nodiscard]] std::vector<BoardView> named(const std::vector<BoardCorners>& corners,
                                           ImageSize size = {640, 480});

}  // namespace waymark::calibrate::simulated
