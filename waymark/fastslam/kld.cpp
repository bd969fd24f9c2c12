#include "waymark/fastslam/kld.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "waymark/core/angle.hpp"

namespace waymark::fastslam {
namespace {

constexpr double kQuantile99 = 2.326347874;
constexpr double kBin_m = 0.2;
constexpr double kBin_rad = 5.0 * kPi / 180.0;

/// Never 0. 21 bits per coordinate: bins repeat after 400 km.
std::uint64_t bin_of(const Pose2& T_world_robot) {
  const auto index = [](double value, double size) {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(value / size))) & 0x1FFFFF;
  };
  return (std::uint64_t{1} << 63) | (index(T_world_robot.x_m, kBin_m) << 42) |
         (index(T_world_robot.y_m, kBin_m) << 21) | index(T_world_robot.theta_rad, kBin_rad);
}

}  // namespace

double kld_particles(std::size_t bins, double error) {
  if (bins < 2) return 1.0;
  const double k = static_cast<double>(bins) - 1.0;
  const double part = 2.0 / (9.0 * k);
  return k / (2.0 * error) * std::pow(1.0 - part + std::sqrt(part) * kQuantile99, 3);
}

OccupiedBins::OccupiedBins(std::size_t capacity) : table_(std::bit_ceil(2 * capacity)) {}

std::size_t OccupiedBins::count(const Particles& particles) {
  std::ranges::fill(table_, 0);
  std::size_t bins = 0;
  for (int i = 0; i < particles.count(); ++i) {
    if (!(particles.weights()[static_cast<std::size_t>(i)] > 0.0)) continue;
    const std::uint64_t bin = bin_of(particles.pose(i));
    // The high bits of a product by an odd number depend on all bits of the other factor.
    std::size_t at = (bin * 0x9E3779B97F4A7C15U) >> (64 - std::bit_width(table_.size() - 1));
    while (table_[at] != 0 && table_[at] != bin) at = (at + 1) & (table_.size() - 1);
    if (table_[at] == bin) continue;
    table_[at] = bin;
    ++bins;
  }
  return bins;
}

}  // namespace waymark::fastslam
