#include "workbench/run/smoother.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "waymark/core/function_blocks.hpp"
#include "waymark/models/observation_models.hpp"

namespace waymark::smooth {
namespace {

/// Takes the steps of the odometry together to intervals between the poses at which something was seen.
class IntervalBuilder {
 public:
  IntervalBuilder(const Recording& recording, const Config& config, const Before& before, RunGraph& run)
      : recording_(recording), config_(config), before_(before), run_(run) {
    run_.steps.push_back(0);
    run_.start.poses.push_back(recording.trajectory.front().pose);
  }

  /// Goes on by one step of the run.
  void advance(std::size_t step) {
    const Motion& motion = recording_.motions[step];
    if (is_still(motion)) return;
    const Duration dt = recording_.trajectory[step].stamp - recording_.trajectory[step - 1].stamp;
    interval_.steps.push_back({motion.increment, to_seconds(dt)});
    motion_ = compose(motion_, motion);
    slip_ = compose(slip_, {motion.increment, slip_of(motion.increment)});
  }

  /// The pose at the present step: a new one if the robot moved since the last; nothing if it did, and not
  /// far enough, or if it stands and what it sees would only be the last error once more.
  [[nodiscard]] std::optional<int> pose_at(std::size_t step) {
    const bool moved = !interval_.steps.empty();
    if (moved && !is_far(step)) return std::nullopt;
    if (moved) add_pose(step);
    if (!seen_at_) seen_at_ = step;
    if (*seen_at_ != step && leaves_out()) return std::nullopt;
    return static_cast<int>(run_.steps.size()) - 1;
  }

 private:
  [[nodiscard]] bool leaves_out() const {
    return config_.smooth.keyframe_distance_m > 0.0 || config_.smooth.keyframe_turn_deg > 0.0;
  }

  [[nodiscard]] bool is_far(std::size_t step) const {
    if (!before_.steps.empty()) return std::ranges::binary_search(before_.steps, step);
    return motion_.increment.position().norm() >= config_.smooth.keyframe_distance_m ||
           std::abs(motion_.increment.theta_rad) >= to_radians(config_.smooth.keyframe_turn_deg);
  }

  void add_pose(std::size_t step) {
    const auto larger = before_.odometry_noise.asDiagonal();
    interval_.covariance = larger * motion_.covariance * larger;
    interval_.measured_part = measured_part();
    run_.graph.intervals.push_back(std::exchange(interval_, {}));
    motion_ = slip_ = {};
    seen_at_.reset();
    run_.steps.push_back(step);
    run_.start.poses.push_back(recording_.trajectory[step].pose);
  }

  [[nodiscard]] Eigen::Matrix3d slip_of(const Pose2& increment) const {
    const ArcModel arc = config_.odometry.arc;
    return slip_covariance({arc_length_m(increment, arc), increment.theta_rad}, config_.odometry.noise, arc);
  }

  /// Of wheels and cars the noise says which errors are whose; of other odometry all of it was measured.
  [[nodiscard]] Eigen::Vector3d measured_part() const {
    if (config_.smooth.odometry_is_commanded) return Eigen::Vector3d::Zero();
    const bool knows_wheels =
        recording_.odometry == OdometryKind::kWheels || recording_.odometry == OdometryKind::kSteering;
    if (!knows_wheels) return Eigen::Vector3d::Ones();
    constexpr double kLeast = 1e-20;  // an interval that is exact in some direction has no part to speak of
    const Eigen::Array3d all = motion_.covariance.diagonal().array() + kLeast;
    return (1.0 - slip_.covariance.diagonal().array() / all).max(0.0);
  }

