#include "workshop/figures/consistency_study.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "waymark/core/chi2.hpp"
#include "waymark/core/parallel.hpp"
#include "waymark/core/random.hpp"
#include "waymark/ekf/ekf_slam.hpp"
#include "waymark/models/observation_models.hpp"

#include "workbench/eval/nees.hpp"

namespace waymark::study {
namespace {

constexpr double kRadius_m = 7.5;
constexpr double kStepsPerLoop = 200.0;
constexpr double kSensorRange_m = 8.0;
/// Near landmarks change their direction so fast that the first estimates of FEJ serve them badly.
constexpr double kMinOffset_m = 1.5;
constexpr double kLargestOffset_m = 4.0;

class World {
 public:
  World(const ConsistencyOptions& options, int run)
      : options_(options),
        random_(options.seed, StreamPurpose::kSimulation, static_cast<std::uint64_t>(run)) {
    for (int i = 0; i < options.landmarks; ++i) {
      const double side = random_.uniform() < 0.5 ? -1.0 : 1.0;
      const double radius_m = kRadius_m + side * random_.uniform(kMinOffset_m, kLargestOffset_m);
      const double angle_rad = random_.uniform(-kPi, kPi);
      landmarks_.emplace_back(kCentre + radius_m * Eigen::Vector2d(std::cos(angle_rad), std::sin(angle_rad)));
    }
  }

  /// The robot keeps to its circle; what varies is what the odometry says.
  Motion drive() {
    const double turn_rad = 2.0 * kPi / kStepsPerLoop;
    const Pose2 step{kRadius_m * std::sin(turn_rad), kRadius_m * (1.0 - std::cos(turn_rad)), turn_rad};
    truth_ = truth_ * step;
    const Eigen::Vector3d sigma(options_.odometry_sigma_m, options_.odometry_sigma_m,
                                options_.odometry_sigma_rad);
    const Pose2 measured{step.x_m + sigma[0] * random_.normal(), step.y_m + sigma[1] * random_.normal(),
                         step.theta_rad + sigma[2] * random_.normal()};
    return {measured, sigma.cwiseAbs2().asDiagonal()};
  }

  Observations look() {
    Observations seen;
    const Eigen::Vector2d sigma(options_.range_sigma_m, options_.bearing_sigma_rad);
    for (std::size_t i = 0; i < landmarks_.size(); ++i) {
      const auto z = RangeBearingModel::linearize(truth_, Pose2{}, landmarks_[i]).predicted;
      if (z[0] > kSensorRange_m) continue;
      const RangeBearing noisy{z[0] + sigma[0] * random_.normal(),
                               wrap_angle(z[1] + sigma[1] * random_.normal())};
      seen.push_back({LandmarkId{LandmarkId::Family::kMarker, static_cast<int>(i)}, noisy,
                      Eigen::Matrix2d(sigma.cwiseAbs2().asDiagonal())});
    }
    return seen;
  }

  [[nodiscard]] const Pose2& truth() const { return truth_; }

 private:
  inline static const Eigen::Vector2d kCentre{0.0, kRadius_m};

  const ConsistencyOptions& options_;
  RandomStream random_;
  std::vector<Eigen::Vector2d> landmarks_;
  Pose2 truth_;
};

/// One run, by step.
struct Run {
  std::vector<double> nees;
  std::vector<double> squared_error_m2;
};

Run run_once(ekf::Consistency mode, const ConsistencyOptions& options, int number) {
  World world(options, number);
  // Wide open: the study is of the estimate, and an overconfident filter would refuse its own corrections.
  EkfSlam filter({.consistency = mode, .capacity = options.landmarks, .gate = {1.0 - 1e-12}}, {});
  Run run;
  for (int step = 0; step < options.steps; ++step) {
    filter.predict(world.drive());
    filter.correct(world.look());
    const auto pose = filter.pose();
    const Eigen::Vector3d error = difference(world.truth(), pose.T_world_robot);
    run.nees.push_back(eval::nees<3>(error, pose.covariance).value_or(NAN));
    run.squared_error_m2.push_back(error.head<2>().squaredNorm());
  }
  return run;
}

}  // namespace

ConsistencyResult study_consistency(ekf::Consistency mode, const ConsistencyOptions& options, int threads) {
  std::vector<Run> runs(static_cast<std::size_t>(options.runs));
  ThreadPool(threads).run(options.runs,
                          [&](int i) { runs[static_cast<std::size_t>(i)] = run_once(mode, options, i); });
  ConsistencyResult result;
  const double n = options.runs;
  const double steps = options.steps;
  result.low = chi2_quantile(0.005, 3.0 * n) / n;
  result.high = chi2_quantile(0.995, 3.0 * n) / n;
  result.nees.resize(static_cast<std::size_t>(options.steps));
  for (const Run& run : runs) {
    for (std::size_t i = 0; i < run.nees.size(); ++i) result.nees[i] += run.nees[i] / n;
    result.position_rmse_m +=
        std::accumulate(run.squared_error_m2.begin(), run.squared_error_m2.end(), 0.0) / (n * steps);
  }
  result.position_rmse_m = std::sqrt(result.position_rmse_m);
  result.nees_mean = std::accumulate(result.nees.begin(), result.nees.end(), 0.0) / steps;
  const auto inside =
      std::ranges::count_if(result.nees, [&](double x) { return x >= result.low && x <= result.high; });
  result.part_inside = static_cast<double>(inside) / steps;
  return result;
}

ConsistencyComparison compare_modes(const ConsistencyOptions& options, int threads) {
  return {options,
          {{"invariant", study_consistency(ekf::Consistency::kInvariant, options, threads)},
           {"fej", study_consistency(ekf::Consistency::kFej, options, threads)},
           {"standard", study_consistency(ekf::Consistency::kStandard, options, threads)}}};
}

}  // namespace waymark::study
