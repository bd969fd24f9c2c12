#include "workbench/run/evidence.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "waymark/core/chi2.hpp"
#include "waymark/core/motion.hpp"

namespace waymark {
namespace {

using TimedInnovations = std::vector<Recording::TimedInnovation>;

// Over which the path is compared with odometry, and without landmarks counts as driven by odometry alone.
constexpr double kWindow_m = 1.0;

std::size_t count(const TimedInnovations& innovations, Outcome outcome) {
  return static_cast<std::size_t>(std::ranges::count_if(
      innovations, [outcome](const auto& each) { return each.innovation.outcome == outcome; }));
}

bool is_compared(const Innovation& innovation) {
  return innovation.dof > 0 &&
         (innovation.outcome == Outcome::kMatched || innovation.outcome == Outcome::kGated);
}

/// By the median, which neither outliers nor the gate change much.
VarianceRatio ratio_of_innovations(const TimedInnovations& innovations) {
  const std::array medians{chi2_quantile(0.5, 1.0), chi2_quantile(0.5, 2.0)};
  std::vector<double> ratios;
  for (const auto& [stamp, innovation] : innovations)
    if (is_compared(innovation)) ratios.push_back(innovation.nis / medians[innovation.dof == 1 ? 0 : 1]);
  if (ratios.empty()) return {};
  const auto middle = ratios.begin() + std::ssize(ratios) / 2;
  std::ranges::nth_element(ratios, middle);
  return {*middle, static_cast<double>(ratios.size())};
}

/// Variance ratio test (Lo and MacKinlay 1988): the sum of n innovations that are white in time varies n
/// times as much as one.
VarianceRatio ratio_of_blocks(const TimedInnovations& innovations) {
  struct Block {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    double squares = 0.0;
    int size = 0;
  };
  std::map<LandmarkId, Block> blocks;
  double of_sums = 0.0;
  double of_singles = 0.0;
  double dof = 0.0;
  for (const auto& [stamp, innovation] : innovations) {
    if (innovation.outcome != Outcome::kMatched || innovation.standardised.isZero(0.0)) continue;
    Block& block = blocks[innovation.landmark];
    block.sum += innovation.standardised;
    block.squares += innovation.standardised.squaredNorm();
    if (++block.size < kInnovationBlock) continue;
    of_sums += block.sum.squaredNorm();
    of_singles += block.squares;
    dof += innovation.dof;
    block = {};
  }
  return dof > 0.0 ? VarianceRatio{of_sums / of_singles, dof} : VarianceRatio{};
}

/// A stretch of the path, by the filter's pose at its start and odometry.
struct Stretch {
  explicit Stretch(const TrajectoryPoint& start)
      : predicted{start.pose, start.covariance.value_or(Eigen::Matrix3d::Zero())}, odometry{start.pose, {}} {
    odometry.covariance.setZero();
  }

  void drive(const Motion& motion) {
    predicted = propagate(predicted, motion);
    odometry = propagate(odometry, motion);
    driven_m += travelled_m(motion);
  }

