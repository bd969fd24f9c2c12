#include "waymark/fastslam/particles.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace waymark::fastslam {
namespace {

constexpr double kNever = -std::numeric_limits<double>::infinity();

// As a proportion of the variance that a pivot began with, what rounding can leave of a pivot that should be
// 0.
constexpr double kRelativePivot = 1e-12;

double largest_log_weight(const Particles& p) {
  double largest = kNever;
  for (std::size_t i = 0; i < p.log_weight.size(); ++i)
    if (std::isfinite(p.log_weight[i])) largest = std::max(largest, p.log_weight[i]);
  return largest;
}

// Beta is halved until N_eff is large enough, then bisected between the last two values.
constexpr int kMostHalvings = 100;
constexpr int kBisections = 8;

// N_eff = (sum w)^2 / sum w^2 with w = exp(beta log_weight).
double effective_particles_at(double beta, const Particles& p, ParticleBlocks& blocks) {
  const auto sums = blocks.sum([&](std::size_t begin, std::size_t end) {
    std::array<double, 2> sum{};
    for (std::size_t i = begin; i < end; ++i) {
      const double w = std::exp(beta * p.log_weight[i]);
      sum[0] += w;
      sum[1] += w * w;
    }
    return sum;
  });
  return sums[0] * sums[0] / sums[1];
}

Pose2 mean_pose(const Particles& p, ParticleBlocks& blocks) {
  const auto sums = blocks.sum([&](std::size_t begin, std::size_t end) {
    std::array<double, 4> sum{};
    for (std::size_t i = begin; i < end; ++i) {
      sum[0] += p.weight[i] * p.x_m[i];
      sum[1] += p.weight[i] * p.y_m[i];
      sum[2] += p.weight[i] * p.cos_theta[i];
      sum[3] += p.weight[i] * p.sin_theta[i];
    }
    return sum;
  });
  return {sums[0], sums[1], std::atan2(sums[3], sums[2])};
}

}  // namespace

Particles::Particles(int count, const Pose2& T_world_robot)
    : x_m(static_cast<std::size_t>(count)),
      y_m(static_cast<std::size_t>(count)),
      theta_rad(static_cast<std::size_t>(count)),
      cos_theta(static_cast<std::size_t>(count)),
      sin_theta(static_cast<std::size_t>(count)),
      log_weight(static_cast<std::size_t>(count)),
      weight(static_cast<std::size_t>(count)) {
  for (std::size_t i = 0; i < weight.size(); ++i) set_pose(i, T_world_robot);
  make_weights_equal(*this);
}

Pose2 Particles::pose(int i) const {
  const auto k = static_cast<std::size_t>(i);
  return {x_m[k], y_m[k], theta_rad[k]};
}

void Particles::set_pose(std::size_t i, const Pose2& T_world_robot) {
  x_m[i] = T_world_robot.x_m;
  y_m[i] = T_world_robot.y_m;
  theta_rad[i] = wrap_angle(T_world_robot.theta_rad);
  cos_theta[i] = std::cos(theta_rad[i]);
  sin_theta[i] = std::sin(theta_rad[i]);
}

Eigen::Matrix3d semidefinite_root(const Eigen::Matrix3d& Q) {
  Eigen::Matrix3d L = Eigen::Matrix3d::Zero();
  for (int j = 0; j < 3; ++j) {
    const double pivot = Q(j, j) - L.row(j).squaredNorm();
    if (!(pivot > kRelativePivot * Q(j, j))) continue;
    L(j, j) = std::sqrt(pivot);
    for (int i = j + 1; i < 3; ++i) L(i, j) = (Q(i, j) - L.row(i).head(j).dot(L.row(j).head(j))) / L(j, j);
  }
  return L;
}

