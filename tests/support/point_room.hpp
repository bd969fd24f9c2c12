#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "waymark/core/expectation.hpp"
#include "waymark/core/motion.hpp"
#include "waymark/core/observation.hpp"
#include "waymark/core/random.hpp"
#include "waymark/models/odometry.hpp"
#include "waymark/models/pixel_model.hpp"

namespace waymark::test {

/// A robot with a camera on a square of 6 m in a room of 10 x 10 m with points on its four walls: pixels as a
/// perfect front end would report them, wheels as its odometry says of them.
class PointRoom {
 public:
  struct Options {
    int points = 400;
    double pixel_sigma = 0.3;
    int max_in_view = 25;  ///< new points are shown while fewer are tracked
    double moving = 0.0;   ///< part of the points that walk to and fro by the walls at 1 m/s
  };

  PointRoom(std::uint64_t seed, const Options& options)
      : options_(options), random_(seed, StreamPurpose::kSimulation) {
    odometry_.wheels = {0.0975, 0.0975, 0.331};
    odometry_.noise = {2.9e-4, 1e-4, 1e-4, 1e-3, 1e-4};
    camera_options_.mount = {.x_m = 0.1, .z_m = 0.5};
    camera_ = Camera(camera_options_);
    for (int i = 0; i < options.points; ++i) points_.push_back(on_a_wall());
    truth_ = {-2.5, -3.0, 0.0};
  }

  [[nodiscard]] const CameraOptions& camera() const { return camera_options_; }
  [[nodiscard]] const Pose2& truth() const { return truth_; }
  /// Where a point is now.
  [[nodiscard]] Eigen::Vector3d point(int i) const {
    const Eigen::Vector3d& home = points_[static_cast<std::size_t>(i)];
    if (!moves(i)) return home;
    const double sway_m = std::abs(std::fmod(driven_m_ / kSpeed_mps + i, 4.0) - 2.0) - 1.0;
    return home + sway_m * Eigen::Vector3d(-home.y(), home.x(), 0.0).normalized();
  }
  [[nodiscard]] bool moves(int i) const { return i < options_.moving * options_.points; }
  [[nodiscard]] double driven_m() const { return driven_m_; }

  static constexpr double kSpeed_mps = 0.5;

  /// A thirtieth of a second; corners have a radius of 0.5 m.
  Motion move() {
    const double ds = kSpeed_mps / 30.0;
    const double side_m = 5.0, arc_m = 0.25 * kPi;
    const double along = std::fmod(driven_m_, side_m + arc_m);
    const double turn = along < side_m ? 0.0 : ds / 0.5;
    driven_m_ += ds;
    const WheelGeometry& wheels = odometry_.wheels;
    const WheelAngles angles{(ds - 0.5 * turn * wheels.track_m) / wheels.left_radius_m,
                             (ds + 0.5 * turn * wheels.track_m) / wheels.right_radius_m};
    Motion said = wheel_motion(angles, odometry_);
    const Eigen::Matrix3d L = said.covariance.llt().matrixL();
    const Eigen::Vector3d error = L * Eigen::Vector3d(random_.normal(), random_.normal(), random_.normal());
    truth_ = truth_ * Pose2{said.increment.x_m + error[0], said.increment.y_m + error[1],
                            said.increment.theta_rad + error[2]};
    return said;
  }

  /// Those points that are expected and in view.
  [[nodiscard]] std::vector<Observation> search_for(std::span<const Expectation> expected,
                                                    std::vector<LandmarkId>& missed) {
    std::vector<Observation> seen;
    missed.clear();
    in_view_.clear();
    for (const Expectation& e : expected) {
      if (const auto pixel = see(e.id.number)) {
        seen.push_back(observation(e.id.number, *pixel, options_.pixel_sigma));
        in_view_.insert(e.id.number);
      } else {
        missed.push_back(e.id);
      }
    }
    return seen;
  }

  /// Points that nobody expects, while there are few.
  [[nodiscard]] std::vector<Observation> search_for_new(int most) {
    std::vector<Observation> seen;
    const int wanted = std::min(most, options_.max_in_view - static_cast<int>(in_view_.size()));
    for (int k = 0; k < 200 && static_cast<int>(seen.size()) < wanted; ++k) {
      const int i = static_cast<int>(random_.uniform() * options_.points);
      if (!in_view_.insert(i).second) continue;
      if (const auto pixel = see(i)) seen.push_back(observation(i, *pixel, 0.1));
    }
    return seen;
  }

 private:
  [[nodiscard]] std::optional<Eigen::Vector2d> see(int i) const {
    const auto h = observe_point(camera_, camera_.pose(truth_), point(i));
    if (!h || !camera_.sees(h->predicted, 10.0)) return std::nullopt;
    return h->predicted;
  }
  Observation observation(int i, const Eigen::Vector2d& pixel, double sigma_px) {
    return {LandmarkId{LandmarkId::Family::kCorner, i},
            Pixel{pixel.x() + sigma_px * random_.normal(), pixel.y() + sigma_px * random_.normal()},
            Eigen::Matrix2d(sigma_px * sigma_px * Eigen::Matrix2d::Identity())};
  }
  Eigen::Vector3d on_a_wall() {
    const double along = random_.uniform(-5.0, 5.0), height_m = random_.uniform(0.0, 2.5);
    const double off = random_.uniform(4.0, 5.0);
    switch (static_cast<int>(random_.uniform() * 4.0)) {
      case 0:
        return {along, off, height_m};
      case 1:
        return {along, -off, height_m};
      case 2:
        return {off, along, height_m};
      default:
        return {-off, along, height_m};
    }
  }

  Options options_;
  RandomStream random_;
  OdometryOptions odometry_;
  CameraOptions camera_options_;
  Camera camera_;
  std::vector<Eigen::Vector3d> points_;
  Pose2 truth_;
  double driven_m_ = 0.0;
  std::set<int> in_view_;
};

}  // namespace waymark::test
