#include "waymark/markers/quad_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Geometry>

namespace waymark::markers {
namespace {

using Eigen::Vector2d;

// How far a contour may be from the polygon of its corners: sides bend by the lens, and corners are round.
constexpr double kDeviationMin_px = 1.0;
constexpr double kDeviationPart = 0.02;  // of its length
// Of the points of a side those near its ends belong to round corners.
constexpr std::size_t kTrimPart = 6;
constexpr std::size_t kTrimMax = 6;
constexpr std::size_t kPointsMin = 3;

/// Positive where b lies clockwise of a in the image.
double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

Vector2d at(const Contour& contour, std::size_t i) { return contour[i % contour.size()].cast<double>(); }

/// Positive around something dark, px^2.
double area(const Contour& contour) {
  float twice = 0.0F;
  const Eigen::Vector2f origin = contour.front();
  for (std::size_t i = 0; i + 1 < contour.size(); ++i) {
    const Eigen::Vector2f a = contour[i] - origin, b = contour[i + 1] - origin;
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * static_cast<double>(twice);
}

std::size_t farthest_from(const Contour& contour, const Eigen::Vector2f& p) {
  std::size_t farthest = 0;
  float largest = -1.0F;
  for (std::size_t i = 0; i < contour.size(); ++i) {
    const float distance = (contour[i] - p).squaredNorm();
    if (distance <= largest) continue;
    largest = distance;
    farthest = i;
  }
  return farthest;
}

/// Part of a contour from one index to a later one, which may go around past its end.
struct Arc {
  std::size_t begin = 0;
  std::size_t end = 0;
  std::size_t farthest = 0;   ///< from its chord
  double deviation_px = 0.0;  ///< there

  Arc(const Contour& contour, std::size_t from, std::size_t to) : begin(from), end(to), farthest(from) {
    const Vector2d p = at(contour, from);
    const Vector2d chord = (at(contour, to) - p).normalized();
    for (std::size_t i = from + 1; i < to; ++i) {
      const double distance_px = std::abs(cross(chord, at(contour, i) - p));
      if (distance_px <= deviation_px) continue;
      deviation_px = distance_px;
      farthest = i;
    }
  }
};

using Arcs = std::array<Arc, 4>;

/// The outermost points of a contour divide it: that farthest from the middle, that farthest from there, and
/// twice that farthest from a chord between two. Of a quadrilateral these are its corners.
std::optional<Arcs> split(const Contour& contour) {
  Eigen::Vector2f middle = Eigen::Vector2f::Zero();
  for (const auto& p : contour) middle += p / static_cast<float>(contour.size());
  const std::size_t first = farthest_from(contour, middle);
  const std::size_t second = farthest_from(contour, contour[first]);
  std::vector<Arc> arcs;
  const auto [low, high] = std::minmax(first, second);
  arcs.emplace_back(contour, low, high);
  arcs.emplace_back(contour, high, low + contour.size());
  while (arcs.size() < 4) {
    const auto widest = std::ranges::max_element(arcs, {}, &Arc::deviation_px);
    if (widest->deviation_px <= kDeviationMin_px) return std::nullopt;
    const Arc before(contour, widest->begin, widest->farthest), after(contour, widest->farthest, widest->end);
    *widest = before;
    arcs.insert(widest + 1, after);
  }
  return Arcs{arcs[0], arcs[1], arcs[2], arcs[3]};
}

bool is_polygon(const Arcs& arcs, std::size_t points) {
  const double deviation_max_px = kDeviationMin_px + kDeviationPart * static_cast<double>(points);
  return std::ranges::all_of(arcs, [&](const Arc& arc) { return arc.deviation_px <= deviation_max_px; });
}

struct Line {
  Vector2d point;
  Vector2d direction;
};

/// Least squares of the distances.
std::optional<Line> line_through(const Contour& contour, const Arc& arc) {
  const std::size_t trim = std::clamp<std::size_t>((arc.end - arc.begin) / kTrimPart, 1, kTrimMax);
  if (arc.end - arc.begin < 2 * trim + kPointsMin - 1) return std::nullopt;
  double n = 0.0;
  Vector2d sum = Vector2d::Zero();
  Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
  const Vector2d origin = at(contour, arc.begin);
  for (std::size_t i = arc.begin + trim; i + trim <= arc.end; ++i) {
    const Vector2d p = at(contour, i) - origin;
    sum += p;
    squares += p * p.transpose();
    ++n;
  }
  const Eigen::Matrix2d scatter = squares - sum * sum.transpose() / n;
  const double angle_rad = 0.5 * std::atan2(2.0 * scatter(0, 1), scatter(0, 0) - scatter(1, 1));
  return Line{origin + sum / n, {std::cos(angle_rad), std::sin(angle_rad)}};
}

std::optional<Vector2d> crossing(const Line& a, const Line& b) {
  const double sine = cross(a.direction, b.direction);
  if (std::abs(sine) < 0.05) return std::nullopt;
  return a.point + cross(b.point - a.point, b.direction) / sine * a.direction;
}

bool is_convex(const Corners& corners, double side_min_px) {
  for (std::size_t i = 0; i < 4; ++i) {
    const Vector2d side = corners[(i + 1) % 4] - corners[i],
                   next = corners[(i + 2) % 4] - corners[(i + 1) % 4];
    if (side.norm() < side_min_px || cross(side, next) <= 0.0) return false;
  }
  return true;
}

}  // namespace

std::optional<Corners> fit_quad(const Contour& contour, double side_min_px) {
  if (area(contour) < side_min_px * side_min_px) return std::nullopt;
  const auto arcs = split(contour);
  if (!arcs || !is_polygon(*arcs, contour.size())) return std::nullopt;
  std::array<Line, 4> lines;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto line = line_through(contour, (*arcs)[i]);
    if (!line) return std::nullopt;
    lines[i] = *line;
  }
  Corners corners;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto corner = crossing(lines[(i + 3) % 4], lines[i]);
    const double reach_px = 2.0 * (kDeviationMin_px + kDeviationPart * static_cast<double>(contour.size()));
    if (!corner || (*corner - at(contour, (*arcs)[i].begin)).norm() > reach_px) return std::nullopt;
    corners[i] = *corner;
  }
  return is_convex(corners, side_min_px) ? std::optional(corners) : std::nullopt;
}

}  // namespace waymark::markers
