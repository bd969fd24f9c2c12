#include "workbench/sim/world.hpp"

#include <algorithm>
#include <cmath>

#include "waymark/core/random.hpp"

namespace waymark::sim {
namespace {

constexpr int kTriesPerSeparation = 200;

Eigen::Vector2d point_at(const Path& path, double along_m) {
  for (const PathSegment& segment : path) {
    if (along_m < segment.arc.distance_m) return segment.at(along_m / segment.arc.distance_m).position();
    along_m -= segment.arc.distance_m;
  }
  return path.back().at(1.0).position();
}

Eigen::Vector2d draw_in_area(double side_m, RandomStream& random) {
  const double x_m = random.uniform(-0.5, 0.5) * side_m;
  return {x_m, random.uniform(-0.5, 0.5) * side_m};
}

Eigen::Vector2d draw_candidate(const WorldOptions& options, const Path& path, RandomStream& random) {
  if (options.spread == Spread::kArea) return draw_in_area(options.area_m, random);
  const Eigen::Vector2d p = point_at(path, random.uniform(0.0, length_m(path)));
  const double offset_m = random.uniform(options.min_offset_m, options.max_offset_m);
  const double direction_rad = random.uniform(-kPi, kPi);
  return p + offset_m * Eigen::Vector2d(std::cos(direction_rad), std::sin(direction_rad));
}

bool is_apart(const std::vector<TrueLandmark>& landmarks, const Eigen::Vector2d& p, double separation_m) {
  return std::none_of(landmarks.begin(), landmarks.end(), [&](const TrueLandmark& other) {
    return std::hypot(other.x_m - p.x(), other.y_m - p.y()) < separation_m;
  });
}

}  // namespace

std::vector<TrueLandmark> place_landmarks(const WorldOptions& options, const Path& path, std::uint64_t seed) {
  RandomStream random(seed, StreamPurpose::kWorld, 1);
  std::vector<TrueLandmark> landmarks;
  const bool in_area = options.spread == Spread::kArea;
  double separation_m = options.separation_m;
  double offset_m = options.min_offset_m;
  int crowded = 0;
  while (static_cast<int>(landmarks.size()) < options.landmarks) {
    // A candidate is at most max_offset_m from where it was drawn, so only the lower bound is left to check.
    const Eigen::Vector2d p = draw_candidate(options, path, random);
    const bool is_clear = distance_m(path, p) >= offset_m;
    if (!is_clear && !in_area) continue;
    if (!is_clear || !is_apart(landmarks, p, separation_m)) {
      if (++crowded % kTriesPerSeparation == 0) separation_m /= 2.0;
      // A path may fill its square; one beside which landmarks are drawn leaves room by itself.
      if (crowded % kTriesPerSeparation == 0 && in_area) offset_m /= 2.0;
      continue;
    }
    crowded = 0;
    const auto number = static_cast<std::int32_t>(landmarks.size());
    landmarks.push_back({{LandmarkId::Family::kMarker, number}, p.x(), p.y(), 0.0});
  }
  return landmarks;
}

}  // namespace waymark::sim
