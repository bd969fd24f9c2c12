#include "workbench/calibrate/camera_fit.hpp"

#include <cmath>
#include <numeric>

#include <Eigen/LU>
#include <fmt/format.h>

#include "waymark/core/cholesky.hpp"
#include "waymark/core/solve_symmetric.hpp"

#include "workbench/calibrate/plane_homography.hpp"

namespace waymark::calibrate {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Vector6d = Eigen::Matrix<double, 6, 1>;

constexpr int kIterations = 200;
constexpr double kConverged = 1e-10;  // of the sum of squares

/// What one view says of the camera (A, a), of its pose (C, c) and of both (B): the blocks of J'J and J'r.
struct Normal {
  IntrinsicsCovariance A = IntrinsicsCovariance::Zero();
  Intrinsics a = Intrinsics::Zero();
  SmallMatrix B = SmallMatrix::Zero(kIntrinsics, 6);
  SmallMatrix C = SmallMatrix::Zero(6, 6);
  Vector6d c = Vector6d::Zero();
  double squares = 0.0;
};

/// Board and corners of one view, where the board is taken to be at a pose.
struct Sight {
  const Board& board;
  const BoardCorners& corners;

  /// Nothing where the camera cannot see a corner.
  [[nodiscard]] std::optional<FittedView> compare(const Camera& camera, const Eigen::Isometry3d& T) const {
    FittedView view{T, {}};
    for (const auto& [index, pixel] : corners) {
      const Vector2d m = board.corner_m(index);
      const auto image = camera.project(T * Vector3d(m.x(), m.y(), 0.0));
      if (!image) return std::nullopt;
      view.residuals_px.emplace_back(pixel - image->pixel);
    }
    return view;
  }

  [[nodiscard]] Normal normal(const Camera& camera, const FittedView& view) const {
    Normal sum;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Vector2d m = board.corner_m(corners[i].index);
      const Vector3d arm = view.T_camera_board.linear() * Vector3d(m.x(), m.y(), 0.0);
      const Vector3d p = arm + view.T_camera_board.translation();
      const auto image = camera.project(p);
      if (!image) continue;  // not so: compare() saw it
      const Matrix3d turn{{0.0, arm.z(), -arm.y()}, {-arm.z(), 0.0, arm.x()}, {arm.y(), -arm.x(), 0.0}};
      Eigen::Matrix<double, 2, 6> J;
      J << image->dpixel_dpoint * turn, image->dpixel_dpoint;
      const auto G = intrinsics_jacobian(camera, p);
      const Vector2d& r = view.residuals_px[i];
      sum.A += G.transpose() * G;
      sum.a += G.transpose() * r;
      sum.B += G.transpose() * J;
      sum.C += J.transpose() * J;
      sum.c += J.transpose() * r;
      sum.squares += r.squaredNorm();
    }
    return sum;
  }
};

Eigen::Isometry3d moved(const Eigen::Isometry3d& T, const Vector6d& step) {
  Eigen::Isometry3d result = T;
  const double turn_rad = step.head<3>().norm();
  if (turn_rad > 0.0)
    result.linear() = Eigen::AngleAxisd(turn_rad, step.head<3>() / turn_rad).toRotationMatrix() * T.linear();
  result.translation() += step.tail<3>();
  return result;
}

/// The pose that a homography from the board's plane to rays (x, y, 1) stands for.
Eigen::Isometry3d pose_of(Matrix3d H) {
  H *= 2.0 / (H.col(0).norm() + H.col(1).norm());
  if (H(2, 2) < 0.0) H = -H;  // in front of the camera
  // The axes x and y at right angles that lie evenly about those of H.
  const Vector3d middle = (H.col(0).normalized() + H.col(1).normalized()).normalized();
  const Vector3d z = H.col(0).cross(H.col(1)).normalized();
  const Vector3d aside = middle.cross(z);
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() << std::sqrt(0.5) * (middle + aside), std::sqrt(0.5) * (middle - aside), z;
  T.translation() = H.col(2);
  return T;
}

