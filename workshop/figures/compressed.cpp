#include "workshop/figures/compressed.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include <fmt/format.h>

#include "waymark/core/function_blocks.hpp"
#include "waymark/core/gaussian.hpp"
#include "waymark/core/random.hpp"
#include "waymark/ekf/ekf_slam.hpp"
#include "waymark/models/observation_models.hpp"

namespace waymark {
namespace {

constexpr double kRange_m = 6.0;
constexpr double kDensity_per_m2 = 0.09;  // about ten landmarks in sight
constexpr double kRangeSigma_m = 0.05;
constexpr double kBearingSigma_rad = 0.02;
constexpr double kRowSpacing_m = 9.0;

struct Look {
  Motion motion;
  std::vector<Observation> scan;
};

/// A robot in a field of landmarks that it first maps row by row, then crosses slowly the other way.
class Field {
 public:
  explicit Field(int landmarks) : side_m_(std::sqrt(landmarks / kDensity_per_m2)), truth_(start()) {
    for (int i = 0; i < landmarks; ++i)
      landmarks_.emplace_back(random_.uniform(0.0, side_m_), random_.uniform(0.0, side_m_));
    for (const bool across : {false, true}) plan_rows(across);
  }

  /// Nothing is left to be mapped.
  [[nodiscard]] bool mapped() const { return next_ >= waypoints_.size() / 2; }

  [[nodiscard]] const Pose2& truth() const { return truth_; }
  [[nodiscard]] Pose2 start() const { return {kRange_m, kRange_m, 0.0}; }

  Look next() {
    const double step_m = mapped() ? 0.05 : 0.25;
    Look frame{move(step_m), {}};
    for (std::size_t i = 0; i < landmarks_.size(); ++i) {
      if ((landmarks_[i] - truth_.position()).norm() < kRange_m) frame.scan.push_back(sight(i));
    }
    return frame;
  }

 private:
  void plan_rows(bool across) {
    const double end_m = side_m_ - kRange_m;
    bool back = false;
    for (double row_m = kRange_m; row_m <= end_m + 0.5 * kRowSpacing_m;
         row_m += kRowSpacing_m, back = !back) {
      for (const double along_m : {back ? end_m : kRange_m, back ? kRange_m : end_m})
        waypoints_.push_back(across ? Eigen::Vector2d(row_m, along_m) : Eigen::Vector2d(along_m, row_m));
    }
  }

  Motion move(double step_m) {
    const Eigen::Vector2d ahead = waypoints_[next_] - truth_.position();
    if (ahead.norm() < 1.5) next_ = std::min(next_ + 1, waypoints_.size() - 1);
    const double wanted = wrap_angle(std::atan2(ahead.y(), ahead.x()) - truth_.theta_rad);
    const Pose2 step{step_m, 0.0, std::clamp(wanted, -step_m, step_m)};
    const Eigen::Vector3d sigma = Eigen::Vector3d(0.05, 0.02, 0.02) * std::sqrt(step_m) * 0.2;
    const double x_m = step.x_m + sigma[0] * random_.normal();
    const double y_m = sigma[1] * random_.normal();
    truth_ = truth_ * Pose2{x_m, y_m, step.theta_rad + sigma[2] * random_.normal()};
    return {step, sigma.cwiseAbs2().asDiagonal()};
  }

  Observation sight(std::size_t landmark) {
    const auto z = RangeBearingModel::linearize(truth_, {}, landmarks_[landmark]).predicted;
    const double range_m = z[0] + kRangeSigma_m * random_.normal();
    const double bearing_rad = wrap_angle(z[1] + kBearingSigma_rad * random_.normal());
    const Eigen::Vector2d variance(kRangeSigma_m * kRangeSigma_m, kBearingSigma_rad * kBearingSigma_rad);
    return {LandmarkId{LandmarkId::Family::kMarker, static_cast<std::int32_t>(landmark)},
            RangeBearing{range_m, bearing_rad}, Eigen::Matrix2d(variance.asDiagonal())};
  }

