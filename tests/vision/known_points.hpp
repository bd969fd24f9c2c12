#pragma once

#include <cmath>
#include <map>
#include <optional>
#include <vector>

#include <Eigen/Cholesky>

#include "waymark/core/expectation.hpp"
#include "waymark/core/filter.hpp"
#include "waymark/core/random.hpp"
#include "waymark/models/camera.hpp"
#include "waymark/vision/tracker.hpp"

namespace waymark::test {

/// In place of a filter: knows where every landmark really is, and expects it nearly there.
class KnownPoints {
 public:
  explicit KnownPoints(const Camera& camera) : camera_(camera) {}

  void add(LandmarkId id, const Eigen::Vector3d& p_world_m) { points_[id] = p_world_m; }
  [[nodiscard]] std::size_t size() const { return points_.size(); }
  [[nodiscard]] const Eigen::Vector3d& place(LandmarkId id) const { return points_.at(id); }

  [[nodiscard]] std::optional<Eigen::Vector2d> pixel(LandmarkId id, const Pose2& T_world_robot) const {
    const CameraPose pose = camera_.pose(T_world_robot);
    const auto image = camera_.project(pose.R_camera_world * (points_.at(id) - pose.p_world_camera));
    if (!image || !camera_.sees(image->pixel)) return std::nullopt;
    return image->pixel;
  }

  /// Those in the image, with predictions that are wrong as S says.
  [[nodiscard]] std::vector<Expectation> expect(const Pose2& T_world_robot, const Eigen::Matrix2d& S,
                                                RandomStream& random, bool candidates = false) const {
    const Eigen::Matrix2d L = S.llt().matrixL();
    std::vector<Expectation> all;
    for (const auto& [id, p] : points_) {
      const auto truth = pixel(id, T_world_robot);
      if (!truth) continue;
      all.push_back({.id = id,
                     .candidate = candidates,
                     .predicted_px = *truth + L * Eigen::Vector2d(random.normal(), random.normal()),
                     .S = S,
                     .p_world_m = p,
                     .information_nats = 0.5 * std::log(S.determinant() / 1e-4)});
    }
    return all;
  }

  /// Takes new corners where `point_at` knows what they are of, and says what a filter would.
  template <class PointAt>
  std::vector<Innovation> take(const vision::SearchOutcome& observations, PointAt&& point_at) {
    std::vector<Innovation> innovations;
    for (const Observation& seen : observations.found) {
      if (points_.contains(*seen.id)) {
        innovations.push_back({*seen.id, Outcome::kMatched});
        continue;
      }
      const auto& place = std::get<Pixel>(seen.value);
      const std::optional<Eigen::Vector3d> p = point_at(Eigen::Vector2d(place.u_px, place.v_px));
      innovations.push_back({*seen.id, p ? Outcome::kAdded : Outcome::kMapFull});
      if (p) add(*seen.id, *p);
    }
    return innovations;
  }

 private:
  const Camera& camera_;
  std::map<LandmarkId, Eigen::Vector3d> points_;
};

[[nodiscard]] inline Eigen::Vector2d place_of(const Observation& seen) {
  const auto& place = std::get<Pixel>(seen.value);
  return {place.u_px, place.v_px};
}

}  // namespace waymark::test