  PoseEstimate predicted;
  PoseEstimate odometry;  ///< as if the start were known
  double driven_m = 0.0;
};

/// What observations did to the pose at the end of a stretch. They take C = P_predicted - P from its
/// covariance, which is the covariance of the correction e. C may be singular; so e' (C + Q)^-1 e, with Q of
/// the odometry of the stretch, is compared with its mean, the trace of M = (C + Q)^-1 C.
struct PoseCorrection {
  double squared = 0.0;
  double mean = 0.0;           ///< tr(M), and the variance of the square is twice
  double half_variance = 0.0;  ///< tr(M M)
};

PoseCorrection correction_of(const Stretch& stretch, const TrajectoryPoint& end) {
  if (!end.covariance) return {};
  const Eigen::Vector3d e = difference(end.pose, stretch.predicted.T_world_robot);
  const Eigen::Matrix3d C = stretch.predicted.covariance - *end.covariance;
  const Eigen::LLT<Eigen::Matrix3d> S(C + stretch.odometry.covariance);
  if (S.info() != Eigen::Success) return {};
  const Eigen::Matrix3d M = S.solve(C);
  if (!(M.trace() > 0.0)) return {};
  return {e.dot(S.solve(e)), M.trace(), (M * M).trace()};
}

VarianceRatio ratio_of_departure(const Recording& recording) {
  const Trajectory& path = recording.trajectory;
  Stretch stretch(path.front());
  PoseCorrection sum;
  for (std::size_t i = 1; i < path.size(); ++i) {
    stretch.drive(recording.motions[i]);
    if (stretch.driven_m < kWindow_m) continue;
    const PoseCorrection correction = correction_of(stretch, path[i]);
    sum.squared += correction.squared;
    sum.mean += correction.mean;
    sum.half_variance += correction.half_variance;
    stretch = Stretch(path[i]);
  }
  if (!(sum.mean > 0.0 && sum.half_variance > 0.0)) return {};
  return {sum.squared / sum.mean, sum.mean * sum.mean / sum.half_variance};
}

/// Then the path is meant to depart from odometry.
bool calibrates_odometry(const Filter& filter) {
  const auto calibration = filter.calibration();
  return calibration && calibration->is_estimated(kSpeedScale);
}

/// The distance travelled until each point of the path.
std::vector<double> distances_m(const std::vector<Motion>& motions) {
  std::vector<double> until;
  double driven_m = 0.0;
  for (const Motion& motion : motions) until.push_back(driven_m += travelled_m(motion));
  return until;
}

/// The distance travelled at the stamp of each innovation.
std::vector<double> distances_m(const Recording& recording, const std::vector<double>& until_m) {
  std::vector<double> distances;
  std::size_t i = 0;
  for (const auto& each : recording.innovations) {
    while (i + 1 < until_m.size() && recording.trajectory[i].stamp < each.stamp) ++i;
    distances.push_back(until_m[i]);
  }
  return distances;
}

double unaided_m(const TimedInnovations& innovations, const std::vector<double>& at_m, double end_m) {
  double sum_m = 0.0;
  double last_m = 0.0;
  const auto go_on = [&](double to_m) {
    if (to_m - last_m >= kWindow_m) sum_m += to_m - last_m;
    last_m = to_m;
  };
  for (std::size_t i = 0; i < innovations.size(); ++i)
    if (innovations[i].innovation.outcome == Outcome::kMatched) go_on(at_m[i]);
  go_on(end_m);
  return sum_m;
}

/// log P(X >= n q) <= -n D(q || p) of a binomial variable with n trials of probability p < q (Chernoff 1952).
double log_tail(double q, double p, int n) {
  if (q <= p) return 0.0;
  const double rest = q < 1.0 ? (1.0 - q) * std::log((1.0 - q) / (1.0 - p)) : 0.0;
  return -n * (q * std::log(q / p) + rest);
}

/// Of unknown identity, and of a landmark of the map or of none.
bool can_fit(const Innovation& innovation) {
  return innovation.landmark.family == LandmarkId::Family::kNone &&
         (innovation.outcome == Outcome::kMatched || innovation.outcome == Outcome::kAdded ||
          innovation.outcome == Outcome::kAmbiguous || innovation.outcome == Outcome::kGated);
}

/// The first scan with a landmark that was known before, and those that follow, count. What bears a new name
/// is new; what bears none ought to be of the map.
Misfit find_misfit(const TimedInnovations& innovations, Stamp start) {
  Misfit worst;
  int scans = 0;
  for (auto scan = innovations.begin(); scan != innovations.end();) {
    const auto end =
        std::find_if(scan, innovations.end(), [&](const auto& each) { return each.stamp != scan->stamp; });
    Misfit misfit{.since_start_s = to_seconds(scan->stamp - start)};
    for (; scan != end; ++scan) {
      if (!can_fit(scan->innovation)) continue;
      ++misfit.observations;
      misfit.unmatched += scan->innovation.outcome == Outcome::kMatched ? 0 : 1;
    }
    if (misfit.observations == 0 || (scans == 0 && misfit.unmatched == misfit.observations)) continue;
    ++scans;
    misfit.log_probability = log_tail(static_cast<double>(misfit.unmatched) / misfit.observations,
                                      kManyOutliers, misfit.observations);
    if (misfit.log_probability < worst.log_probability) worst = misfit;
  }
  worst.log_probability += std::log(std::max(1, scans));
  return worst;
}

}  // namespace

Evidence gather_evidence(const Recording& recording) {
  Evidence evidence;
  const TimedInnovations& innovations = recording.innovations;
  evidence.health = recording.filter->health();
  evidence.matched = count(innovations, Outcome::kMatched);
  evidence.gated = count(innovations, Outcome::kGated);
  evidence.deferred = count(innovations, Outcome::kDeferred);
  evidence.innovations = ratio_of_innovations(innovations);
  evidence.blocks = ratio_of_blocks(innovations);
  if (recording.trajectory.empty()) return evidence;
  if (!calibrates_odometry(*recording.filter)) evidence.departure = ratio_of_departure(recording);
  const std::vector<double> until_m = distances_m(recording.motions);
  const std::vector<double> at_m = distances_m(recording, until_m);
  evidence.travelled_m = until_m.back();
  evidence.unaided_m = unaided_m(innovations, at_m, until_m.back());
  evidence.misfit = find_misfit(innovations, recording.trajectory.front().stamp);
  return evidence;
}

}  // namespace waymark