  const Recording& recording_;
  const Config& config_;
  const Before& before_;
  RunGraph& run_;
  KeyframeInterval interval_;
  std::optional<std::size_t> seen_at_;  // step at which the last pose saw something
  Motion motion_;
  Motion slip_;  // what the robot does beside what is measured
};

bool has_landmark(Outcome outcome) {
  return outcome == Outcome::kMatched || outcome == Outcome::kAdded || outcome == Outcome::kGated;
}

/// Where an observation puts its landmark, by the filter's pose; nothing where it has one number.
std::optional<Eigen::Vector2d> place(const Recording::ObservationRecord& landmark_observation,
                                     const Recording& recording, const Pose2& T_robot_sensor) {
  const auto* z = std::get_if<RangeBearing>(&landmark_observation.observation.value);
  if (z == nullptr) return std::nullopt;
  return RangeBearingModel::locate(recording.trajectory[landmark_observation.step].pose, T_robot_sensor, *z)
      .p_world;
}

void add_landmark(LandmarkId id, const Eigen::Vector2d& p_world, RunGraph& run) {
  run.ids.push_back(id);
  run.observations.push_back(0);
  run.start.landmarks.push_back(p_world);
}

/// Those of the map, and those that the filter gave up but had seen often enough: another part of the log may
/// know them again.
std::map<LandmarkId, int> add_landmarks(const Recording& recording, RunGraph& run) {
  constexpr int kOften = 4;
  const LandmarkId nobody;
  for (const LandmarkEstimate& landmark : recording.filter->snapshot().landmarks)
    add_landmark(landmark.id, landmark.position_m.head<2>(), run);
  std::map<LandmarkId, int> index;
  for (const LandmarkId id : run.ids) index.emplace(id, static_cast<int>(index.size()));
  std::map<LandmarkId, int> seen;
  for (const auto& landmark_observation : recording.observations) {
    if (!has_landmark(landmark_observation.outcome) || landmark_observation.landmark == nobody ||
        index.contains(landmark_observation.landmark))
      continue;
    const auto p_world = place(landmark_observation, recording, run.graph.T_robot_sensor);
    if (!p_world || ++seen[landmark_observation.landmark] < kOften) continue;
    index.emplace(landmark_observation.landmark, static_cast<int>(run.ids.size()));
    add_landmark(landmark_observation.landmark, *p_world, run);
  }
  return index;
}

/// By the odometry around a step of the run: over long enough that noise of encoders is small against what a
/// robot does that turns, stops or starts, which is what tells a delay.
Eigen::Vector3d velocity_at(const Recording& recording, std::size_t step) {
  constexpr Duration kEachWay = std::chrono::milliseconds(250);
  const Trajectory& path = recording.trajectory;
  std::size_t first = step, last = step;
  while (first > 0 && path[step].stamp - path[first].stamp < kEachWay) --first;
  while (last + 1 < path.size() && path[last].stamp - path[step].stamp < kEachWay) ++last;
  Pose2 moved;
  for (std::size_t i = first + 1; i <= last; ++i) moved = moved * recording.motions[i].increment;
  const double dt_s = to_seconds(path[last].stamp - path[first].stamp);
  if (!(dt_s > 0.0)) return Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity(0.0, 0.0, moved.theta_rad);
  velocity.head<2>() = rotation_matrix(-0.5 * moved.theta_rad) * moved.position();  // as seen from its middle
  return velocity / dt_s;
}

/// What observations of one landmark have in common is not estimated here and counts as noise.
Eigen::Matrix2d white_covariance(const Observation& observation, const LandmarkSensor& sensor) {
  LandmarkSensor without_shared = sensor;
  without_shared.errors.shared_range_sigma_ratio = without_shared.errors.shared_bearing_sigma_deg = 0.0;
  return *observation.covariance + noise_covariance(with_white_errors(without_shared), observation.value) -
         noise_covariance(sensor, observation.value);
}

/// A pose at the filter's: the run's own path between two smoothed poses, bent to meet both.
class Bender {
 public:
  Bender(const Recording& recording, const RunGraph& run, const Solution& solution)
      : recording_(recording), run_(run), solution_(solution) {}

  [[nodiscard]] Trajectory path() {
    Trajectory path;
    for (std::size_t pose = 0; pose < run_.steps.size(); ++pose) bend_after(pose, path);
    return path;
  }

 private:
  /// The points from this pose to before the next.
  void bend_after(std::size_t pose, Trajectory& path) {
    const std::size_t first = run_.steps[pose];
    const bool is_last = pose + 1 == run_.steps.size();
    const std::size_t end = is_last ? recording_.trajectory.size() : run_.steps[pose + 1];
    const std::vector<Pose2> moved = moved_from(first, is_last ? end - 1 : end);
    const Pose2& T_world_pose = solution_.estimate.poses[pose];
    const Pose2 rest =
        is_last ? Pose2{} : (T_world_pose * moved.back()).inverse() * solution_.estimate.poses[pose + 1];
    for (std::size_t i = first; i < end; ++i) {
      const double part = static_cast<double>(i - first) / static_cast<double>(end - first);
      path.push_back({recording_.trajectory[i].stamp,
                      T_world_pose * moved[i - first] * interpolate(Pose2{}, rest, part),
                      covariance_of(pose)});
    }
  }