void move(Particles& p, const Motion& motion, const StreamKey& key, ParticleBlocks& blocks) {
  const Eigen::Matrix3d L = semidefinite_root(motion.covariance);
  const Eigen::Vector3d mean(motion.increment.x_m, motion.increment.y_m, motion.increment.theta_rad);
  blocks.run([&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      RandomStream random(key.seed, key.purpose, key.step, static_cast<std::uint32_t>(i));
      const double n0 = random.normal();
      const double n1 = random.normal();
      const double n2 = random.normal();
      const Eigen::Vector3d d = mean + L * Eigen::Vector3d(n0, n1, n2);
      const double c = p.cos_theta[i];
      const double s = p.sin_theta[i];
      p.set_pose(
          i, {p.x_m[i] + c * d.x() - s * d.y(), p.y_m[i] + s * d.x() + c * d.y(), p.theta_rad[i] + d.z()});
    }
  });
}

bool normalise_weights(Particles& p, ParticleBlocks& blocks) {
  const double largest = largest_log_weight(p);
  if (largest == kNever) {
    make_weights_equal(p);
    return false;
  }
  const double total = blocks.sum([&](std::size_t begin, std::size_t end) {
    std::array<double, 1> sum{};
    for (std::size_t i = begin; i < end; ++i) {
      p.log_weight[i] = std::isfinite(p.log_weight[i]) ? p.log_weight[i] - largest : kNever;
      p.weight[i] = std::exp(p.log_weight[i]);
      sum[0] += p.weight[i];
    }
    return sum;
  })[0];
  for (std::size_t i = 0; i < p.weight.size(); ++i) p.weight[i] /= total;
  return true;
}

void temper_weights(Particles& p, double least_effective, ParticleBlocks& blocks) {
  const auto is_flat = [&](double beta) {
    return effective_particles_at(beta, p, blocks) >= least_effective;
  };
  if (is_flat(1.0)) return;
  double low = 0.5;
  for (int i = 0; i < kMostHalvings && !is_flat(low); ++i) low *= 0.5;
  double high = 2.0 * low;
  for (int i = 0; i < kBisections; ++i) {
    const double middle = 0.5 * (low + high);
    (is_flat(middle) ? low : high) = middle;
  }
  for (std::size_t i = 0; i < p.log_weight.size(); ++i) p.log_weight[i] *= low;
  (void)normalise_weights(p, blocks);
}

void make_weights_equal(Particles& p) {
  const double equal = 1.0 / static_cast<double>(p.weight.size());
  std::fill_n(p.log_weight.data(), p.log_weight.size(), 0.0);
  std::fill_n(p.weight.data(), p.weight.size(), equal);
}

PoseEstimate estimate(const Particles& p, ParticleBlocks& blocks) {
  const Pose2 mean = mean_pose(p, blocks);
  const auto m = blocks.sum([&](std::size_t begin, std::size_t end) {
    std::array<double, 6> sum{};
    for (std::size_t i = begin; i < end; ++i) {
      const double w = p.weight[i];
      const double x = p.x_m[i] - mean.x_m;
      const double y = p.y_m[i] - mean.y_m;
      const double t = wrap_angle(p.theta_rad[i] - mean.theta_rad);
      sum[0] += w * x * x;
      sum[1] += w * x * y;
      sum[2] += w * x * t;
      sum[3] += w * y * y;
      sum[4] += w * y * t;
      sum[5] += w * t * t;
    }
    return sum;
  });
  return {mean, Eigen::Matrix3d{{m[0], m[1], m[2]}, {m[1], m[3], m[4]}, {m[2], m[4], m[5]}}};
}

void replace_by_ancestors(Particles& p, std::span<const std::int32_t> ancestors, ParticleBlocks& blocks) {
  blocks.run([&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto from = static_cast<std::size_t>(ancestors[i]);
      if (from == i) continue;
      for (auto* column : {&p.x_m, &p.y_m, &p.theta_rad, &p.cos_theta, &p.sin_theta})
        (*column)[i] = (*column)[from];
    }
  });
  make_weights_equal(p);
}

}  // namespace waymark::fastslam