Matrix3d pinhole(const CameraOptions& camera) {
  return Matrix3d{{camera.fu_px, 0.0, camera.cu_px}, {0.0, camera.fv_px, camera.cv_px}, {0.0, 0.0, 1.0}};
}

/// The focal length with which the sides of the board are square in all views, the principal point in the
/// middle of the image (Zhang, section 3.1); as long as the image is wide where they do not tell.
double first_focal_px(const std::vector<Matrix3d>& homographies, const Vector2d& centre, double width_px) {
  Matrix3d to_centre = Matrix3d::Identity();
  to_centre.topRightCorner<2, 1>() = -centre;
  double squares = 0.0, product = 0.0;
  for (const Matrix3d& H : homographies) {
    Matrix3d M = to_centre * H;
    M /= M.leftCols<2>().norm();
    const Vector3d g = M.col(0), h = M.col(1);
    // w (gx hx + gy hy) + gz hz = 0 and |g|^2 = |h|^2 alike, with w = 1/f^2
    for (const Vector2d& row :
         {Vector2d(g.head<2>().dot(h.head<2>()), -g.z() * h.z()),
          Vector2d(g.head<2>().squaredNorm() - h.head<2>().squaredNorm(), h.z() * h.z() - g.z() * g.z())}) {
      squares += row.x() * row.x();
      product += row.x() * row.y();
    }
  }
  const double f = std::sqrt(squares / product);
  return f > 0.2 * width_px && f < 20.0 * width_px ? f : width_px;
}

/// Without distortion, the principal point in the middle.
CameraOptions first_camera(const std::vector<Matrix3d>& homographies, ImageSize size) {
  CameraOptions camera{.width_px = size.width_px, .height_px = size.height_px};
  camera.cu_px = 0.5 * (size.width_px - 1);
  camera.cv_px = 0.5 * (size.height_px - 1);
  camera.fu_px = camera.fv_px = first_focal_px(homographies, {camera.cu_px, camera.cv_px}, size.width_px);
  return camera;
}

Result<std::vector<Matrix3d>> homographies_of(const Board& board, std::span<const BoardCorners> views) {
  std::vector<Matrix3d> homographies;
  for (const BoardCorners& view : views) {
    const auto H = plane_homography(board, view);
    if (!H) return Error{"all corners of a view lie on a line"};
    homographies.push_back(*H);
  }
  return homographies;
}

/// Gauss-Newton with Marquardt's damping over camera and poses. `free` has one for each intrinsic that is
/// estimated.
class Adjustment {
 public:
  Adjustment(std::vector<Sight> sights, const CameraOptions& camera, Intrinsics free)
      : sights_(std::move(sights)), camera_(camera), free_(std::move(free)) {}

  /// False where a board is not in front of the camera.
  bool start(const std::vector<Eigen::Isometry3d>& poses) {
    auto views = compare(camera_, poses);
    if (!views) return false;
    views_ = *std::move(views);
    return true;
  }

  void run() {
    double damping = 1e-3;
    for (int i = 0; i < kIterations && damping < 1e12; ++i) {
      const std::vector<Normal> normals = build();
      const double before = sum_of_squares(views_);
      while (damping < 1e12 && !try_step(normals, damping)) damping *= 10.0;
      damping = std::max(1e-12, damping / 10.0);
      if (before - sum_of_squares(views_) <= kConverged * before) return;
    }
  }

  [[nodiscard]] const CameraOptions& camera() const { return camera_; }
  [[nodiscard]] const std::vector<FittedView>& views() const { return views_; }

  /// Of the intrinsics alone, J'J with the poses eliminated; fixed ones have ones on the diagonal.
  [[nodiscard]] IntrinsicsCovariance information() const {
    IntrinsicsCovariance S = IntrinsicsCovariance::Zero();
    for (const Normal& n : build()) S += n.A - n.B * solve_symmetric(n.C, n.B.transpose());
    return only_free(S);
  }