  double side_m_;
  Pose2 truth_;
  RandomStream random_{1, StreamPurpose::kSimulation};
  std::vector<Eigen::Vector2d> landmarks_;
  std::vector<Eigen::Vector2d> waypoints_;
  std::size_t next_ = 0;
};

void advance(EkfSlam& filter, const Look& frame) {
  filter.predict(frame.motion);
  filter.correct(frame.scan);
}

double milliseconds(Duration d) { return 1e3 * to_seconds(d); }

/// The thread's CPU time of every frame after the mapping.
struct Cost {
  std::vector<double> frames_ms;
  double mean_ms = 0.0;
  double observations = 0.0;  // in a frame
  int landmarks = 0;
  int submaps = 0;
};

Cost measure(int landmarks, Compress compressed, int steps, int threads) {
  Field field(landmarks);
  EkfSlam filter({.capacity = landmarks, .compressed = compressed}, {}, threads);
  while (!field.mapped()) advance(filter, field.next());
  const int submaps_before = filter.state().closed_submaps();
  Cost cost;
  for (int i = 0; i < steps; ++i) {
    const Look frame = field.next();
    cost.observations += static_cast<double>(frame.scan.size()) / steps;
    const Duration before = thread_cpu_time();
    advance(filter, frame);
    cost.frames_ms.push_back(milliseconds(thread_cpu_time() - before));
  }
  cost.mean_ms = std::reduce(cost.frames_ms.begin(), cost.frames_ms.end()) / steps;
  std::ranges::sort(cost.frames_ms);
  cost.landmarks = filter.state().landmarks();
  cost.submaps = filter.state().closed_submaps() - submaps_before;
  return cost;
}

void print(const char* name, const Cost& cost) {
  const auto quantile = [&](double q) {
    return cost.frames_ms[static_cast<std::size_t>(q * static_cast<double>(cost.frames_ms.size() - 1))];
  };
  fmt::print("{:<12}{:>10}{:>10}{:>10.1f}{:>10.3f}{:>10.3f}{:>10.3f}{:>10.3f}\n", name, cost.landmarks,
             cost.submaps, cost.observations, cost.mean_ms, quantile(0.5), quantile(0.99), quantile(1.0));
}

double pose_nees(const Pose2& truth, const PoseEstimate& pose) {
  return mahalanobis_squared<3>(difference(truth, pose.T_world_robot), pose.covariance).value_or(NAN);
}

/// The same drive with and without compression, or else without and with the observations in reverse order:
/// what rounding alone makes of it.
void compare(const char* name, ekf::Consistency consistency, Compress compressed, int landmarks, int steps,
             int threads) {
  Field field(landmarks);
  EkfSlam whole({.consistency = consistency, .capacity = landmarks, .compressed = Compress::kNever}, {},
                threads);
  EkfSlam local({.consistency = consistency, .capacity = landmarks, .compressed = compressed}, {}, threads);
  double position_m = 0.0;
  double heading_rad = 0.0;
  double sigma = 0.0;  // in units of the whole filter's own uncertainty
  double nees = 0.0;
  double nees_local = 0.0;
  for (int i = 0; i < steps;) {
    i += field.mapped() ? 1 : 0;
    Look frame = field.next();
    advance(whole, frame);
    if (compressed == Compress::kNever) std::ranges::reverse(frame.scan);
    advance(local, frame);
    const PoseEstimate a = whole.pose();
    const PoseEstimate b = local.pose();
    const Pose2 truth = field.start().inverse() * field.truth();
    nees += field.mapped() ? pose_nees(truth, a) / steps : 0.0;
    nees_local += field.mapped() ? pose_nees(truth, b) / steps : 0.0;
    const Eigen::Vector2d gap_m = a.T_world_robot.position() - b.T_world_robot.position();
    position_m = std::max(position_m, gap_m.norm());
    heading_rad =
        std::max(heading_rad, std::abs(wrap_angle(a.T_world_robot.theta_rad - b.T_world_robot.theta_rad)));
    sigma = std::max(sigma, gap_m.norm() / std::sqrt(a.covariance.topLeftCorner<2, 2>().trace() + 1e-12));
  }
  fmt::print("{:<20}{:>10}{:>10.2f}{:>10.2f}{:>12.2e}{:>12.2e}{:>12.2e}", name,
             local.state().closed_submaps(), nees_local, nees, position_m, heading_rad, sigma);
  if (compressed == Compress::kNever) return fmt::print("\n");
  const MapState map = whole.save();
  const MapState map_local = local.save();
  fmt::print(
      "{:>12.2e}{:>12.2e}\n", (map.landmarks - map_local.landmarks).cwiseAbs().maxCoeff(),
      (map.covariance - map_local.covariance).cwiseAbs().maxCoeff() / map.covariance.cwiseAbs().maxCoeff());
}

}  // namespace

int compressed(int landmarks, int steps, int threads) {
  const int third = landmarks / 3;
  fmt::print("compressed EKF: thread CPU per frame in ms over {} frames through a mapped field, {} threads\n",
             steps, threads);
  fmt::print("{:<12}{:>10}{:>10}{:>10}{:>10}{:>10}{:>10}{:>10}\n", "compressed", "landmarks", "submaps",
             "seen", "mean", "p50", "p99", "max");
  for (const int mapped : {landmarks / 30, third, landmarks})
    print("true", measure(mapped, Compress::kAlways, steps, threads));
  print("false", measure(third, Compress::kNever, std::min(steps, 500), threads));
  fmt::print("\nlargest difference from the whole filter, {} landmarks mapped and crossed for {} frames\n",
             third, steps);
  fmt::print("{:<20}{:>10}{:>10}{:>10}{:>12}{:>12}{:>12}{:>12}{:>12}\n", "mode", "submaps", "NEES", "whole",
             "position m", "heading", "of sigma", "map m", "covariance");
  using ekf::Consistency;
  compare("standard", Consistency::kStandard, Compress::kAlways, third, steps, threads);
  compare("standard, rounding", Consistency::kStandard, Compress::kNever, third, steps, threads);
  compare("fej", Consistency::kFej, Compress::kAlways, third, steps, threads);
  compare("fej, rounding", Consistency::kFej, Compress::kNever, third, steps, threads);
  compare("invariant", Consistency::kInvariant, Compress::kAlways, third, steps, threads);
  return 0;
}

}  // namespace waymark
