#include "workbench/eval/trajectory_error.hpp"

#include <cmath>

#include "waymark/core/chi2.hpp"

#include "workbench/eval/median.hpp"
#include "workbench/eval/nees.hpp"

namespace waymark::eval {
namespace {

/// Root of the mean of what was added.
class RootMeanSquare {
 public:
  void add_square(double square) {
    sum_ += square;
    ++count_;
  }
  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] std::optional<double> value() const {
    return count_ == 0 ? std::nullopt : std::optional(std::sqrt(sum_ / static_cast<double>(count_)));
  }

 private:
  double sum_ = 0.0;
  std::size_t count_ = 0;
};

/// The covariance of a pose after a known rotation of its frame.
Eigen::Matrix3d turned(const Eigen::Matrix3d& P, const Eigen::Matrix2d& R) {
  Eigen::Matrix3d G = Eigen::Matrix3d::Identity();
  G.topLeftCorner<2, 2>() = R;
  return G * P * G.transpose();
}

/// Estimated minus true motion from `start` to `end`, in world axes after turning the estimate's start onto
/// the true one. Both truths have headings.
Eigen::Vector3d motion_error(const PosePair& start, const PosePair& end) {
  const double turn_rad = *start.truth.theta_rad - start.estimate.theta_rad;
  const Eigen::Vector2d p =
      rotation_matrix(turn_rad) * (end.estimate.position() - start.estimate.position()) -
      (position_of(end.truth) - position_of(start.truth));
  return {p.x(), p.y(), wrap_angle(end.estimate.theta_rad - *end.truth.theta_rad + turn_rad)};
}

}  // namespace

std::vector<ErrorSample> errors(std::span<const PosePair> pairs, const Pose2& T_truth_estimate) {
  const Eigen::Matrix2d R = T_truth_estimate.rotation();
  const Eigen::Vector2d t = T_truth_estimate.position();
  std::vector<ErrorSample> samples;
  samples.reserve(pairs.size());
  for (const PosePair& pair : pairs) {
    ErrorSample sample{.stamp = pair.stamp,
                       .position_m = R * pair.estimate.position() + t - position_of(pair.truth)};
    if (pair.truth.theta_rad) {
      sample.heading_rad =
          wrap_angle(T_truth_estimate.theta_rad + pair.estimate.theta_rad - *pair.truth.theta_rad);
    }
    if (pair.covariance) {
      const Eigen::Matrix3d P = turned(*pair.covariance, R);
      sample.sigma = P.diagonal().cwiseMax(0.0).cwiseSqrt();
      if (sample.heading_rad) {
        sample.nees = nees<3>({sample.position_m.x(), sample.position_m.y(), *sample.heading_rad}, P);
      }
    }
    samples.push_back(sample);
  }
  return samples;
}

std::optional<double> position_rmse_m(std::span<const ErrorSample> samples) {
  RootMeanSquare rms;
  for (const ErrorSample& sample : samples) rms.add_square(sample.position_m.squaredNorm());
  return rms.value();
}

std::optional<double> position_rmse_m(std::span<const PosePair> pairs, const Pose2& T_truth_estimate) {
  const Eigen::Matrix2d R = T_truth_estimate.rotation();
  const Eigen::Vector2d t = T_truth_estimate.position();
  RootMeanSquare rms;
  for (const PosePair& pair : pairs) {
    rms.add_square((R * pair.estimate.position() + t - position_of(pair.truth)).squaredNorm());
  }
  return rms.value();
}

std::optional<double> heading_rmse_rad(std::span<const ErrorSample> samples) {
  RootMeanSquare rms;
  for (const ErrorSample& sample : samples) {
    if (sample.heading_rad) rms.add_square(*sample.heading_rad * *sample.heading_rad);
  }
  return rms.value();
}

NeesSummary summarise_nees(std::span<const ErrorSample> samples) {
  static const double kQuantile95 = chi2_quantile(0.95, 3);
  std::vector<double> values;
  double sum = 0.0;
  std::size_t inside = 0;
  NeesSummary summary;
  for (const ErrorSample& sample : samples) {
    if (!sample.nees) {
      if (sample.sigma && sample.heading_rad) ++summary.skipped;
      continue;
    }
    values.push_back(*sample.nees);
    sum += *sample.nees;
    if (*sample.nees <= kQuantile95) ++inside;
  }
  summary.scored = values.size();
  if (values.empty()) return summary;
  const auto n = static_cast<double>(values.size());
  summary.mean = sum / n;
  summary.inside_95 = static_cast<double>(inside) / n;
  summary.median = median(std::move(values));
  return summary;
}

std::vector<double> travelled_m(std::span<const PosePair> pairs) {
  constexpr double kStepM = 0.02;
  std::vector<double> travelled;
  travelled.reserve(pairs.size());
  double sum_m = 0.0;
  Eigen::Vector2d last = pairs.empty() ? Eigen::Vector2d::Zero() : position_of(pairs.front().truth);
  for (const PosePair& pair : pairs) {
    const double step_m = (position_of(pair.truth) - last).norm();
    if (step_m >= kStepM) {
      sum_m += step_m;
      last = position_of(pair.truth);
    }
    travelled.push_back(sum_m);
  }
  return travelled;
}

RelativeError relative_error(std::span<const PosePair> pairs, std::span<const double> travelled_m,
                             double distance_m) {
  constexpr double kOvershoot = 0.2;
  constexpr double kRoundingM = 1e-9;
  RootMeanSquare position_rms;
  RootMeanSquare heading_rms;
  std::size_t end = 0;
  for (std::size_t start = 0; start < pairs.size(); ++start) {
    while (end < pairs.size() && travelled_m[end] - travelled_m[start] < distance_m - kRoundingM) ++end;
    if (end == pairs.size()) break;
    if (travelled_m[end] - travelled_m[start] > (1.0 + kOvershoot) * distance_m) continue;
    if (!pairs[start].truth.theta_rad || !pairs[end].truth.theta_rad) continue;
    const Eigen::Vector3d e = motion_error(pairs[start], pairs[end]);
    position_rms.add_square(e.head<2>().squaredNorm());
    heading_rms.add_square(e.z() * e.z());
  }
  return {distance_m, position_rms.count(), position_rms.value(), heading_rms.value()};
}

}  // namespace waymark::eval