 private:
  using Poses = std::vector<Eigen::Isometry3d>;

  [[nodiscard]] std::optional<std::vector<FittedView>> compare(const CameraOptions& options,
                                                               const Poses& poses) const {
    const Camera camera(options);
    std::vector<FittedView> views;
    for (std::size_t i = 0; i < sights_.size(); ++i) {
      auto view = sights_[i].compare(camera, poses[i]);
      if (!view) return std::nullopt;
      views.push_back(*std::move(view));
    }
    return views;
  }

  static double sum_of_squares(const std::vector<FittedView>& views) {
    double sum = 0.0;
    for (const FittedView& view : views)
      for (const Vector2d& r : view.residuals_px) sum += r.squaredNorm();
    return sum;
  }

  [[nodiscard]] std::vector<Normal> build() const {
    const Camera camera(camera_);
    std::vector<Normal> normals;
    for (std::size_t i = 0; i < sights_.size(); ++i) normals.push_back(sights_[i].normal(camera, views_[i]));
    return normals;
  }

  [[nodiscard]] IntrinsicsCovariance only_free(const IntrinsicsCovariance& S) const {
    IntrinsicsCovariance result = free_.asDiagonal() * S * free_.asDiagonal();
    result.diagonal() += Intrinsics::Ones() - free_;
    return result;
  }

  /// Takes the step where it makes the sum of squares no larger.
  bool try_step(const std::vector<Normal>& normals, double damping) {
    IntrinsicsCovariance S = IntrinsicsCovariance::Zero();
    Intrinsics s = Intrinsics::Zero();
    std::vector<SmallMatrix> inverses;
    for (const Normal& n : normals) {
      SmallMatrix C = n.C;
      C.diagonal() *= 1.0 + damping;
      inverses.emplace_back(solve_symmetric(C, SmallMatrix::Identity(6, 6)));
      S += n.A - n.B * inverses.back() * n.B.transpose();
      S.diagonal() += damping * n.A.diagonal();
      s += n.a - n.B * inverses.back() * n.c;
    }
    const Intrinsics step = solve_symmetric(only_free(S), free_.cwiseProduct(s));
    Poses poses;
    for (std::size_t i = 0; i < normals.size(); ++i)
      poses.push_back(
          moved(views_[i].T_camera_board, inverses[i] * (normals[i].c - normals[i].B.transpose() * step)));
    const CameraOptions next = with_intrinsics(camera_, intrinsics_of(camera_) + step);
    if (!step.allFinite() || next.fu_px <= 0.0 || next.fv_px <= 0.0) return false;
    auto views = compare(next, poses);
    if (!views || !(sum_of_squares(*views) <= sum_of_squares(views_))) return false;
    camera_ = next;
    views_ = *std::move(views);
    return true;
  }

  std::vector<Sight> sights_;
  CameraOptions camera_;
  Intrinsics free_;
  std::vector<FittedView> views_;
};

Intrinsics free_terms(Lens lens) {
  Intrinsics free = Intrinsics::Ones();
  if (lens == Lens::kFourTerms) free[8] = 0.0;
  return free;
}

Error left_open() {
  return {
      "these views do not determine the camera: all show the board from one direction; take some with the "
      "board tilted by 20 to 45 degrees, to the left, to the right, up and down"};
}

}  // namespace

Intrinsics intrinsics_of(const CameraOptions& camera) {
  const Distortion& d = camera.distortion;
  Intrinsics values;
  values << camera.fu_px, camera.fv_px, camera.cu_px, camera.cv_px, d.k1, d.k2, d.p1, d.p2, d.k3;
  return values;
}

CameraOptions with_intrinsics(CameraOptions camera, const Intrinsics& values) {
  camera.fu_px = values[0];
  camera.fv_px = values[1];
  camera.cu_px = values[2];
  camera.cv_px = values[3];
  camera.distortion = {values[4], values[5], values[6], values[7], values[8]};
  return camera;
}

