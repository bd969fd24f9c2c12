#include "waymark/fastslam/particles.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "waymark/kernels/particle_weights.hpp"

namespace waymark::fastslam {
namespace {

constexpr double kNever = -std::numeric_limits<double>::infinity();

// Beta is halved until N_eff is large enough, then bisected between the last two values.
constexpr int kMaxHalvings = 100;
constexpr int kBisections = 8;

// A mean heading so far from the one that differences were taken to is taken again, from itself.
constexpr double kLargestShift_rad = 0.1;
constexpr int kMaxShifts = 8;

std::size_t padded(int count) { return kernels::round_up_particles(static_cast<std::size_t>(count)); }

// N_eff = (sum w)^2 / sum w^2 with w = exp(beta log_weight).
double effective_particles_at(double beta, const Particles& p, ParticleBlocks& blocks) {
  const auto sums = blocks.sum([&](std::size_t begin, std::size_t end) {
    return kernels::sum_powers(p.log_weights().data() + begin, beta, end - begin);
  });
  return sums[0] * sums[0] / sums[1];
}

kernels::PoseSums sum_about(const Pose2& reference, const Particles& p, ParticleBlocks& blocks) {
  const std::array<double, 3> about{reference.x_m, reference.y_m, reference.theta_rad};
  return blocks.sum([&](std::size_t begin, std::size_t end) {
    return kernels::sum_poses(p.world(begin), p.weights().data() + begin, about, end - begin);
  });
}

}  // namespace

Particles::Particles(int capacity, const Pose2& T_world_robot)
    : count_(capacity),
      x_m_(padded(capacity)),
      y_m_(padded(capacity)),
      theta_rad_(padded(capacity)),
      log_weight_(padded(capacity)),
      weight_(padded(capacity)) {
  for (int i = 0; i < capacity; ++i) set_pose(i, T_world_robot);
  make_weights_equal();
}

Pose2 Particles::pose(int i) const {
  const auto k = static_cast<std::size_t>(i);
  return {x_m_[k], y_m_[k], wrap_angle(theta_rad_[k])};
}

void Particles::set_pose(int i, const Pose2& T_world_robot) {
  const auto k = static_cast<std::size_t>(i);
  x_m_[k] = T_world_robot.x_m;
  y_m_[k] = T_world_robot.y_m;
  theta_rad_[k] = wrap_angle(T_world_robot.theta_rad);
}

void Particles::make_weights_equal() {
  make_weights_equal(0, size());
  clear_padding();
}

void Particles::make_weights_equal(std::size_t begin, std::size_t end) {
  std::fill(log_weight_.data() + begin, log_weight_.data() + end, 0.0);
  std::fill(weight_.data() + begin, weight_.data() + end, 1.0 / count_);
}

void Particles::clear_padding() { std::fill(weight_.data() + size(), weight_.data() + padded(count_), 0.0); }

void Particles::replace_by_ancestors(std::span<const std::int32_t> ancestors, ParticleBlocks& blocks) {
  count_ = static_cast<int>(ancestors.size());
  blocks.resize(ancestors.size());
  blocks.run([&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto from = static_cast<std::size_t>(ancestors[i]);
      if (from == i) continue;
      for (auto* column : {&x_m_, &y_m_, &theta_rad_}) (*column)[i] = (*column)[from];
    }
    make_weights_equal(begin, end);
  });
  clear_padding();
}

bool normalise_weights(Particles& p, ParticleBlocks& blocks) {
  double* const log_weight = p.log_weights().data();
  double* const weight = p.weights().data();
  const double largest = blocks.largest([&](std::size_t begin, std::size_t end) {
    return kernels::largest_finite(log_weight + begin, end - begin);
  });
  if (largest == kNever) {
    p.make_weights_equal();
    return false;
  }
  const double total = blocks.sum([&](std::size_t begin, std::size_t end) {
    return std::array{kernels::exponentiate(largest, log_weight + begin, weight + begin, end - begin)};
  })[0];
  blocks.run(
      [&](std::size_t begin, std::size_t end) { kernels::scale(1.0 / total, weight + begin, end - begin); });
  return true;
}

void temper_weights(Particles& p, double min_effective, ParticleBlocks& blocks) {
  const auto is_flat = [&](double beta) { return effective_particles_at(beta, p, blocks) >= min_effective; };
  if (is_flat(1.0)) return;
  double low = 0.5;
  for (int i = 0; i < kMaxHalvings && !is_flat(low); ++i) low *= 0.5;
  double high = 2.0 * low;
  for (int i = 0; i < kBisections; ++i) {
    const double middle = 0.5 * (low + high);
    (is_flat(middle) ? low : high) = middle;
  }
  for (double& log_weight : p.log_weights()) log_weight *= low;
  (void)normalise_weights(p, blocks);
}

PoseEstimate estimate(const Particles& p, ParticleBlocks& blocks) {
  Pose2 reference = p.pose(0);
  kernels::PoseSums m = sum_about(reference, p, blocks);
  for (int i = 0; i < kMaxShifts && std::abs(m[3]) > kLargestShift_rad; ++i) {
    reference.theta_rad += m[3];
    m = sum_about(reference, p, blocks);
  }
  const Eigen::Vector3d mean(m[1], m[2], m[3]);
  const Eigen::Matrix3d second{{m[4], m[5], m[6]}, {m[5], m[7], m[8]}, {m[6], m[8], m[9]}};
  return {{reference.x_m + mean[0], reference.y_m + mean[1], wrap_angle(reference.theta_rad + mean[2])},
          second - mean * mean.transpose()};
}

}  // namespace waymark::fastslam
