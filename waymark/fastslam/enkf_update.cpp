#include "waymark/fastslam/enkf_update.hpp"

#include <algorithm>
#include <array>

#include "waymark/core/angle.hpp"
#include "waymark/fastslam/particle_step.hpp"
#include "waymark/kernels/regression.hpp"

namespace waymark::fastslam {
namespace {

using kernels::LandmarkForm;
using kernels::RegressionSums;

// Fewer particles do not know how they vary.
constexpr double kMinEffective = 5.0;
constexpr double kMinNoise = 1e-3;

}  // namespace

EnkfUpdate::EnkfUpdate(ParticleBlocks& blocks)
    : blocks_(blocks),
      weight_(blocks.capacity()),
      delta_(blocks.capacity()),
      step_(blocks.capacity()),
      values_(blocks.capacity()) {}

void EnkfUpdate::assimilate(const ScalarObservation& z, Belief& belief) {
  list_innovations(z, belief);
  noise_ = std::max(z.variance - innovations_.variance, kMinNoise * z.variance) / z.information_weight;
  const bool is_telling = innovations_.effective >= kMinEffective && innovations_.variance > 0.0;
  if (!is_telling) return;
  const kernels::MovingPoses poses = belief.particles.moving();
  move_values(poses.x_m, false);
  move_values(poses.y_m, false);
  move_values(poses.theta_rad, true);
  if (belief.calibration.is_estimated()) {
    move_column(belief.calibration.scale(), nullptr);
    move_column(belief.calibration.offset_m(), nullptr);
    belief.calibration.refresh();
  }
  for (int k = 0; k < belief.store.size(); ++k) {
    belief.store.gather(k);
    move_landmark(belief.view(k));
  }
}

void EnkfUpdate::list_innovations(const ScalarObservation& z, const Belief& belief) {
  const std::span<const double> weights = belief.particles.weights();
  const kernels::Increment increment = increment_of(belief.pending);
  const Eigen::Vector2d origin_m = belief.origin_m();
  std::transform(weights.begin(), weights.end(), weight_.data(),
                 [](double w) { return static_cast<float>(w); });
  std::fill(weight_.data() + weights.size(), weight_.data() + weight_.size(), 0.0F);
  // Bearings are counted from that of one particle, so that opposite ones do not cancel.
  kernels::About about;
  const auto list = [&](std::size_t begin, std::size_t end) {
    BlockScratch scratch;
    kernels::load_poses(belief.particles.world(begin), origin_m.x(), origin_m.y(), scratch.robots(),
                        end - begin);
    float* const range = z.is_bearing ? values_.data() + begin : delta_.data() + begin;
    float* const angle = z.is_bearing ? delta_.data() + begin : values_.data() + begin;
    kernels::list_innovations(z.observation, increment, scratch.robots(), about, range, angle,
                              {begin, end - begin});
  };
  list(0, 1);
  (z.is_bearing ? about.bearing : about.range) = delta_[0];
  const auto base = static_cast<double>(delta_[0]);
  const auto sums = blocks_.sum([&](std::size_t begin, std::size_t end) {
    list(begin, end);
    std::array<double, 3> sum{};
    for (std::size_t i = begin; i < end; ++i) {
      if (!(weights[i] > 0.0)) delta_[i] = 0.0F;
      const auto nu = static_cast<double>(delta_[i]);
      sum[0] += weights[i] * nu;
      sum[1] += weights[i] * nu * nu;
      sum[2] += weights[i] * weights[i];
    }
    return sum;
  });
  innovations_.mean = base + sums[0];
  innovations_.effective = 1.0 / sums[2];
  innovations_.unbiased = 1.0 / std::max(1.0 - sums[2], 1e-9);
  innovations_.variance = innovations_.unbiased * (sums[1] - sums[0] * sums[0]);
  blocks_.run([&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      delta_[i] -= static_cast<float>(sums[0]);
      step_[i] = static_cast<float>(innovations_.mean) + 0.5F * delta_[i];
    }
  });
}

double EnkfUpdate::gain_of(const float* values) {
  const auto sums = blocks_.sum([&](std::size_t begin, std::size_t end) {
    const RegressionSums part = kernels::sum_regression(values + begin, values[0], weight_.data() + begin,
                                                        delta_.data() + begin, end - begin);
    return std::array{part.d, part.d_delta, part.d_d};
  });
  // The deviations delta have mean 0, those of the values do not.
  const double covariance = innovations_.unbiased * sums[1];
  const double variance = innovations_.unbiased * (sums[2] - sums[0] * sums[0]);
  if (!(variance > 0.0)) return 0.0;
  const double correlation = std::min(1.0, covariance * covariance / (variance * innovations_.variance));
  const double chance = (1.0 - correlation) / ((innovations_.effective - 2.0) * correlation);
  return chance < 1.0 ? -(1.0 - chance) * covariance / (innovations_.variance + noise_) : 0.0;
}

void EnkfUpdate::move_values(double* values, bool is_angle) {
  const double first = values[0];
  blocks_.run([&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      values_[i] = static_cast<float>(is_angle ? wrap_angle(values[i] - first) : values[i] - first);
  });
  const double gain = gain_of(values_.data());
  blocks_.run([&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const double moved = values[i] + gain * static_cast<double>(step_[i]);
      values[i] = is_angle ? wrap_angle(moved) : moved;
    }
  });
}

/// Where it is, and in which direction from its anchor; distances from the anchor are the particle's own.
void EnkfUpdate::move_landmark(const kernels::LandmarkView& landmark) {
  for (std::size_t k = 0; k < landmark.mode_count; ++k) {
    const kernels::LandmarkMode& mode = landmark.modes[k];
    move_column(mode.gaussian.a, landmark.mode_count > 1 ? mode.log_weight : nullptr);
    if (landmark.form == LandmarkForm::kPoint) move_column(mode.gaussian.b, nullptr);
  }
  if (landmark.form == LandmarkForm::kPoint) return;
  move_column(landmark.anchor_x, nullptr);
  move_column(landmark.anchor_y, nullptr);
}

void EnkfUpdate::move_column(float* column, const float* log_weight) {
  const auto gain = static_cast<float>(gain_of(log_weight == nullptr ? column : alive(column, log_weight)));
  if (gain == 0.0F) return;
  blocks_.run([&](std::size_t begin, std::size_t end) {
    kernels::add_scaled(gain, step_.data() + begin, column + begin, end - begin);
  });
}

/// A copy in which particles that have dropped the hypothesis, where the column holds anything, have the mean
/// of the others.
const float* EnkfUpdate::alive(const float* column, const float* log_weight) {
  const auto is_alive = [log_weight](std::size_t i) { return log_weight[i] > 0.5F * kernels::kDeadMode; };
  const auto sums = blocks_.sum([&](std::size_t begin, std::size_t end) {
    std::array<double, 2> sum{};
    for (std::size_t i = begin; i < end; ++i) {
      if (!is_alive(i)) continue;
      sum[0] += static_cast<double>(weight_[i]);
      sum[1] += static_cast<double>(weight_[i]) * static_cast<double>(column[i]);
    }
    return sum;
  });
  const auto mean = static_cast<float>(sums[0] > 0.0 ? sums[1] / sums[0] : 0.0);
  blocks_.run([&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) values_[i] = is_alive(i) ? column[i] : mean;
  });
  return values_.data();
}

}  // namespace waymark::fastslam