Eigen::Matrix<double, 2, kIntrinsics> intrinsics_jacobian(const Camera& camera, const Vector3d& p_camera) {
  const CameraOptions& o = camera.options();
  const Distortion& d = o.distortion;
  const double x = p_camera.x() / p_camera.z(), y = p_camera.y() / p_camera.z(), s = x * x + y * y;
  const double g = 1.0 + s * (d.k1 + s * (d.k2 + s * d.k3));
  const double p1_u = 2.0 * x * y, p2_u = s + 2.0 * x * x, p1_v = s + 2.0 * y * y, p2_v = p1_u;
  Eigen::Matrix<double, 2, kIntrinsics> J;
  J.row(0) << g * x + d.p1 * p1_u + d.p2 * p2_u, 0.0, 1.0, 0.0, o.fu_px * x * s, o.fu_px * x * s * s,
      o.fu_px * p1_u, o.fu_px * p2_u, o.fu_px * x * s * s * s;
  J.row(1) << 0.0, g * y + d.p1 * p1_v + d.p2 * p2_v, 0.0, 1.0, o.fv_px * y * s, o.fv_px * y * s * s,
      o.fv_px * p1_v, o.fv_px * p2_v, o.fv_px * y * s * s * s;
  return J;
}

double FittedView::rms_px() const { return calibrate::rms_px({this, 1}); }

double rms_px(std::span<const FittedView> views) {
  double squares = 0.0;
  std::size_t count = 0;
  for (const FittedView& view : views) {
    for (const Vector2d& r : view.residuals_px) squares += r.squaredNorm();
    count += view.residuals_px.size();
  }
  return count > 0 ? std::sqrt(squares / static_cast<double>(count)) : 0.0;
}

Result<CameraFit> fit_camera(const Board& board, std::span<const BoardCorners> views, ImageSize size,
                             Lens lens) {
  if (views.size() < kFewestViews)
    return Error{
        fmt::format("{} views of the board are too few: at least {} are needed, and 15 are recommended",
                    views.size(), kMinViews)};
  auto homographies = homographies_of(board, views);
  if (!homographies) return homographies.error();
  const CameraOptions camera = first_camera(*homographies, size);
  std::vector<Sight> sights;
  std::vector<Eigen::Isometry3d> poses;
  std::size_t corners = 0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    sights.push_back({board, views[i]});
    poses.push_back(pose_of(pinhole(camera).inverse() * (*homographies)[i]));
    corners += views[i].size();
  }

  const Intrinsics free = free_terms(lens);
  Adjustment adjustment(std::move(sights), camera, free);
  if (!adjustment.start(poses)) return left_open();
  adjustment.run();
  CameraFit fit{.camera = adjustment.camera(), .views = adjustment.views()};
  fit.rms_px = rms_px(fit.views);
  const double unknowns = free.sum() + 6.0 * static_cast<double>(views.size());
  const double spare = 2.0 * static_cast<double>(corners) - unknowns;
  const Cholesky information(adjustment.information());
  if (spare < 1.0 || !information.is_positive_definite()) return left_open();
  const double variance = fit.rms_px * fit.rms_px * static_cast<double>(corners) / spare;
  fit.covariance = variance * free.asDiagonal() * information.solve(Eigen::MatrixXd(free.asDiagonal()));
  return fit.covariance.allFinite() ? Result<CameraFit>(std::move(fit)) : left_open();
}

std::optional<FittedView> fit_pose(const Board& board, const BoardCorners& corners,
                                   const CameraOptions& camera) {
  const auto H = plane_homography(board, corners);
  if (!H) return std::nullopt;
  Adjustment adjustment({{board, corners}}, camera, Intrinsics::Zero());
  if (!adjustment.start({pose_of(pinhole(camera).inverse() * *H)})) return std::nullopt;
  adjustment.run();
  return adjustment.views().front();
}

}  // namespace waymark::calibrate
