#include "waymark/markers/corner_refinement.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include "waymark/core/principal_axes.hpp"

namespace waymark::markers {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kRounds = 3;
constexpr double kSpacing_px = 1.5;     // between points along a side
constexpr double kFromCorner_px = 2.0;  // nearer to a corner a side is blurred with the next
constexpr double kSearchCells = 0.45;
constexpr double kSearchMax_px = 3.0;
constexpr double kSearchMin_px = 1.0;
constexpr double kStep_px = 0.5;  // across a side
constexpr double kRiseMin_grey = 10.0;
constexpr std::size_t kPointsMin = 3;

double grey_at(const ImageView& image, const Vector2d& p) {
  const int u = static_cast<int>(p.x()), v = static_cast<int>(p.y());
  const double right = p.x() - u, down = p.y() - v;
  const double above = (1.0 - right) * image(u, v) + right * image(u + 1, v);
  const double below = (1.0 - right) * image(u, v + 1) + right * image(u + 1, v + 1);
  return (1.0 - down) * above + down * below;
}

bool contains(const ImageView& image, const Vector2d& p, double border_px) {
  return p.x() >= border_px && p.y() >= border_px && p.x() < image.width_px - 1 - border_px &&
         p.y() < image.height_px - 1 - border_px;
}

/// Where along `outwards` from a point the grey rises, as the mean place of the rise, px.
std::optional<double> find_rise(const ImageView& image, const Vector2d& p, const Vector2d& outwards,
                                double search_px) {
  if (!contains(image, p, search_px + 1.0)) return std::nullopt;
  double sum = 0.0, moment = 0.0;
  const int steps = static_cast<int>(std::lround(search_px / kStep_px));
  for (int i = -steps; i <= steps; ++i) {
    const double t = i * kStep_px;
    const double rise =
        grey_at(image, p + (t + kStep_px) * outwards) - grey_at(image, p + (t - kStep_px) * outwards);
    if (rise <= 0.0) continue;
    sum += rise;
    moment += rise * t;
  }
  return sum > 2.0 * kRiseMin_grey ? std::optional(moment / sum) : std::nullopt;
}

/// A line a . (x, y, 1) = 0 through rays, by least squares of their distances.
Vector3d line_through(const std::vector<Vector2d>& rays) {
  Vector2d mean = Vector2d::Zero();
  for (const Vector2d& ray : rays) mean += ray / static_cast<double>(rays.size());
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (const Vector2d& ray : rays) scatter += (ray - mean) * (ray - mean).transpose();
  const Vector2d normal = principal_axes(scatter).directions.col(0);
  return {normal.x(), normal.y(), -normal.dot(mean)};
}

/// The line along one side, in rays, and what it rests on.
struct Side {
  Vector3d line = Vector3d::Zero();
  double points = 0.0;
  double middle_px = 0.0;   ///< mean distance of the points from the first corner
  double spread_px2 = 0.0;  ///< sum of their squared distances from there