  /// By the calibrated odometry, from one point of the run to each up to another.
  [[nodiscard]] std::vector<Pose2> moved_from(std::size_t first, std::size_t last) const {
    std::vector<Pose2> moved{Pose2{}};
    for (std::size_t i = first + 1; i <= last; ++i) {
      const Duration dt = recording_.trajectory[i].stamp - recording_.trajectory[i - 1].stamp;
      const auto step =
          calibrate(recording_.motions[i].increment, to_seconds(dt), solution_.estimate.calibration);
      moved.push_back(moved.back() * step.increment);
    }
    return moved;
  }

  [[nodiscard]] std::optional<Eigen::Matrix3d> covariance_of(std::size_t pose) const {
    if (solution_.pose_covariances.empty()) return std::nullopt;
    return solution_.pose_covariances[pose];
  }

  const Recording& recording_;
  const RunGraph& run_;
  const Solution& solution_;
};

std::vector<LandmarkEstimate> map_of(const RunGraph& run, const Solution& solution) {
  std::vector<LandmarkEstimate> map;
  for (std::size_t i = 0; i < run.ids.size(); ++i) {
    LandmarkEstimate landmark{.id = run.ids[i], .observations = run.observations[i], .within = {}};
    landmark.position_m.head<2>() = solution.estimate.landmarks[i];
    if (!solution.landmark_covariances.empty())
      landmark.covariance.topLeftCorner<2, 2>() = solution.landmark_covariances[i];
    map.push_back(landmark);
  }
  return map;
}

}  // namespace

RunGraph graph_of(const Recording& recording, const Config& config, const Before& before) {
  RunGraph run;
  run.graph.T_robot_sensor = config.sensor.T_robot_sensor();
  run.graph.landmark_sigma_m = config.sensor.max_range_m;
  run.graph.calibration_mean = before.calibration;
  run.graph.calibration_sigmas = calibration_sigmas(config.smooth, config.sensor.errors, config.observe);
  const bool estimates_delay = run.graph.calibration_sigmas[kDelay] > 0.0;
  const std::map<LandmarkId, int> index = add_landmarks(recording, run);
  IntervalBuilder intervals(recording, config, before, run);
  auto landmark_observation = recording.observations.begin();
  for (std::size_t step = 0; step < recording.trajectory.size(); ++step) {
    if (step > 0) intervals.advance(step);
    for (; landmark_observation != recording.observations.end() && landmark_observation->step == step;
         ++landmark_observation) {
      const auto landmark = index.find(landmark_observation->landmark);
      if (landmark == index.end() || !has_landmark(landmark_observation->outcome)) continue;
      const auto pose = intervals.pose_at(step);
      if (!pose) continue;
      ++run.observations[static_cast<std::size_t>(landmark->second)];
      run.graph.observations.push_back(
          {*pose, landmark->second, landmark_observation->observation.value,
           white_covariance(landmark_observation->observation, config.sensor),
           estimates_delay ? velocity_at(recording, step) : Eigen::Vector3d::Zero()});
    }
  }
  return run;
}

Result<Smoothed> smooth(const Recording& recording, const Config& config, const Before& before) {
  if (config.observe == Observe::kPixel)
    return Error{"smooth.run: works with ranges and bearings, not with pixels"};
  if (recording.motions.size() != recording.trajectory.size() || recording.trajectory.empty())
    return Error{"smooth.run: the run has no poses and observations to smooth"};
  const Duration start = thread_cpu_time();
  RunGraph run = graph_of(recording, config, before);
  SolveOptions options;
  options.robust_dof = config.smooth.robust_dof;
  const Solution solution = solve(run.graph, run.start, options);
  Smoothed smoothed;
  smoothed.trajectory = Bender(recording, run, solution).path();
  smoothed.landmarks = map_of(run, solution);
  smoothed.calibration = {solution.estimate.calibration, solution.calibration_sigmas,
                          run.graph.calibration_sigmas};
  smoothed.calibration_covariance = solution.calibration_covariance;
  smoothed.iterations = solution.iterations;
  smoothed.converged = solution.converged;
  smoothed.steps = std::move(run.steps);
  smoothed.observations = run.graph.observations.size();
  smoothed.interval_residuals = solution.interval_residuals;
  for (std::size_t i = 0; i < solution.observation_residuals.size(); ++i)
    smoothed.observation_residuals.push_back(
        {run.graph.observations[i].value, solution.observation_residuals[i]});
  smoothed.cpu = thread_cpu_time() - start;
  return smoothed;
}

}  // namespace waymark::smooth