  /// By how much the side is off at a distance from the first corner where its mean is off by 1/sqrt(points),
  /// and where its direction is off by as much as it is known to.
  [[nodiscard]] Vector2d errors_at(double along_px) const {
    return {1.0 / std::sqrt(points), (along_px - middle_px) / std::sqrt(spread_px2)};
  }
};

/// From one corner to the next, clockwise.
std::optional<Side> find_side(const ImageView& image, const Camera& camera, const Vector2d& from,
                              const Vector2d& to, double search_px) {
  const double length_px = (to - from).norm();
  const Vector2d along = (to - from) / length_px;
  const Vector2d outwards(along.y(), -along.x());
  const double usable_px = length_px - 2.0 * kFromCorner_px;
  const int count = static_cast<int>(std::max(0.0, usable_px / kSpacing_px)) + 1;
  std::vector<Vector2d> rays;
  Side side;
  double sum_px2 = 0.0;
  for (int i = 0; i < count; ++i) {
    const double along_px = kFromCorner_px + usable_px * (i + 0.5) / count;
    const Vector2d p = from + along_px * along;
    const auto rise_px = find_rise(image, p, outwards, search_px);
    const auto ray = rise_px ? camera.ray(p + *rise_px * outwards) : std::nullopt;
    if (!ray) continue;
    rays.push_back(ray->xy);
    side.middle_px += along_px;
    sum_px2 += along_px * along_px;
  }
  if (rays.size() < kPointsMin || 2 * rays.size() < static_cast<std::size_t>(count)) return std::nullopt;
  side.line = line_through(rays);
  side.points = static_cast<double>(rays.size());
  side.middle_px /= side.points;
  side.spread_px2 = sum_px2 - side.points * side.middle_px * side.middle_px;
  return side;
}

using Sides = std::array<Side, 4>;

std::optional<Sides> find_sides(const ImageView& image, const Camera& camera, const Corners& corners,
                                int cells) {
  std::array<double, 4> lengths_px{};
  for (std::size_t i = 0; i < 4; ++i) lengths_px[i] = (corners[(i + 1) % 4] - corners[i]).norm();
  Sides sides;
  for (std::size_t i = 0; i < 4; ++i) {
    // Across a side, cells are as long as along its neighbours.
    const double cell_px = std::min(lengths_px[(i + 1) % 4], lengths_px[(i + 3) % 4]) / cells;
    const double search_px = std::clamp(kSearchCells * cell_px, kSearchMin_px, kSearchMax_px);
    const auto side = find_side(image, camera, corners[i], corners[(i + 1) % 4], search_px);
    if (!side) return std::nullopt;
    sides[i] = *side;
  }
  return sides;
}

std::optional<Corners> crossings(const Sides& sides, const Camera& camera) {
  Corners corners;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vector3d crossing = sides[(i + 3) % 4].line.cross(sides[i].line);
    const auto image_of = camera.project(crossing.z() > 0.0 ? crossing : Vector3d(-crossing));
    if (!image_of) return std::nullopt;
    corners[i] = image_of->pixel;
  }
  return corners;
}

/// A corner that is off by d lies on both displaced sides: n . d is what each is off by there.
CornerCovariance covariance_of(const Sides& sides, const Corners& corners) {
  std::array<Vector2d, 4> normals;
  std::array<double, 4> lengths_px{};
  for (std::size_t k = 0; k < 4; ++k) {
    const Vector2d along = corners[(k + 1) % 4] - corners[k];
    lengths_px[k] = along.norm();
    normals[k] = Vector2d(along.y(), -along.x()) / lengths_px[k];
  }
  Eigen::Matrix<double, 8, 8> dcorners_dsides = Eigen::Matrix<double, 8, 8>::Zero();  // two errors per side
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t before = (i + 3) % 4;
    Eigen::Matrix2d N;
    N << normals[before].transpose(), normals[i].transpose();
    const Eigen::Matrix2d inverse = N.inverse();
    const auto row = static_cast<Eigen::Index>(2 * i);
    dcorners_dsides.block<2, 2>(row, static_cast<Eigen::Index>(2 * before)) =
        inverse.col(0) * sides[before].errors_at(lengths_px[before]).transpose();
    dcorners_dsides.block<2, 2>(row, row) = inverse.col(1) * sides[i].errors_at(0.0).transpose();
  }
  return dcorners_dsides * dcorners_dsides.transpose();
}

}  // namespace

std::optional<RefinedCorners> refine_corners(const ImageView& image, const Camera& camera,
                                             const Corners& corners_px, int cells) {
  Corners corners = corners_px;
  std::optional<Sides> sides;
  for (int round = 0; round < kRounds; ++round) {
    sides = find_sides(image, camera, corners, cells);
    const auto refined = sides ? crossings(*sides, camera) : std::nullopt;
    if (!refined) return std::nullopt;
    corners = *refined;
  }
  return RefinedCorners{corners, covariance_of(*sides, corners)};
}

}  // namespace waymark::markers
